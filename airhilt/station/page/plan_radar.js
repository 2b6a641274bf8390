// The plots of surveillance radars on the plan: what the last turns of the antennas have found.

import { FONT, colour, write } from "./dom.js";
import { level } from "./labels.js";
import { TURNS } from "./radar_plots.js";
import { known, whole } from "./words.js";

const HALF = 4; // half the width of a plot, in pixels

/**
 * Draws plots, the older ones paler: a cross for an echo, a circle for a reply, both for both. A
 * reply that is alone has its code and its level beside it.
 */
export function drawPlots(view, plots) {
  const { pen } = view;
  pen.strokeStyle = colour("--ink");
  pen.lineWidth = 1.2;
  for (const { plot, age, isAlone } of plots) {
    const [x, y] = view.pixel([plot.east, plot.north]);
    pen.globalAlpha = 1 - age / TURNS;
    pen.beginPath();
    if (plot.kind !== "secondary") {
      pen.moveTo(x - HALF, y);
      pen.lineTo(x + HALF, y);
      pen.moveTo(x, y - HALF);
      pen.lineTo(x, y + HALF);
    }
    if (plot.kind !== "primary") {
      pen.moveTo(x + HALF, y);
      pen.arc(x, y, HALF, 0, 2 * Math.PI);
    }
    pen.stroke();
    if (isAlone && plot.kind !== "primary") {
      pen.font = FONT;
      pen.textAlign = "left";
      write(pen, blockOf(plot), x + 8, y - 6, colour("--ink"), colour("--map"));
    }
  }
  pen.globalAlpha = 1;
}

const blockOf = ({ code, altitude_ft: altitude }) =>
  [code, known(altitude) ? level(altitude) : null].filter((part) => part).join(" ");

/** Returns what the last turn has found besides the actors, in words. */
export function inWords(plots) {
  return plots
    .filter(({ isAlone }) => isAlone)
    .map(({ plot }) =>
      [
        plot.kind === "primary" ? "radar echo" : "radar reply",
        plot.code,
        known(plot.altitude_ft) ? `${whole(plot.altitude_ft)} feet` : null,
      ]
        .filter((part) => part)
        .join(" "),
    );
}
