// The outlines of actors on the plan, nose up: places right and back of the middle, in half lengths.

/** Returns an outline of which the right half is given, from the front to the back. */
const mirrored = (half) => [...half, ...half.toReversed().map(([right, back]) => [-right, back])];

const AIRCRAFT = mirrored([
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
]);
const VEHICLE = mirrored([
  [0.3, -1],
  [0.6, -0.5],
  [0.6, 1],
]);
const ANIMAL = mirrored([
  [0, -0.9],
  [0.9, 0],
  [0, 0.9],
]);

/** Returns the outline of a category of actors, and its least half length in pixels. */
export function symbolOf(category) {
  const outline = { vehicle: VEHICLE, wildlife: ANIMAL }[category] ?? AIRCRAFT;
  return { outline, least: outline === AIRCRAFT ? 10 : 6 };
}
