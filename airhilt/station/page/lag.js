// Tells when a run falls behind the clock that its pace asks for.

import { byId, write } from "./dom.js";
import { seconds } from "./words.js";

const LEAST_S = 1; // of the run, from which it is told
const PERIOD_S = 1; // of the run, in which it tells its time

export class Lag {
  #run;
  #toldMs = null; // when the run has told its time
  #isBehind = false; // as it was shown last

  constructor(run) {
    this.#run = run;
  }

  /** Takes in that the run has told its time, and by how much it was behind then. */
  told() {
    this.#toldMs = performance.now();
    this.draw(true, this.#toldMs);
  }

  /**
   * Shows how far behind the run was when the last message of any kind came; a screen reader is
   * told when that begins and ends.
   */
  draw(isHeard, heardMs) {
    const behind = isHeard ? this.#behindAt(heardMs) : 0,
      isBehind = behind > LEAST_S,
      text = isBehind ? `${seconds(behind, 0)} behind the clock: the machine does not keep up` : "";
    write(byId("behind"), text);
    if (isBehind === this.#isBehind) return;
    this.#isBehind = isBehind;
    const end = isHeard ? "The run is not behind the clock any more." : "";
    byId("behind-told").textContent = isBehind ? "The run is behind the clock." : end;
  }

  /** Seconds of the run by which it is behind; one that stands still tells nothing of it. */
  #behindAt(heardMs) {
    const { phase, pace, behind } = this.#run,
      factor = pace === "realtime" ? 1 : Number.parseFloat(pace);
    if (phase !== "running" || this.#toldMs === null || !(factor > 0)) return 0;
    const passed = ((heardMs - this.#toldMs) / 1000) * factor;
    return behind + Math.max(passed - PERIOD_S, 0);
  }
}
