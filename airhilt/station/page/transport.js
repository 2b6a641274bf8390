// The controls of the time: playing, speed, events, loop.

import { Pane } from "./pane.js";
import { RATES } from "./clock.js";
import { byId, html, on } from "./dom.js";
import { METRE_PER_NM, feet, metres, miles, seconds } from "./words.js";

const PLAY = "M4 2l10 6-10 6z",
  PAUSE = "M3 2h4v12H3zM9 2h4v12H9z";

const MOST_LISTED = 300; // events of a live run that can be chosen, the newest

export class Transport extends Pane {
  #isOld = false; // The list of events lacks new ones.
  #listed = []; // events as they were when they were listed
  #first = 0; // index of the first event that can be chosen

  constructor(run, clock) {
    super(run, clock);
    byId("rate").replaceChildren(
      ...RATES.map((rate) => html("option", { value: rate }, `${rate} x`)),
    );
    on("rate", "change", (event) => clock.setRate(Number(event.target.value)));
    on("play", "click", () => clock.toggle());
    on("previous", "click", () => this.step(-1));
    on("next", "click", () => this.step(1));
    on("slider", "input", (event) => clock.set(Number(event.target.value)));
    on("loop-from", "click", () => clock.mark("from"));
    on("loop-to", "click", () => clock.mark("to"));
    on("loop", "click", () => clock.toggleLoop());
    on("events", "change", (event) => {
      if (event.target.value !== "") clock.set(this.#listed[Number(event.target.value)].t);
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
    const { moments } = this.run,
      first = this.clock.live ? Math.max(moments.length - MOST_LISTED, 0) : 0;
    this.#first = first;
    this.#listed = moments;
    byId("events").replaceChildren(
      html("option", { value: "" }, `an event (${moments.length})`),
      ...moments
        .slice(first)
        .map((moment, i) =>
          html("option", { value: first + i }, `${seconds(moment.t)}  ${moment.text}`),
        ),
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
    const moment = this.run.moments.findLastIndex((one) => Math.abs(one.t - t) < 0.05);
    if (document.activeElement !== byId("events"))
      byId("events").value = moment < this.#first ? "" : moment;
    this.#drawApart(t);
  }

  #drawApart(t) {
    const apart = this.run.apart(t);
    if (!apart) {
      byId("apart").textContent = "";
      return;
    }
    const horizontal =
      apart.horizontal < METRE_PER_NM
        ? metres(apart.horizontal)
        : miles(apart.horizontal / METRE_PER_NM);
    byId("apart").textContent =
      `${this.run.pair.join(" and ")}: ${horizontal}, ${feet(apart.vertical)} apart`;
  }
}
