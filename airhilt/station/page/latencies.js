// The latency of each stage: a bar from its input to its result, in lanes, around the time shown.

import { BOLD, FONT, byId, colour, onSize, write } from "./dom.js";
import { fixed, seconds } from "./words.js";

const STAGES = [
  ["asr", "ASR"],
  ["vision", "Vision"],
  ["adsb", "ADS-B"],
  ["decision", "Decision"],
  ["tts", "Voice"],
];
const WINDOW_S = 60,
  AHEAD_S = 10; // shown in all, and of that after the time shown where the run has ended
const LEFT = 128;

/** Returns a latency in ms or s. */
const latency = (value) => (value < 1 ? `${Math.round(value * 1000)} ms` : `${fixed(value, 2)} s`);

export class Latencies {
  #canvas = byId("latencies");
  #run;
  #clock;
  #size = null;

  constructor(run, clock) {
    this.#run = run;
    this.#clock = clock;
    onSize(this.#canvas, (pen, width, height) => {
      this.#size = { pen, width, height };
      this.draw();
    });
    for (const name of ["profile", "latencies"])
      byId(`show-${name}`).addEventListener("click", () => this.#show(name));
  }

  #show(shown) {
    for (const name of ["profile", "latencies"]) {
      byId(name).hidden = name !== shown;
      byId(`show-${name}`).setAttribute("aria-pressed", name === shown);
    }
    this.draw();
  }

  draw() {
    if (!this.#size || this.#canvas.hidden) return;
    const { pen, width, height } = this.#size,
      { t } = this.#clock,
      to = t + (this.#clock.live ? 0 : AHEAD_S),
      from = to - WINDOW_S;
    const x = (time) => LEFT + ((time - from) / WINDOW_S) * (width - LEFT - 10),
      bottom = height - 20,
      tall = bottom / STAGES.length;
    pen.fillStyle = colour("--panel");
    pen.fillRect(0, 0, width, height);
    this.#drawGrid(x, from, to, bottom);
    const told = [];
    STAGES.forEach(([stage, name], i) => {
      const bars = this.#run.latencies.filter(
          (bar) => bar[0] === stage && bar[2] >= from && bar[1] <= Math.min(to, t),
        ),
        middle = (i + 0.5) * tall;
      const last = this.#run.latencies.findLast((bar) => bar[0] === stage && bar[2] <= t);
      pen.fillStyle = colour(`--c${i}`);
      pen.save();
      pen.beginPath();
      pen.rect(LEFT, 0, width - LEFT - 10, height);
      pen.clip();
      for (const [, begin, end, , spoken] of bars) {
        // While somebody speaks, nothing can be late.
        pen.globalAlpha = spoken === undefined ? 1 : 0.35;
        pen.fillRect(
          x(begin),
          middle - tall * 0.28,
          Math.max(x(Math.min(spoken ?? end, t)) - x(begin), 2),
          tall * 0.56,
        );
        pen.globalAlpha = 1;
        if (spoken !== undefined && spoken < t)
          pen.fillRect(
            x(spoken),
            middle - tall * 0.28,
            Math.max(x(Math.min(end, t)) - x(spoken), 2),
            tall * 0.56,
          );
      }
      pen.restore();
      pen.textAlign = "left";
      pen.font = BOLD;
      write(pen, name, 10, middle + 4, colour("--ink"), colour("--panel"));
      pen.font = FONT;
      pen.textAlign = "right";
      const text = last ? latency(last[2] - last[1]) : "none yet";
      write(pen, text, LEFT - 8, middle + 4, colour(last ? "--ink" : "--dim"), colour("--panel"));
      told.push(`${name} ${text}`);
    });
    this.#canvas.setAttribute("aria-label", `Latency of each stage: ${told.join(", ")}`);
  }

  #drawGrid(x, from, to, bottom) {
    const { pen, width, height } = this.#size;
    pen.font = FONT.replace("12px", "11px");
    pen.textAlign = "center";
    pen.lineWidth = 1;
    for (let time = Math.max(Math.ceil(from / 10) * 10, 0); time <= to; time += 10) {
      pen.strokeStyle = colour("--grid");
      pen.beginPath();
      pen.moveTo(x(time), 0);
      pen.lineTo(x(time), bottom);
      pen.stroke();
      pen.fillStyle = colour("--dim");
      pen.fillText(seconds(time, 0), Math.min(x(time), width - 20), height - 6);
    }
    pen.strokeStyle = colour("--ink");
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.moveTo(x(this.#clock.t), 0);
    pen.lineTo(x(this.#clock.t), bottom);
    pen.stroke();
  }
}
