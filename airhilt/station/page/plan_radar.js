// The plots of surveillance radars on the plan: what the last turns of the antennas have found.

import { colour } from "./dom.js";
import { level } from "./labels.js";
import { FONT, circle, line, write } from "./pen.js";
import { TURNS } from "./radar_plots.js";
import { known, whole } from "./words.js";

const HALF = 4; // half the width of a plot, in pixels

/**
 * Draws plots, the older ones paler: a cross for an echo, a circle for a reply, both for both. A
 * reply that is alone has its code and its level beside it.
 */
export function drawPlots(view, plots) {
  const { pen } = view,
    ink = colour("--ink");
  for (const { plot, age, isAlone } of plots) {
    const [x, y] = view.pixel([plot.east, plot.north]);
    pen.globalAlpha = 1 - age / TURNS;
    if (plot.kind !== "secondary") {
      line(pen, ink, 1.2, [x - HALF, y], [x + HALF, y]);
      line(pen, ink, 1.2, [x, y - HALF], [x, y + HALF]);
    }
    if (plot.kind !== "primary") circle(pen, ink, 1.2, [x, y], HALF);
    if (isAlone && plot.kind !== "primary") {
      pen.font = FONT;
      pen.textAlign = "left";
      write(pen, joined(plot.code, plot.altitude_ft, level), x + 8, y - 6, ink, colour("--map"));
    }
  }
  pen.globalAlpha = 1;
}

/** Returns a code and an altitude, as far as they are known. */
const joined = (code, altitude, inUnit) =>
  [code, known(altitude) ? inUnit(altitude) : null].filter(Boolean).join(" ");

/** Returns what the last turn has found besides the actors, in words. */
export const inWords = (plots) =>
  plots
    .filter(({ isAlone }) => isAlone)
    .map(({ plot: { kind, code, altitude_ft } }) =>
      `radar ${kind === "primary" ? "echo" : "reply"} ${joined(code, altitude_ft, (feet) => `${whole(feet)} feet`)}`.trim(),
    );
