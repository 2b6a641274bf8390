// The strip above the slider: calls as bars, advisories as triangles, the conflict as diamonds, and
// the loop.

import { byId, colour, onSize } from "./dom.js";

const THUMB_PX = 8; // half the width of the slider's thumb, by which its ends are inside the strip

export class Marks {
  #run;
  #clock;
  #size = null;

  constructor(run, clock) {
    this.#run = run;
    this.#clock = clock;
    onSize(byId("marks"), (pen, width, height) => {
      this.#size = { pen, width, height };
      this.draw();
    });
  }

  draw() {
    if (!this.#size) return;
    const { pen, width, height } = this.#size,
      { loop, end } = this.#clock;
    const x = (t) => THUMB_PX + (t / Math.max(end, 1e-9)) * (width - 2 * THUMB_PX);
    pen.clearRect(0, 0, width, height);
    if (loop.from !== null || loop.to !== null) {
      const from = x(loop.from ?? loop.to),
        to = x(loop.to ?? loop.from);
      pen.fillStyle = colour(loop.on ? "--now-fill" : "--grid");
      pen.fillRect(from, 0, Math.max(to - from, 2), height);
      pen.fillStyle = colour("--accent");
      for (const edge of [from, to]) pen.fillRect(edge - 1, 0, 2, height);
    }
    pen.fillStyle = colour("--dim");
    for (const call of this.#run.calls)
      pen.fillRect(x(call.from), height - 6, Math.max(x(call.to) - x(call.from), 2), 5);
    for (const event of this.#run.events) {
      if (event.kind === "conflict") this.#diamond(x(event.t), height - 13);
      else if (event.kind === "advisory" && event.active)
        this.#triangle(x(event.t), 1, event.severity);
    }
  }

  #triangle(x, y, severity) {
    const { pen } = this.#size,
      ink = colour(
        { WARNING: "--bad", CAUTION: "--warn", ADVISORY: "--accent" }[severity] ?? "--dim",
      );
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(x + 5, y + 8);
    pen.lineTo(x - 5, y + 8);
    pen.closePath();
    pen.fillStyle = ["WARNING", "CAUTION"].includes(severity) ? ink : colour("--page");
    pen.strokeStyle = ink;
    pen.lineWidth = 1.4;
    pen.fill();
    pen.stroke();
  }

  #diamond(x, y) {
    const { pen } = this.#size;
    pen.beginPath();
    for (const [dx, dy] of [
      [0, -5],
      [4, 0],
      [0, 5],
      [-4, 0],
    ])
      pen.lineTo(x + dx, y + dy);
    pen.closePath();
    pen.fillStyle = colour("--ink");
    pen.fill();
  }
}
