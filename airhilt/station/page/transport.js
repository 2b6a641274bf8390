// The controls of the time: playing, speed, events, loop.

import { Pane } from "./pane.js";
import { RATES } from "./clock.js";
import { byId, html, offer, on } from "./dom.js";
import { METRE_PER_NM, feet, metres, miles, seconds } from "./words.js";

const PLAY = "M4 2l10 6-10 6z",
  PAUSE = "M3 2h4v12H3zM9 2h4v12H9z";

const MOST_LISTED = 300; // events of a live run that can be chosen, the newest

export class Transport extends Pane {
  #isOld = false; // The list of events lacks new ones.
  #listed = []; // events that can be chosen

  constructor(run, clock) {
    super(run, clock);
    offer(
      byId("rate"),
      RATES.map((rate) => [rate, `${rate} x`]),
    );
    on("rate", "change", (event) => clock.setRate(Number(event.target.value)));
    on("play", "click", () => clock.toggle());
    on("previous", "click", () => this.step(-1));
    on("next", "click", () => this.step(1));
    on("slider", "input", (event) => clock.set(Number(event.target.value)));
    on("loop-from", "click", () => clock.mark("from"));
    on("loop-to", "click", () => clock.mark("to"));
    on("loop", "click", () => clock.toggleLoop());
    on("events", "change", ({ target }) => {
      if (target.selectedIndex) clock.set(this.#listed[target.selectedIndex - 1].t);
    });
    on("events", "blur", () => {
      if (this.#isOld) this.renew();
    });
    byId("live").hidden = !clock.live;
    on("live", "click", () => clock.follow());
    this.renew();
  }

  /** Lists the events again, because there are new ones; not while somebody chooses one. */
  renew() {
    this.#isOld = document.activeElement === byId("events");
    if (this.#isOld) return;
    const { moments } = this.run;
    this.#listed = moments.slice(this.clock.live ? -MOST_LISTED : 0);
    byId("events").replaceChildren(
      html("option", `an event (${moments.length})`),
      ...this.#listed.map(({ t, text }) => html("option", `${seconds(t)}  ${text}`)),
    );
  }

  /** Goes to the next event, or to the one before with a step of -1. */
  step(step) {
    const { t } = this.clock,
      near = 0.05;
    const found =
      step > 0
        ? this.run.moments.find((moment) => moment.t > t + near)
        : this.run.moments.findLast((moment) => moment.t < t - (this.clock.playing ? 1 : near));
    if (found) this.clock.set(found.t);
  }

  draw() {
    const { t, end, rate, following, loop } = this.clock,
      playing = this.clock.playing || following;
    byId("live").setAttribute("aria-pressed", following);
    byId("play").setAttribute("aria-label", playing ? "Pause" : "Play");
    byId("play-word").textContent = playing ? "Pause" : "Play";
    byId("play-shape").setAttribute("d", playing ? PAUSE : PLAY);
    byId("slider").max = end;
    byId("slider").value = following ? end : t;
    byId("slider").setAttribute("aria-valuetext", seconds(t));
    byId("time").textContent = following ? seconds(t) : `${seconds(t)} of ${seconds(end)}`;
    byId("rate").value = rate;
    byId("loop").setAttribute("aria-pressed", loop.on);
    byId("loop-text").textContent =
      loop.from === null && loop.to === null
        ? ""
        : `${loop.from === null ? "?" : seconds(loop.from)} to ${loop.to === null ? "?" : seconds(loop.to)}`;
    if (document.activeElement !== byId("events"))
      byId("events").selectedIndex =
        this.#listed.findLastIndex((one) => Math.abs(one.t - t) < 0.05) + 1;
    const apart = this.run.apart(t);
    byId("apart").textContent = apart
      ? `${this.run.pair.join(" and ")}: ${distance(apart.horizontal)}, ${feet(apart.vertical)} apart`
      : "";
  }
}

const distance = (m) => (m < METRE_PER_NM ? metres(m) : miles(m / METRE_PER_NM));
