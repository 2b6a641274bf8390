// What the person at a seat agrees to: the use of the voice, or of typed words alone. It is asked
// before anything of it goes to the run, and once: what was agreed to at a seat is not asked again.

import { byId } from "./dom.js";

const QUESTIONS = {
  voice: { title: "Your voice", agree: "Open the microphone", decline: "Only type" },
  words: { title: "What you type", agree: "Agree and say it", decline: "Do not say it" },
};

export class Consent {
  #send;
  #given = new Set();
  #asked = null;

  /** `send(wish)` tells the run what was answered. */
  constructor(send) {
    this.#send = send;
    byId("consent-agree").addEventListener("click", () => this.#answer(true));
    byId("consent-decline").addEventListener("click", () => this.#answer(false));
  }

  /**
   * Asks for consent to the use of what ("voice" or "words"), of which a text tells, and calls
   * `then(isGiven)`; not if the question is put away. Who lets the voice be used may type.
   */
  ask(what, text, then) {
    if (this.#given.has(what) || this.#given.has("voice")) {
      then(true);
      return;
    }
    const { title, agree, decline } = QUESTIONS[what];
    byId("consent-title").textContent = title;
    byId("consent-text").textContent = text;
    byId("consent-agree").textContent = agree;
    byId("consent-decline").textContent = decline;
    this.#asked = { what, then };
    byId("consent").showModal();
  }

  /** Forgets what was agreed to: whoever has a seat next is asked again. */
  forget() {
    this.#given.clear();
    byId("consent").close();
  }

  #answer(isGiven) {
    const { what, then } = this.#asked;
    byId("consent").close();
    if (isGiven) this.#given.add(what);
    this.#send({ consent: { what, is_given: isGiven } });
    then(isGiven);
  }
}
