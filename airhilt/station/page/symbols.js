// The outlines of actors on the plan, nose up: places right and back of the middle, in half lengths.

const AIRCRAFT = [
  [0, -1],
  [0.12, -0.7],
  [0.12, -0.25],
  [1, 0.2],
  [1, 0.36],
  [0.12, 0.14],
  [0.08, 0.66],
  [0.4, 0.86],
  [0.4, 1],
  [0, 0.9],
  [-0.4, 1],
  [-0.4, 0.86],
  [-0.08, 0.66],
  [-0.12, 0.14],
  [-1, 0.36],
  [-1, 0.2],
  [-0.12, -0.25],
  [-0.12, -0.7],
];
const VEHICLE = [
  [-0.6, 1],
  [-0.6, -0.5],
  [-0.3, -1],
  [0.3, -1],
  [0.6, -0.5],
  [0.6, 1],
];
const ANIMAL = [
  [0, -0.9],
  [0.9, 0],
  [0, 0.9],
  [-0.9, 0],
];

/** Returns the outline of a category of actors, and its least half length in pixels. */
export function symbolOf(category) {
  const outline = { vehicle: VEHICLE, wildlife: ANIMAL }[category] ?? AIRCRAFT;
  return { outline, least: outline === AIRCRAFT ? 10 : 6 };
}
