// What the person at a seat agrees to: the use of the voice, or of typed words alone. It is asked
// before anything of it goes to the run, and once: what was agreed to at a seat is not asked again,
// until it is taken back.
// The station keeps the answers, and refuses what was not agreed to.

import { byId } from "./dom.js";

const LOGGED = "What you do at the seat, and what it shows you, is logged.";
const QUESTIONS = {
  voice: {
    title: "Your voice",
    agree: "Open the microphone",
    decline: "Only type",
    text: (isRecorded) =>
      "What you say while you hold the button goes to this run: it is recognised, everybody in the run hears it, and its programs get it. " +
      (isRecorded
        ? "It is recorded in the folder of the run, as sound and as text. What you type is said to everybody too, and kept as text. "
        : "Its sound is not recorded. The words are, as they were recognised, and so is what you type, which is said to everybody too. ") +
      LOGGED,
  },
  words: {
    title: "What you type",
    agree: "Agree and say it",
    decline: "Do not say it",
    text: () =>
      "What you type goes to this run. It is said on the radio for everybody in the run, its programs get it, and it is kept as text in the folder of the run. " +
      LOGGED,
  },
};

export class Consent {
  #live;
  #given = new Set();
  #asked = null;
  #isSent = false; // an answer is on its way, and the station has not heard it
  #next = null; // what is asked after that
  #pressed = new Set(); // keys that went down while a question was there
  #isTakenBack = false; // and the connection was lost before the station may have heard that
  #whenTakenBack = () => {};

  /** `live` sends what was answered, and shows what was not done. */
  constructor(live) {
    this.#live = live;
    byId("consent-agree").addEventListener("click", () => this.#answer(true));
    byId("consent-decline").addEventListener("click", () => this.#answer(false));
    byId("consent-back").addEventListener("click", () => this.#takeBack());
    for (const type of ["keydown", "keyup"])
      window.addEventListener(type, (event) => this.#key(event), { capture: true });
  }

  /**
   * Asks for consent to the use of what ("voice" or "words"), and calls `then(isGiven)` once the
   * station has heard the answer, or `lost()` if it may not have. Nothing is called if the question
   * is put away. Who lets the voice be used may type. `isRecorded` tells if sound is.
   */
  ask(what, { isRecorded = true, then, lost }) {
    if (this.#given.has(what) || this.#given.has("voice")) {
      then(true);
      return;
    }
    if (this.#isSent) {
      this.#next = () => this.ask(what, { isRecorded, then, lost });
      return;
    }
    const { title, agree, decline, text } = QUESTIONS[what];
    byId("consent-title").textContent = title;
    byId("consent-text").textContent = text(isRecorded);
    byId("consent-agree").textContent = agree;
    byId("consent-decline").textContent = decline;
    this.#asked = { what, then, lost };
    this.#pressed.clear();
    byId("consent").showModal();
  }

  /** Calls a function when the person takes consent back, before the station hears of it. */
  whenTakenBack(done) {
    this.#whenTakenBack = done;
  }

  /** Takes in what the station knows to be agreed to at the seat. */
  take(given) {
    this.#given = new Set(given);
    byId("consent-back").hidden = !this.#given.size;
    if (this.#isTakenBack && this.#given.size) this.#takeBack();
  }

  /** Forgets what was agreed to: whoever has a seat next is asked again. */
  forget() {
    this.#isTakenBack = false;
    this.take([]);
    this.#isSent = false;
    this.#next = null;
    byId("consent").close();
  }

  /** Lets no key answer that was held before the question was there. */
  #key(event) {
    if (!byId("consent").open) return;
    const isNew = event.type === "keydown" ? !event.repeat : this.#pressed.has(event.key);
    if (isNew) this.#pressed.add(event.key);
    else event.preventDefault();
  }

  #answer(isGiven) {
    const { what, then, lost } = this.#asked;
    byId("consent").close();
    this.#isSent = true;
    this.#live.wish(
      { consent: { what, is_given: isGiven } },
      {
        heard: () => {
          if (isGiven) this.take([...this.#given, what]);
          this.#answered(() => then(isGiven));
        },
        lost: () => this.#answered(lost),
      },
    );
  }

  /**
   * Takes back all consent; the station then tells that there is none. If the connection is lost
   * before that, it is taken back as soon as the station tells what it knows again.
   */
  #takeBack() {
    this.#isTakenBack = false;
    this.#whenTakenBack();
    this.#live.wish(
      { consent: { what: "words", is_given: false } },
      {
        lost: () => {
          this.#isTakenBack = true;
          this.#live.refuse("The connection is lost. Consent is taken back as soon as it is there again.");
        },
      },
    );
  }

  #answered(then) {
    const next = this.#next;
    this.#isSent = false;
    this.#next = null;
    then();
    next?.();
  }
}
