// The frequency panel of a seat: which frequencies are heard, on which one is spoken, and which are
// busy.

import { byId, html, write } from "./dom.js";
import { megahertz } from "./words.js";

export class Frequencies {
  #live;
  #rows = new Map();
  #open = new Map(); // frequencies of the transmissions on the air

  constructor(live) {
    this.#live = live;
  }

  /** Shows the frequencies of the seat, and which of them are heard; none without a seat. */
  show(frequencies, tuned = []) {
    const isSame =
      frequencies.length === this.#rows.size && frequencies.every((khz) => this.#rows.has(khz));
    if (!isSame) {
      this.#rows = new Map(frequencies.map((khz, i) => [khz, this.#row(khz, !i)]));
      byId("frequencies").replaceChildren(...[...this.#rows.values()].map(({ item }) => item));
      this.#open.clear();
      for (const [khz, { listen }] of this.#rows) listen.checked = tuned.includes(khz);
    }
    byId("frequencies").hidden = !frequencies.length;
    this.#draw();
  }

  /** Frequencies that are heard, in kHz. */
  get heard() {
    return [...this.#rows].filter(([, { listen }]) => listen.checked).map(([khz]) => khz);
  }

  /** The frequency on which the person speaks, in kHz; null if there is none. */
  get transmit() {
    return [...this.#rows].find(([, { speak }]) => speak.checked)?.[0] ?? null;
  }

  /** Takes in beginnings and ends of transmissions. */
  take(pieces) {
    for (const [phase, { id, frequency_khz: khz }] of pieces) {
      if (phase === "opened") this.#open.set(id, khz);
      if (phase === "closed") this.#open.delete(id);
    }
    this.#draw();
  }

  #row(khz, isFirst) {
    const listen = html("input", { type: "checkbox" }),
      speak = html("input", { type: "radio", name: "transmit", checked: isFirst }),
      lamp = html("span", { class: "lamp", role: "status" });
    listen.addEventListener("change", () => {
      this.#open.clear();
      this.#live.tune(this.heard);
      this.#draw();
    });
    speak.addEventListener("change", () => {
      if (!listen.checked) listen.click();
    }); // as on a radio: who speaks there listens there
    const labels = [html("label", listen, "Listen"), html("label", speak, "Transmit")];
    const item = html("li", html("strong", megahertz(khz)), lamp, labels);
    return { listen, speak, lamp, item };
  }

  #draw() {
    const busy = new Set(this.#open.values());
    for (const [khz, { lamp, listen }] of this.#rows) {
      lamp.classList.toggle("on", busy.has(khz));
      write(lamp, busy.has(khz) ? "busy" : listen.checked ? "free" : "off");
    }
  }
}
