// Pause and slow motion of the run itself, for all who take part.

import { byId, html, on } from "./dom.js";

export const PACES = { realtime: "real time", virtual: "as fast as it can" };

export class RunPace {
  #live;
  #run;
  #mayPause = false; // It is known with the seat.

  constructor(live) {
    this.#live = live;
    this.#run = live.run;
    on("pace-pause", "click", () => this.#set(this.#isPaused ? this.#chosen : 0));
    on("pace-factor", "change", () => !this.#isPaused && this.#set(this.#chosen));
  }

  /** Asks the run for a part of real time; 0 is a pause. */
  #set(factor) {
    this.#live.do({ do: "pace", factor }, "Not set: the connection is lost.");
  }

  get #isPaused() {
    return this.#run.pace === "paused";
  }

  /** The pace chosen, as a part of real time: nobody makes a run faster from here. */
  get #chosen() {
    return Math.min(Number(byId("pace-factor").value) || 1, 1);
  }

  /** Takes in the state of the own seat: some runs have no pause. */
  setState(state) {
    this.#mayPause = state.may_pause;
    this.show(true);
  }

  show(isShown) {
    byId("pace").hidden = !(isShown && this.#mayPause);
  }

  draw() {
    byId("pace-pause").setAttribute("aria-pressed", this.#isPaused);
    byId("pace-pause").textContent = this.#isPaused ? "Go on" : "Pause the run";
    if (!this.#isPaused && document.activeElement !== byId("pace-factor"))
      this.#showPace(this.#run.pace);
  }

  /** Shows the pace of the run, also one that nobody can choose here, such as 4x. */
  #showPace(pace) {
    const select = byId("pace-factor"),
      value = pace === "realtime" ? "1" : String(Number.parseFloat(pace));
    select.querySelector("[data-other]")?.remove();
    if (![...select.options].some((option) => option.value === value)) {
      select.prepend(
        html("option", { value, disabled: true, "data-other": true }, PACES[pace] ?? pace),
      );
    }
    select.value = value;
  }
}
