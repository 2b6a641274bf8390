// Altitude over time, with the time shown; a click sets it.

import { FONT, byId, colour, onSize, write } from "./dom.js";
import { seconds, whole } from "./words.js";

/** Returns a round step that gives at most `most` ticks. */
export function niceStep(range, most) {
  const rough = Math.max(range, 1e-9) / most,
    power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= rough);
}

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

const MOST_POINTS = 400;

/** Returns the indices of the points of a track that are drawn: not many, and the last one. */
function thinned(track) {
  const step = Math.ceil(track.t.length / MOST_POINTS) || 1,
    indices = [];
  for (let i = 0; i < track.t.length; i += step) indices.push(i);
  if (indices.length && indices.at(-1) !== track.t.length - 1) indices.push(track.t.length - 1);
  return indices;
}

export class Profile {
  #canvas = byId("profile");
  #run;
  #clock;
  #size = null;
  #picture = null;

  constructor(run, clock) {
    this.#run = run;
    this.#clock = clock;
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
    onSize(this.#canvas, (pen, width, height) => {
      this.#size = { pen, width, height };
      this.redraw();
    });
  }

  get #area() {
    return { left: 58, right: this.#size.width - 12, top: 12, bottom: this.#size.height - 22 };
  }

  #x(t) {
    const { left, right } = this.#area;
    return left + (t / Math.max(this.#clock.end, 1e-9)) * (right - left);
  }

  /** Draws everything again, because the size, the colours or the run have changed. */
  redraw() {
    if (!this.#size) return;
    this.#picture = null;
    this.draw();
  }

  draw() {
    if (!this.#size) return;
    const { pen, width, height } = this.#size;
    if (!this.#picture) {
      this.#drawLines();
      const copy = document.createElement("canvas");
      copy.width = this.#canvas.width;
      copy.height = this.#canvas.height;
      copy.getContext("2d").drawImage(this.#canvas, 0, 0);
      this.#picture = copy;
    }
    pen.drawImage(this.#picture, 0, 0, width, height);
    const { top, bottom, right } = this.#area,
      x = Math.min(this.#x(this.#clock.t), right); // the lines are a little older than the time
    pen.strokeStyle = colour("--ink");
    pen.lineWidth = 1.4;
    pen.beginPath();
    pen.moveTo(x, top);
    pen.lineTo(x, bottom);
    pen.stroke();
  }

  #drawLines() {
    const { pen, width, height } = this.#size,
      { left, right, top, bottom } = this.#area,
      tracks = this.#run.tracks;
    pen.fillStyle = colour("--panel");
    pen.fillRect(0, 0, width, height);
    const values = tracks.flatMap((track) => thinned(track).map((i) => track.altitude_ft[i])),
      first = values[0];
    const low = values.reduce((a, b) => Math.min(a, b), first ?? 0),
      high = values.reduce((a, b) => Math.max(a, b), first ?? 1000),
      pad = Math.max((high - low) * 0.08, 50);
    const y = (feet) => bottom - ((feet - low + pad) / (high - low + 2 * pad)) * (bottom - top);
    pen.font = FONT.replace("12px", "11px");
    pen.lineWidth = 1;
    pen.strokeStyle = colour("--grid");
    pen.fillStyle = colour("--dim");
    const step = niceStep(high - low + 2 * pad, Math.max(Math.floor((bottom - top) / 22), 3));
    pen.textAlign = "right";
    for (let feet = Math.ceil((low - pad) / step) * step; feet <= high + pad; feet += step) {
      pen.beginPath();
      pen.moveTo(left, y(feet));
      pen.lineTo(right, y(feet));
      pen.stroke();
      pen.fillText(`${whole(feet)}${feet + step > high + pad ? " ft" : ""}`, left - 5, y(feet) + 4);
    }
    pen.textAlign = "center";
    const mostTicks = Math.max(Math.floor((right - left) / 80), 2);
    for (const { t, label } of timeTicks(this.#clock.end, mostTicks)) {
      pen.beginPath();
      pen.moveTo(this.#x(t), top);
      pen.lineTo(this.#x(t), bottom);
      pen.stroke();
      pen.fillText(label, Math.min(this.#x(t), width - 20), height - 6);
    }
    const named = [];
    for (const track of tracks) {
      pen.strokeStyle = colour(track.colour);
      pen.lineWidth = 2;
      pen.beginPath();
      thinned(track).forEach((i) => {
        if (i) pen.lineTo(this.#x(track.t[i]), y(track.altitude_ft[i]));
        else pen.moveTo(this.#x(track.t[i]), y(track.altitude_ft[i]));
      });
      pen.stroke();
    }
    pen.textAlign = "left";
    for (const track of tracks) {
      let ty = y(track.altitude_ft[0]) - 5;
      while (named.some((other) => Math.abs(other - ty) < 12)) ty -= 12;
      if (ty < 10) continue;
      named.push(ty);
      write(
        pen,
        track.callsign,
        this.#x(track.first) + 4,
        ty,
        colour(track.colour),
        colour("--panel"),
      );
    }
  }
}
