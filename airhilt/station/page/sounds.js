// The sound of each frequency, and of the assistant, in time with the clock.

import { keepNewest } from "./bounds.js";
import { byId, html } from "./dom.js";
import { megahertz } from "./words.js";

const MOST_OFF_S = 0.15;

export class Sounds {
  #clock;
  #channels;

  constructor(run, clock) {
    this.#clock = clock;
    this.#channels = run.sounds.map((name) => {
      const audio = new Audio(`api/sounds/${encodeURIComponent(name)}.wav`),
        box = html("input", { type: "checkbox", checked: true });
      audio.preload = "auto";
      box.addEventListener("change", () => this.draw());
      return {
        audio,
        box,
        label: html("label", {}, box, name === "assistant" ? "Assistant" : megahertz(Number(name))),
      };
    });
    byId("sounds").replaceChildren(...this.#channels.map(({ label }) => label));
    if (!run.sounds.length) byId("sounds").append(html("span", { class: "dim" }, "no sound"));
  }

  /** Switches all sounds off, or on if none is. */
  mute() {
    const on = this.#channels.some(({ box }) => box.checked);
    for (const { box } of this.#channels) box.checked = !on;
    this.draw();
  }

  draw() {
    const { t, rate, playing } = this.#clock;
    for (const { audio, box } of this.#channels) {
      const within = playing && box.checked && !audio.error && !(t >= audio.duration);
      if (!within) {
        if (!audio.paused) audio.pause();
        continue;
      }
      if (audio.playbackRate !== rate) audio.playbackRate = rate;
      if (!audio.seeking && Math.abs(audio.currentTime - t) > MOST_OFF_S * Math.max(rate, 1))
        audio.currentTime = t;
      if (audio.paused)
        audio.play().catch(() => {
          box.checked = false;
        });
    }
  }
}

const MOST_BEHIND = 3;
const MOST_HEARD = 1000; // calls that are not heard again

/**
 * The calls of a live run, each when it has ended; where they come faster than they are spoken, old
 * ones are left out.
 */
export class LiveSounds {
  #box = html("input", { type: "checkbox", checked: true });
  #audio = new Audio();
  #heard = new Set();
  #waiting = [];

  constructor() {
    byId("sounds").replaceChildren(html("label", {}, this.#box, "Listen"));
    this.#audio.addEventListener("ended", () => this.#next());
    this.#audio.addEventListener("error", () => this.#next());
    this.#box.addEventListener("change", () => {
      if (!this.#box.checked) {
        this.#waiting = [];
        this.#audio.pause();
      }
    });
  }

  /** Lets a call be heard, once, if somebody listens. */
  add(call) {
    if (!call.has_sound || this.#heard.has(call.id)) return;
    this.#heard.add(call.id);
    keepNewest(this.#heard, MOST_HEARD);
    if (!this.#box.checked) return;
    this.#waiting = [...this.#waiting, call.id].slice(-MOST_BEHIND);
    if (this.#audio.paused || this.#audio.ended) this.#next();
  }

  mute() {
    this.#box.click();
  }

  #next() {
    const id = this.#waiting.shift();
    if (id === undefined) return;
    this.#audio.src = `api/calls/${encodeURIComponent(id)}.wav`;
    // A browser plays nothing before the first click on the page.
    this.#audio.play().catch(() => {});
  }

  draw() {}
}
