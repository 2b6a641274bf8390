// Texts on a display, and places for them where they cover nothing.

/** Altitude of a data block: hundreds of feet in three digits, as on a radar display. */
export const level = (feet) => String(Math.max(Math.round(feet / 100), 0)).padStart(3, "0");

/** True if two boxes, each left, top, right and bottom, cover each other. */
const overlap = (a, b) => a[0] < b[2] && a[2] > b[0] && a[1] < b[3] && a[3] > b[1];

/** Returns the first of some boxes that covers none of those that are taken. */
export const firstFree = (boxes, taken) =>
  boxes.find((box) => !taken.some((other) => overlap(box, other)));

/** Returns boxes off the end of a runway, at some distances from it, each of half a width and height. */
export const boxesOff = ([x, y], to, length, distances, [wide, high]) =>
  distances.map((far) => {
    const cx = x - ((to[0] - x) / length) * far,
      cy = y - ((to[1] - y) / length) * far;
    return [cx - wide, cy - high, cx + wide, cy + high];
  });

/**
 * Returns a box for a text near a place, where it covers none of those that are taken, if there is
 * one.
 */
export function freeBox({ width, height }, [x, y], [wide, high], taken) {
  const boxes = [];
  for (const far of [16, 34, 58, 90]) {
    for (const [dx, dy] of [
      [1, -1],
      [1, 1],
      [-1, -1],
      [-1, 1],
      [1, 0],
      [-1, 0],
      [0, -1],
      [0, 1],
    ]) {
      const cx = x + dx * (far + wide / 2),
        cy = y + dy * (far + high / 2);
      boxes.push([cx - wide / 2, cy - high / 2, cx + wide / 2, cy + high / 2]);
    }
  }
  const inside = boxes.filter(
    ([left, top, right, bottom]) => left > 2 && top > 2 && right < width - 2 && bottom < height - 2,
  );
  return firstFree(inside, taken) ?? inside[0] ?? boxes[0];
}
