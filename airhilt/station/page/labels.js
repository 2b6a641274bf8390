// Texts on a display, and places for them where they cover nothing.

/** Altitude of a data block: hundreds of feet in three digits, as on a radar display. */
export const level = (feet) => String(Math.max(Math.round(feet / 100), 0)).padStart(3, "0");

/** True if two boxes, each left, top, right and bottom, cover each other. */
const overlap = (a, b) => a[0] < b[2] && a[2] > b[0] && a[1] < b[3] && a[3] > b[1];

/** Returns the first of some boxes that covers none of those that are taken. */
const firstFree = (boxes, taken) =>
  boxes.find((box) => !taken.some((other) => overlap(box, other)));

/**
 * Returns the numbers of runways off their ends, each with the middle and the box of its text:
 * farther off where others are. `pixel` returns where a place is, `distances` are tried, and the
 * boxes have half a width and height. Runways that are too short on the display have none.
 */
export function runwayNumbers(runways, pixel, distances, [wide, high], shortest) {
  const placed = [];
  for (const { ends } of runways)
    ends.forEach(({ ident, start }, i) => {
      const [x, y] = pixel(start),
        [tx, ty] = pixel(ends[1 - i].start),
        length = Math.hypot(tx - x, ty - y);
      if (length < shortest) return;
      const boxes = distances.map((far) => {
        const cx = x - ((tx - x) / length) * far,
          cy = y - ((ty - y) / length) * far;
        return [cx - wide, cy - high, cx + wide, cy + high];
      });
      const taken = placed.map(({ box }) => box),
        box = firstFree(boxes, taken) ?? boxes[0];
      placed.push({ ident, box });
    });
  return placed;
}

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
