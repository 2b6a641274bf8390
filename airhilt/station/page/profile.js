// Altitude over time, with the time shown; a click sets it.

import { Pane } from "./pane.js";
import { byId, colour } from "./dom.js";
import { FONT_SMALL, box, copyOf, line, onSize, write } from "./pen.js";
import { niceStep } from "./series.js";
import { seconds, whole } from "./words.js";

const LEAST_TICK_S = 0.1;

/** Returns times from 0 s to an end and their labels, at most `most` steps. */
export function timeTicks(end, most) {
  const step = Math.max(niceStep(end, most), LEAST_TICK_S),
    label = step < 1 ? seconds : (t) => `${whole(t)} s`;
  return Array.from({ length: Math.floor(end / step + 1e-9) + 1 }, (_, i) => ({
    t: i * step,
    label: label(i * step),
  }));
}

const MOST_POINTS = 400; // of a track that are drawn

export class Profile extends Pane {
  #canvas = byId("profile");
  #size;
  #picture = null;

  constructor(run, clock) {
    super(run, clock);
    const seek = (event) =>
      clock.set(
        ((event.offsetX - this.#area.left) / (this.#area.right - this.#area.left)) * clock.end,
      );
    this.#canvas.addEventListener("pointerdown", (event) => {
      this.#canvas.setPointerCapture(event.pointerId);
      seek(event);
    });
    this.#canvas.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) seek(event);
    });
    this.#size = onSize(this.#canvas, () => this.redraw());
  }

  get #area() {
    return { left: 58, right: this.#size.width - 12, top: 12, bottom: this.#size.height - 22 };
  }

  #x(t) {
    const { left, right } = this.#area;
    return left + (t / Math.max(this.clock.end, 1e-9)) * (right - left);
  }

  /** Draws everything again, because the size, the colours or the run have changed. */
  redraw() {
    this.#picture = null;
    this.draw();
  }

  draw() {
    if (!this.#size.pen) return;
    const { pen, width, height } = this.#size,
      { top, bottom, right } = this.#area,
      x = Math.min(this.#x(this.clock.t), right); // the lines are a little older than the time
    if (!this.#picture) {
      this.#drawLines();
      this.#picture = copyOf(this.#canvas);
    }
    pen.drawImage(this.#picture, 0, 0, width, height);
    line(pen, colour("--ink"), 1.4, [x, top], [x, bottom]);
  }

  #drawLines() {
    const { pen, width, height } = this.#size,
      { left, right, top, bottom } = this.#area,
      lines = this.run.tracks.map((track) => ({ track, indices: track.thinned(MOST_POINTS) })),
      values = lines.flatMap(({ track, indices }) => indices.map((i) => track.altitude_ft[i]));
    const low = values.reduce((a, b) => Math.min(a, b), values[0] ?? 0),
      high = values.reduce((a, b) => Math.max(a, b), values[0] ?? 1000),
      pad = Math.max((high - low) * 0.08, 50),
      step = niceStep(high - low + 2 * pad, Math.max(Math.floor((bottom - top) / 22), 3)),
      y = (feet) => bottom - ((feet - low + pad) / (high - low + 2 * pad)) * (bottom - top);
    box(pen, colour("--panel"), 0, 0, width, height);
    pen.font = FONT_SMALL;
    pen.fillStyle = colour("--dim");
    pen.textAlign = "right";
    for (let feet = Math.ceil((low - pad) / step) * step; feet <= high + pad; feet += step) {
      line(pen, colour("--grid"), 1, [left, y(feet)], [right, y(feet)]);
      pen.fillText(`${whole(feet)}${feet + step > high + pad ? " ft" : ""}`, left - 5, y(feet) + 4);
    }
    pen.textAlign = "center";
    const mostTicks = Math.max(Math.floor((right - left) / 80), 2);
    for (const { t, label } of timeTicks(this.clock.end, mostTicks)) {
      line(pen, colour("--grid"), 1, [this.#x(t), top], [this.#x(t), bottom]);
      pen.fillText(label, Math.min(this.#x(t), width - 20), height - 6);
    }
    for (const { track, indices } of lines) {
      const points = indices.map((i) => [this.#x(track.t[i]), y(track.altitude_ft[i])]);
      line(pen, colour(track.colour), 2, ...points);
    }
    this.#drawNames(y);
  }

  /** Writes the callsigns at the beginnings of the lines, none over another. */
  #drawNames(y) {
    const { pen } = this.#size,
      taken = [];
    pen.textAlign = "left";
    for (const { callsign, colour: ink, first, altitude_ft } of this.run.tracks) {
      let bottom = y(altitude_ft[0]) - 5;
      while (taken.some((other) => Math.abs(other - bottom) < 12)) bottom -= 12;
      if (bottom < 10) continue;
      taken.push(bottom);
      write(pen, callsign, this.#x(first) + 4, bottom, colour(ink), colour("--panel"));
    }
  }
}
