// What the person at a seat agrees to: the use of the voice, or of typed words alone. It is asked
// before anything of it goes to the run, and once: what was agreed to at a seat is not asked again,
// until it is taken back.
// The station keeps the answers, and refuses what was not agreed to.

import { byId } from "./dom.js";

const KEPT = "consent-denied"; // what is kept of it while a page is loaded again
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
  #run;
  #live;
  #told = new Set(); // the uses to which the person agrees, as the station told last
  #denials; // what is denied at each seat, until the station has taken that in: { what, number, isInDoubt }
  #unknown; // seats at which something was denied to a server that was started anew since
  #unheard = []; // answers that the station has not taken in yet: { number, then, lost }
  #number = 0; // of the last answer
  #asked = null; // the question that is there
  #waiting = new Map(); // what is asked once that is answered, by use
  #pressed = new Set(); // keys that went down while a question was there
  #seat = null;
  #whenTakenBack = () => {};

  /** `live` sends what was answered, and shows what was not done. */
  constructor(run, live) {
    this.#run = run;
    this.#live = live;
    const { serving, denied = [] } = JSON.parse(sessionStorage.getItem(KEPT)) ?? {},
      isKnown = serving === run.serving;
    this.#unknown = isKnown ? [] : denied.map(([seat]) => seat);
    this.#denials = new Map(
      isKnown ? denied.map(([seat, what]) => [seat, { what, isInDoubt: true }]) : [],
    );
    byId("consent-agree").addEventListener("click", () => this.#answer(true));
    byId("consent-decline").addEventListener("click", () => this.#answer(false));
    byId("consent-back").addEventListener("click", () => this.#takeBack());
    byId("consent").addEventListener("close", () => this.#askNext());
    for (const type of ["keydown", "keyup"])
      window.addEventListener(type, (event) => this.#key(event), { capture: true });
  }

  /**
   * Asks for consent to the use of what ("voice" or "words"), and calls `then(isGiven)` once the
   * station has taken in the answer, or `lost()` if it may not have. Nothing is called if the
   * question is put away, or the seat is left. `isRecorded` tells if sound is.
   */
  ask(what, { isRecorded = true, then, lost }) {
    if (this.admits(what)) {
      then(true);
      return;
    }
    if (this.#isAsking) {
      this.#waiting.set(what, () => this.ask(what, { isRecorded, then, lost }));
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

  /** Returns true if the person agrees to a use. Who lets the voice be used may type. */
  admits(what) {
    const denied = this.#denial?.what;
    if (denied === "words" || denied === what) return false;
    return this.#told.has(what) || (what === "words" && this.admits("voice"));
  }

  /** Calls a function when the person takes consent back, whether the station hears of it or not. */
  whenTakenBack(done) {
    this.#whenTakenBack = done;
  }

  /**
   * Takes in to what the station knows the person to agree, and which answers it has taken in since
   * it told that last. What it may not know is told again.
   */
  take({ given, answered }) {
    const isHeard = ({ number }) => answered.includes(number),
      heard = this.#unheard.filter(isHeard);
    this.#unheard = this.#unheard.filter((one) => !isHeard(one));
    this.#told = new Set(given);
    this.#tellUnknown();
    for (const [seat, denial] of this.#denials) if (isHeard(denial)) this.#settle(seat);
    this.#denyAgain();
    this.#draw();
    for (const { then } of heard) then?.();
    this.#askNext();
  }

  /** Takes in that the connection is lost: the station may not have taken in what was answered. */
  lost() {
    const unheard = this.#unheard;
    this.#unheard = [];
    for (const { lost } of unheard) lost();
    this.#askNext();
  }

  /** Takes in one's own seat, null for none: whoever has a seat next is asked again. */
  setSeat(own) {
    this.#seat = own;
    this.#told = new Set();
    this.#unheard = [];
    this.#waiting.clear();
    byId("consent").close();
    this.#draw();
  }

  /** Takes in that the run is over: nothing is asked any more, and the station is told nothing. */
  end() {
    if (this.#denials.size)
      this.#live.refuse("The run is over. It may not know that you did not agree.");
    this.#denials.clear();
    this.#keep();
    this.setSeat(this.#seat);
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
    if (isGiven) {
      this.#denyAgain(); // Before the answer, so that it does not end that.
      this.#send({ what, is_given: true }, () => then(this.admits(what)), lost);
    } else this.#deny(what, () => then(false), lost);
  }

  #takeBack() {
    this.#deny("words");
    this.#whenTakenBack();
  }

  /** Denies a use from now on, whatever the station knows; who denies words denies all. */
  #deny(what, then, lost = () => {}) {
    const before = this.#denial,
      isAll = what === "words" || before?.what === "words";
    this.#denials.set(this.#seat, {
      what: isAll ? "words" : what,
      isInDoubt: Boolean(before?.isInDoubt),
    });
    this.#keep();
    this.#sendDenial(then, lost);
    this.#draw();
  }

  /** Tells the station once more what is denied at the own seat, unless that is on its way. */
  #denyAgain() {
    const denial = this.#denial;
    if (denial && !this.#unheard.some(({ number }) => number === denial.number)) this.#sendDenial();
  }

  #sendDenial(then, lost = () => {}) {
    const denial = this.#denial;
    denial.number = this.#number + 1;
    this.#send({ what: denial.what, is_given: false }, then, () => {
      lost();
      denial.isInDoubt = true;
      this.#live.refuse(
        "The connection is lost. The station may not know that you do not agree until you are at the seat again.",
      );
    });
  }

  /** What is denied at the own seat. */
  get #denial() {
    return this.#denials.get(this.#seat);
  }

  /** Takes in that the station knows what is denied at a seat. */
  #settle(seat) {
    if (this.#denials.get(seat).isInDoubt)
      this.#live.refuse(`The station knows now that consent was denied at ${seat}.`);
    this.#denials.delete(seat);
    this.#keep();
  }

  /** Tells once what nobody will know. */
  #tellUnknown() {
    if (!this.#unknown.length) return;
    this.#live.refuse(
      `The server was started anew. It does not know that consent was denied at ${this.#unknown.join(", ")}.`,
    );
    this.#unknown = [];
    this.#keep();
  }

  /** Keeps what is denied: a page that is loaded again goes on. */
  #keep() {
    const denied = [...this.#denials].map(([seat, { what }]) => [seat, what]);
    sessionStorage.setItem(KEPT, JSON.stringify({ serving: this.#run.serving, denied }));
  }

  #send(answer, then, lost) {
    const number = ++this.#number;
    if (this.#live.send({ consent: { answer, number } })) this.#unheard.push({ number, then, lost });
    else lost();
  }

  #draw() {
    byId("consent-back").hidden = !this.admits("words");
  }

  /** True if a question is there, or the station has not taken in the answer. */
  get #isAsking() {
    return byId("consent").open || this.#unheard.some(({ then }) => then);
  }

  #askNext() {
    while (this.#waiting.size && !this.#isAsking) {
      const [[what, ask]] = this.#waiting;
      this.#waiting.delete(what);
      ask();
    }
  }
}
