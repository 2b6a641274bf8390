// Pause and slow motion of the run itself, for all who take part.

import { byId } from "./dom.js";

export class RunPace {
  #run;

  /** `set(factor)` asks the run for a part of real time; 0 is a pause. */
  constructor(run, set) {
    this.#run = run;
    byId("pace-pause").addEventListener("click", () => set(this.#isPaused ? Number(byId("pace-factor").value) : 0));
    byId("pace-factor").addEventListener("change", (event) => set(Number(event.target.value)));
  }

  get #isPaused() { return this.#run.pace === "paused"; }

  show(isShown) { byId("pace").hidden = !isShown; }

  draw() {
    byId("pace-pause").setAttribute("aria-pressed", this.#isPaused);
    byId("pace-pause").textContent = this.#isPaused ? "Go on" : "Pause the run";
    const factor = this.#run.pace === "realtime" ? 1 : Number.parseFloat(this.#run.pace);
    if (!this.#isPaused && document.activeElement !== byId("pace-factor")) byId("pace-factor").value = factor;
  }
}
