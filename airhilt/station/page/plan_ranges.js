// Ranges on the plan: rings about a place, and a bar that says how long a distance is.

import { colour } from "./dom.js";
import { FONT_SMALL, circle, line, write } from "./pen.js";
import { METRE_PER_NM, fixed, metres } from "./words.js";

const RINGS_NM = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, 100, 200];
const BARS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]; // m or NM
const MOST_RINGS = 60;
const DEGREES = [0, 45, 315, 90, 270, 135, 225, 180]; // on a ring, where its name is tried

/** Draws range rings about a place, and returns the boxes of their names. */
export function drawRings(view, middle) {
  const { pen, width, height } = view,
    [x, y] = view.pixel(middle),
    names = [],
    unit = METRE_PER_NM * view.scale,
    step = RINGS_NM.find((nm) => nm * unit > 70) ?? RINGS_NM.at(-1);
  const furthest = Math.hypot(Math.max(x, width - x), Math.max(y, height - y)),
    nearest = Math.hypot(Math.max(-x, 0, x - width), Math.max(-y, 0, y - height)),
    first = Math.max(Math.floor(nearest / unit / step) - 1, 1);
  pen.font = FONT_SMALL;
  pen.textAlign = "left";
  for (let i = first; i * step * unit < furthest && i < first + MOST_RINGS; i += 1) {
    const nm = i * step;
    circle(pen, colour("--ring"), 1, [x, y], nm * unit);
    const place = onRing(view, x, y, nm * unit);
    if (!place) continue;
    const [left, bottom] = place;
    write(pen, `${Number(nm.toFixed(2))} NM`, left, bottom, colour("--dim"), colour("--map"));
    names.push([left - 2, bottom - 11, left + 42, bottom + 3]);
  }
  return names;
}

/** Where the name of a ring can be read: at its top, or else at another place of it that is seen. */
function onRing({ width, height }, x, y, radius) {
  return DEGREES.map((degrees) => {
    const angle = (degrees * Math.PI) / 180;
    return [x + radius * Math.sin(angle) + 4, y - radius * Math.cos(angle) - 3];
  }).find(([left, bottom]) => left > 4 && left + 46 < width && bottom > 16 && bottom < height - 34);
}

/** Draws a bar of a round length. */
export function drawScale(view) {
  const { pen, height, scale } = view,
    isNear = scale * METRE_PER_NM > 600,
    unit = (isNear ? 1 : METRE_PER_NM) * scale,
    value = BARS.findLast((one) => one * unit < 130) ?? BARS[0],
    name = isNear ? metres(value) : `${fixed(value, value < 1 ? 1 : 0)} NM`,
    [top, bottom, right] = [height - 16, height - 11, 12 + value * unit];
  line(pen, colour("--ink"), 1.4, [12, top], [12, bottom], [right, bottom], [right, top]);
  pen.font = FONT_SMALL;
  pen.textAlign = "left";
  write(pen, name, 16, height - 17, colour("--ink"), colour("--map"));
}
