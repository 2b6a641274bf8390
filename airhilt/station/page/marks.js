// The strip above the slider: calls as bars, advisories as triangles, the conflict as diamonds, and
// the loop.

import { Pane } from "./pane.js";
import { byId, colour } from "./dom.js";
import { FILLED, box, onSize, severityInk, shape } from "./pen.js";

const THUMB_PX = 8; // half the width of the slider's thumb, by which its ends are inside the strip

export class Marks extends Pane {
  #size;

  constructor(run, clock) {
    super(run, clock);
    this.#size = onSize(byId("marks"), () => this.draw());
  }

  draw() {
    if (!this.#size.pen) return;
    const { pen, width, height } = this.#size,
      { loop, end } = this.clock,
      x = (t) => THUMB_PX + (t / Math.max(end, 1e-9)) * (width - 2 * THUMB_PX);
    pen.clearRect(0, 0, width, height);
    if (loop.from !== null || loop.to !== null) {
      const from = x(loop.from ?? loop.to),
        to = x(loop.to ?? loop.from);
      box(pen, colour(loop.on ? "--now-fill" : "--grid"), from, 0, Math.max(to - from, 2), height);
      for (const edge of [from, to]) box(pen, colour("--accent"), edge - 1, 0, 2, height);
    }
    for (const { from, to } of this.run.calls)
      box(pen, colour("--dim"), x(from), height - 6, Math.max(x(to) - x(from), 2), 5);
    for (const { t, kind, active, severity } of this.run.events) {
      if (kind === "conflict") diamond(pen, x(t), height - 13);
      else if (kind === "advisory" && active) triangle(pen, x(t), severity);
    }
  }
}

function triangle(pen, x, severity) {
  const edge = severityInk(severity),
    fill = FILLED.includes(severity) ? edge : colour("--page");
  shape(pen, { fill, edge, width: 1.4 }, [x, 1], [x + 5, 9], [x - 5, 9]);
}

const diamond = (pen, x, y) =>
  shape(pen, { fill: colour("--ink") }, [x, y - 5], [x + 4, y], [x, y + 5], [x - 4, y]);
