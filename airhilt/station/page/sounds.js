// The sound of each frequency, and of the assistant, in time with the clock.

import { byId, html } from "./dom.js";
import { megahertz } from "./words.js";

const MOST_OFF_S = 0.15;
const AT = "@"; // between the frequency and the seat whose receiver gave out a sound

/** Returns how a sound is called: of the assistant, of a frequency, or of a frequency at a seat. */
function labelOf(name) {
  if (name === "assistant") return "Assistant";
  const [khz, seat] = name.split(AT);
  return seat
    ? `${megahertz(Number(khz))} at ${seat.replaceAll("_", " ")}`
    : megahertz(Number(khz));
}

export class Sounds {
  #clock;
  #channels;

  constructor(run, clock) {
    this.#clock = clock;
    this.#channels = run.sounds.map((name) => {
      const audio = new Audio(`api/sounds/${encodeURIComponent(name)}.wav`),
        // The calls are heard at the units' site already.
        isFirst = !name.includes(AT),
        box = html("input", { type: "checkbox", checked: isFirst });
      audio.preload = isFirst ? "auto" : "none";
      box.addEventListener("change", () => this.draw());
      return { audio, box, isFirst, label: html("label", box, labelOf(name)) };
    });
    byId("sounds").replaceChildren(...this.#channels.map(({ label }) => label));
    if (!run.sounds.length) byId("sounds").append(html("span.dim", "no sound"));
  }

  /** Switches all sounds off, or those on that are so at first if none is. */
  mute() {
    const on = this.#channels.some(({ box }) => box.checked);
    for (const { box, isFirst } of this.#channels) box.checked = !on && isFirst;
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
    byId("sounds").replaceChildren(html("label", this.#box, "Listen"));
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
