// Tells when a run falls behind the clock that its pace asks for.

import { byId } from "./dom.js";
import { seconds } from "./words.js";

const LEAST_S = 1; // of the run, from which it is told
const PERIOD_S = 1; // of the run, in which it tells its time

export class Lag {
  #run;
  #toldMs = null; // when the run has told its time

  constructor(run) {
    this.#run = run;
  }

  /** Takes in that the run has told its time, and by how much it was behind then. */
  told() {
    this.#toldMs = performance.now();
    this.draw(true);
  }

  /** Shows how far behind the run is by now, as far as the station can be heard. */
  draw(isHeard) {
    const behind = isHeard ? this.#behind : 0,
      text =
        behind > LEAST_S
          ? `${seconds(behind, 0)} behind the clock: the machine does not keep up`
          : "";
    if (byId("behind").textContent !== text) byId("behind").textContent = text;
  }

  /** Seconds of the run by which it is behind; one that stands still tells nothing of it. */
  get #behind() {
    const { phase, pace, behind } = this.#run,
      factor = pace === "realtime" ? 1 : Number.parseFloat(pace);
    if (phase !== "running" || this.#toldMs === null || !(factor > 0)) return 0;
    const passed = ((performance.now() - this.#toldMs) / 1000) * factor;
    return behind + Math.max(passed - PERIOD_S, 0);
  }
}
