// The latency of each stage: a bar from its input to its result, in lanes, around the time shown.

import { Pane } from "./pane.js";
import { byId, colour, on } from "./dom.js";
import { BOLD, FONT, FONT_SMALL, box, line, onSize, within, write } from "./pen.js";
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
const LEFT = 128,
  RIGHT = 10;
const SPEECH_OPACITY = 0.35; // of a bar while somebody speaks: nothing can be late then

/** Returns a latency in ms or s. */
const latency = (value) => (value < 1 ? `${Math.round(value * 1000)} ms` : `${fixed(value, 2)} s`);

export class Latencies extends Pane {
  #canvas = byId("latencies");
  #size;

  constructor(run, clock) {
    super(run, clock);
    this.#size = onSize(this.#canvas, () => this.draw());
    for (const name of ["profile", "latencies"])
      on(`show-${name}`, "click", () => this.#show(name));
  }

  #show(shown) {
    for (const name of ["profile", "latencies"]) {
      byId(name).hidden = name !== shown;
      byId(`show-${name}`).setAttribute("aria-pressed", name === shown);
    }
    this.draw();
  }

  draw() {
    if (!this.#size.pen || this.#canvas.hidden) return;
    const { pen, width, height } = this.#size,
      { t, live } = this.clock,
      to = t + (live ? 0 : AHEAD_S),
      from = to - WINDOW_S,
      x = (time) => LEFT + ((time - from) / WINDOW_S) * (width - LEFT - RIGHT),
      bottom = height - 20,
      tall = bottom / STAGES.length;
    box(pen, colour("--panel"), 0, 0, width, height);
    this.#drawGrid(x, from, to, bottom);
    const told = STAGES.map(([stage, name], i) => {
      const ofStage = this.run.latencies.filter((bar) => bar[0] === stage),
        seen = ofStage.filter((bar) => bar[2] >= from && bar[1] <= Math.min(to, t)),
        last = ofStage.findLast((bar) => bar[2] <= t),
        text = last ? latency(last[2] - last[1]) : "none yet",
        middle = (i + 0.5) * tall;
      const bar = (begin, end) => {
        const wide = Math.max(x(Math.min(end, t)) - x(begin), 2);
        box(pen, colour(`--c${i}`), x(begin), middle - tall * 0.28, wide, tall * 0.56);
      };
      within(pen, [LEFT, 0, width - RIGHT, height], () => {
        for (const [, begin, end, , spoken = begin] of seen) {
          pen.globalAlpha = SPEECH_OPACITY;
          if (spoken > begin) bar(begin, spoken);
          pen.globalAlpha = 1;
          if (spoken < t) bar(spoken, end);
        }
      });
      pen.textAlign = "left";
      pen.font = BOLD;
      write(pen, name, 10, middle + 4, colour("--ink"), colour("--panel"));
      pen.font = FONT;
      pen.textAlign = "right";
      write(pen, text, LEFT - 8, middle + 4, colour(last ? "--ink" : "--dim"), colour("--panel"));
      return `${name} ${text}`;
    });
    this.#canvas.ariaLabel = `Latency of each stage: ${told.join(", ")}`;
  }

  #drawGrid(x, from, to, bottom) {
    const { pen, width, height } = this.#size;
    pen.font = FONT_SMALL;
    pen.textAlign = "center";
    for (let time = Math.max(Math.ceil(from / 10) * 10, 0); time <= to; time += 10) {
      line(pen, colour("--grid"), 1, [x(time), 0], [x(time), bottom]);
      pen.fillStyle = colour("--dim");
      pen.fillText(seconds(time, 0), Math.min(x(time), width - 20), height - 6);
    }
    line(pen, colour("--ink"), 1.5, [x(this.clock.t), 0], [x(this.clock.t), bottom]);
  }
}
