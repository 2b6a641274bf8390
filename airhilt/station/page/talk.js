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

const ECHO_MS = 2000;

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
  #roundTrip = 0; // s
  #isBehind = false; // what comes was sent while the connection was lost
  #asked = null; // when the echo was asked for that ends this

  constructor(run, live) {
    this.#run = run;
    this.#live = live;
    this.#microphone = new Microphone(
      live,
      () => this.#frequencies.transmit,
      (event) => this.#delay(event),
    );
    this.#loudspeaker = new Loudspeaker((id, after) =>
      live.do({ do: "hear", id, after_s: this.#afterArrival(after) }),
    );
    this.#advisories = new OwnAdvisories(
      run,
      (perceived) =>
        live.do({
          do: "perceive",
          ...perceived,
          after_s: this.#afterArrival(perceived.after_s),
        }),
      (severity, url) => this.#loudspeaker.warn(severity, url),
    );
    this.#pace = new RunPace(run, (factor) =>
      live.do({ do: "pace", factor }, "Not set: the connection is lost."),
    );
    this.#frequencies = new Frequencies((khz) => live.tune(khz));
    this.#phrases = new Phrases(run);
    this.#workload = new Workload(run.nasa_tlx, (answer) =>
      live.do({ do: "answer", ...answer }, "Not answered: the connection is lost."),
    );
    this.#microphone.setState(null);
    on("strips", "focusin", ({ target }) =>
      this.#phrases.address(target.closest(".flight-strip")?.dataset.callsign),
    );
    on("seat-take", "click", () => this.#loudspeaker.begin());
    setInterval(() => live.send({ echo: performance.now() }), ECHO_MS);
  }

  /** Keys of a seat, for the list of keys. */
  get keys() {
    const isUsed = () => Boolean(this.#own),
      ratings = ["1", "2", "3", "4", "5"];
    return [
      { names: [], shown: ["Space"], text: "hold to talk", isUsed }, // the microphone takes it
      {
        names: ["Enter"],
        shown: ["Enter"],
        text: "press a button, tick a box or clear it",
        isUsed,
        act: ({ target }) => target.click(),
      },
      {
        names: ratings,
        shown: ratings,
        text: "workload, when it is asked",
        isUsed,
        act: ({ key }) => this.#workload.rate(Number(key)),
      },
    ];
  }

  /** Frequencies that the person at the seat listens to, in kHz; null without a seat. */
  get heard() {
    return this.#own ? this.#frequencies.heard : null;
  }

  /**
   * Takes in that the connection is lost: nobody is on the air without it, and what is said
   * meanwhile is not heard later.
   */
  lost() {
    this.#microphone.release();
    this.#isBehind = true;
    this.#asked = null;
  }

  /** Finds out, by an echo, if all has come that was sent while the connection was lost. */
  #catchUp(echo) {
    if (!this.#isBehind) return;
    if (this.#asked === null) {
      this.#asked = performance.now();
      this.#live.send({ echo: this.#asked });
    } else if (echo >= this.#asked) this.#isBehind = false;
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
    this.#live.send({ echo: performance.now() });
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
  take({ own, changes, sounds, echo, cut }) {
    this.#catchUp(echo);
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
    if (sounds && this.#own) this.#frequencies.take(sounds);
    if (sounds && this.#own && !this.#isBehind)
      this.#loudspeaker.take(sounds, {
        isOwn: (id) => id.startsWith(`microphone.${this.#own.replace(/[^A-Za-z0-9]+/g, "_")}.`),
        isDeaf: this.#microphone.isHeld,
        isSlow: Number.parseFloat(this.#run.pace) < 1,
      });
    if (echo !== undefined) this.#roundTrip = (performance.now() - echo) / 1000;
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

  /** Time from when a message of now is with the server until a time from now, in s. */
  #afterArrival(after) {
    return Math.max(-10, Math.min(10, after - this.#roundTrip / 2));
  }

  /** Time from an event on the page until a message of now is with the server, in s. */
  #delay(event) {
    return Math.max(0, (performance.now() - event.timeStamp) / 1000 + this.#roundTrip / 2);
  }
}
