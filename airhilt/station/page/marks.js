// The strip above the slider: calls as bars, advisories as triangles, the conflict as diamonds, and
// the loop.

import { Pane } from "./pane.js";
import { byId, colour } from "./dom.js";
import { FILLED, box, onSize, severityInk, stamp } from "./pen.js";

const TRIANGLE = new Path2D("M0 0 5 8H-5Z"),
  DIAMOND = new Path2D("M0-5 4 0 0 5-4 0Z");
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
      const edge = severityInk(severity),
        fill = FILLED.includes(severity) ? edge : colour("--page");
      if (kind === "conflict") stamp(pen, DIAMOND, [x(t), height - 13], { fill: colour("--ink") });
      else if (kind === "advisory" && active)
        stamp(pen, TRIANGLE, [x(t), 1], { fill, edge, width: 1.4 });
    }
  }
}
