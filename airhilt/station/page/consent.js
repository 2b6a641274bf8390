// What the person at a seat agrees to: the use of the voice, or of typed words alone. It is asked
// before anything of it goes to the run, and once: what was agreed to at a seat is not asked again,
// until it is taken back.
// The station keeps the answers, and refuses what was not agreed to.

import { byId } from "./dom.js";

const BACK = "consent-back"; // what is kept of it while a page is loaded again
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
  #seat = null;
  #back = sessionStorage.getItem(BACK); // seat where it was taken back, until the station knows
  #isBackSent = false; // and that is on its way
  #isInDoubt = false; // the person was told that the station may not know
  #times = 0; // that consent was taken back
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

  /** Calls a function when the person takes consent back, whether the station hears of it or not. */
  whenTakenBack(done) {
    this.#whenTakenBack = done;
  }

  /** Takes in what the station knows to be agreed to, unless that was taken back since. */
  take(given) {
    if (this.#isBackSent && !given.length) this.#settle();
    this.#show(this.#isBack ? [] : given);
  }

  /** Takes back at a seat what was taken back there, and the station may not know of. */
  takeBackAgain() {
    if (this.#isBack && !this.#isBackSent) this.#sendBack();
  }

  /** Takes in one's own seat, null for none: whoever has a seat next is asked again. */
  setSeat(own) {
    this.#seat = own;
    this.forget();
  }

  /** Forgets what was agreed to; that it was taken back is kept until the station knows. */
  forget() {
    this.#isBackSent = false;
    this.#show([]);
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
    const { what, then, lost } = this.#asked,
      times = this.#times;
    byId("consent").close();
    this.takeBackAgain(); // Before the answer, so that it does not end that.
    this.#isSent = true;
    this.#live.wish(
      { consent: { what, is_given: isGiven } },
      {
        heard: () => {
          const isLast = times === this.#times; // It was not taken back since,
          if (isLast && this.#isBack) this.#settle(); // and what was before has been heard too.
          const holds = isGiven && isLast;
          if (holds) this.take([...this.#given, what]);
          this.#answered(() => then(holds));
        },
        lost: () => this.#answered(lost),
      },
    );
  }

  #takeBack() {
    this.#times++;
    this.#back = this.#seat;
    sessionStorage.setItem(BACK, this.#seat); // A page that is loaded again goes on.
    this.#sendBack();
    this.#show([]);
    this.#whenTakenBack();
  }

  get #isBack() {
    return this.#back !== null && this.#back === this.#seat;
  }

  /** Takes in that the station knows that consent was taken back. */
  #settle() {
    if (this.#isInDoubt)
      this.#live.refuse("The station knows now that you had taken back your consent.");
    this.#back = null;
    this.#isBackSent = this.#isInDoubt = false;
    sessionStorage.removeItem(BACK);
  }

  #show(given) {
    this.#given = new Set(given);
    byId("consent-back").hidden = !this.#given.size;
  }

  /** Takes consent back; the station then tells that there is none, or has no seat for the page. */
  #sendBack() {
    this.#isBackSent = true;
    this.#live.wish(
      { consent: { what: "words", is_given: false } },
      {
        lost: () => {
          this.#isBackSent = false;
          this.#isInDoubt = true;
          this.#live.refuse(
            "The connection is lost. The station may not know that you have taken back your consent until you are at the seat again.",
          );
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
