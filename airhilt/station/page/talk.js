// What the person at a seat says, hears, and is warned of.

import { byId, on } from "./dom.js";
import { Frequencies } from "./frequencies.js";
import { sentence } from "./live.js";
import { Loudspeaker } from "./loudspeaker.js";
import { Microphone } from "./microphone.js";
import { RunPace } from "./run_pace.js";
import { OwnAdvisories } from "./own_advisories.js";
import { Phrases } from "./phrases.js";
import { Workload } from "./workload.js";

export class Talk {
  #run;
  #live;
  #own = null;
  #microphone;
  #loudspeaker;
  #advisories;
  #pace;
  #frequencies;
  #phrases;
  #workload;
  #isPrepared = false; // what is known of the seat from its beginning has been shown

  constructor(run, live) {
    this.#run = run;
    this.#live = live;
    this.#frequencies = new Frequencies(live);
    this.#microphone = new Microphone(live, this.#frequencies);
    this.#loudspeaker = new Loudspeaker(live);
    this.#advisories = new OwnAdvisories(live, this.#loudspeaker);
    this.#pace = new RunPace(live);
    this.#phrases = new Phrases(run);
    this.#workload = new Workload(live);
    this.#microphone.setState(null);
    on("strips", "focusin", ({ target }) =>
      this.#phrases.address(target.closest(".flight-strip")?.dataset.callsign),
    );
    on("seat-take", "click", () => this.#loudspeaker.begin());
  }

  /** Keys of a seat, for the list of keys. */
  get keys() {
    const isUsed = () => Boolean(this.#own),
      press = "press a button, tick a box or clear it",
      rate = ({ key }) => this.#workload.rate(Number(key));
    return [
      { names: [" "], text: "hold to talk", isUsed, act: () => {} }, // the microphone takes it
      { names: ["Enter"], text: press, isUsed, act: ({ target }) => target.click() },
      { names: [..."12345"], text: "workload, when it is asked", isUsed, act: rate },
    ];
  }

  /** Frequencies that the person at the seat listens to, in kHz; null without a seat. */
  get heard() {
    return this.#own ? this.#frequencies.heard : null;
  }

  /** Takes in that the connection is lost: nobody is on the air without it. */
  lost() {
    this.#microphone.release();
  }

  /** Takes in one's own seat, null for none. */
  setSeat(own) {
    this.#pace.show(Boolean(own));
    if (own === this.#own) return;
    this.#own = own;
    this.#isPrepared = false;
    if (own) {
      this.#loudspeaker.begin();
      this.#takeActive();
    } else {
      this.#microphone.setState(null);
      this.#loudspeaker.end();
      this.#advisories.clear();
      this.#frequencies.show([]);
      this.#workload.take(null);
    }
    this.#phrases.setSeat(own);
    this.#live.echo();
  }

  #takeActive() {
    for (const row of this.#run.activeAdvisories(this.#run.now ?? 0))
      this.#advisories.takeAdvisory(row);
  }

  /** Takes in that the run is over: nobody hears what is said, and nothing is asked any more. */
  end() {
    this.#workload.take(null);
    this.#microphone.setState(null);
  }

  /** Forgets the advisories of the former seat. */
  forget() {
    this.#advisories.clear();
  }

  /** Takes in a message of the server. */
  take({ own, changes, sounds, cut }) {
    if (cut) this.#microphone.cut(sentence(cut));
    if (changes?.some(([kind]) => kind === "clock")) this.#pace.draw();
    for (const [kind, row] of this.#own ? (changes ?? []) : []) {
      if (kind === "name") this.#takeActive(); // An advisory knew the aircraft by its address alone.
      if (kind === "advisory") this.#advisories.takeAdvisory(row);
      if (kind === "spoken") this.#advisories.takeSpoken(row);
    }
    const state = own?.find(([kind]) => kind === "seat")?.[1];
    if (state && this.#own) this.#takeState(state);
    if (changes?.some(([kind]) => kind === "call")) this.#phrases.renew();
    if (!sounds || !this.#own) return;
    this.#frequencies.take(sounds);
    this.#loudspeaker.take(sounds, this.#microphone.isHeld);
  }

  /** Takes in the state of the own seat. */
  #takeState(state) {
    const isOver = this.#run.isOver;
    this.#microphone.setState(isOver ? null : state);
    this.#pace.setState(state);
    this.#workload.take(isOver ? null : state.question, this.#run.now ?? 0);
    this.#frequencies.show(state.frequencies_khz, state.tuned_khz);
    if (!this.#isPrepared || state.spoken_from !== this.#advisories.spokenFrom) {
      this.#advisories.spokenFrom = state.spoken_from;
      this.#takeActive(); // What is in force and nobody speaks sounds now.
    }
    if (this.#isPrepared) return;
    this.#isPrepared = true;
    this.#phrases.setSeat(this.#own, state.phraseology);
    // The space bar is not to give the seat back at once.
    if (document.activeElement === byId("seat-take"))
      byId(byId("talk-button").disabled ? "words" : "talk-button").focus();
  }
}
