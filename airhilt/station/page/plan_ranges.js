// Ranges on the plan: rings about a place, and a bar that says how long a distance is.

import { FONT_SMALL, colour, write } from "./dom.js";
import { METRE_PER_NM } from "./model.js";
import { fixed, metres } from "./words.js";

/** Draws range rings about a place, and returns the boxes of their names. */
export function drawRings(view, middle) {
  const { pen, width, height } = view,
    [x, y] = view.pixel(middle),
    names = [];
  const unit = METRE_PER_NM * view.scale,
    step = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, 100].find((nm) => nm * unit > 70) ?? 200;
  const most = Math.hypot(
    Math.max(Math.abs(x), Math.abs(width - x)),
    Math.max(Math.abs(y), Math.abs(height - y)),
  );
  pen.font = FONT_SMALL;
  pen.textAlign = "left";
  const least = Math.max(
    Math.hypot(Math.max(-x, 0, x - width), Math.max(-y, 0, y - height)) - step * unit,
    0,
  );
  for (
    let i = Math.max(Math.floor(least / unit / step), 1);
    i * step * unit < most && i < least / unit / step + 60;
    i += 1
  ) {
    const nm = i * step;
    pen.beginPath();
    pen.arc(x, y, nm * unit, 0, 2 * Math.PI);
    pen.strokeStyle = colour("--ring");
    pen.lineWidth = 1;
    pen.stroke();
    const place = onRing(view, x, y, nm * unit);
    if (place) names.push(nameRing(view, `${Number(nm.toFixed(2))} NM`, place));
  }
  return names;
}

/** Writes the name of a ring at a place, and returns its box. */
function nameRing(view, name, [left, bottom]) {
  write(view.pen, name, left, bottom, colour("--dim"), colour("--map"));
  return [left - 2, bottom - 11, left + 42, bottom + 3];
}

/**
 * Where the name of a ring can be read: at its top, or else at another place of it that is seen;
 * null if there is none.
 */
function onRing(view, x, y, radius) {
  const { width, height } = view;
  for (const degrees of [0, 45, 315, 90, 270, 135, 225, 180]) {
    const angle = (degrees * Math.PI) / 180,
      left = x + radius * Math.sin(angle) + 4,
      bottom = y - radius * Math.cos(angle) - 3;
    if (left > 4 && left + 46 < width && bottom > 16 && bottom < height - 34) return [left, bottom];
  }
  return null;
}

/** Draws a bar of a round length. */
export function drawScale(view) {
  const { pen, height } = view,
    near = view.scale * METRE_PER_NM > 600,
    unit = near ? 1 : METRE_PER_NM;
  const value =
      [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].findLast(
        (one) => one * unit * view.scale < 130,
      ) ?? 0.1,
    long = value * unit * view.scale;
  pen.strokeStyle = colour("--ink");
  pen.lineWidth = 1.4;
  pen.beginPath();
  pen.moveTo(12, height - 16);
  pen.lineTo(12, height - 11);
  pen.lineTo(12 + long, height - 11);
  pen.lineTo(12 + long, height - 16);
  pen.stroke();
  pen.font = FONT_SMALL;
  pen.textAlign = "left";
  write(
    pen,
    near ? metres(value) : `${fixed(value, value < 1 ? 1 : 0)} NM`,
    16,
    height - 17,
    colour("--ink"),
    colour("--map"),
  );
}
