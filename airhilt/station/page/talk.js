// What the person at a seat says, hears, and is warned of.

import { byId } from "./dom.js";
import { Frequencies } from "./frequencies.js";
import { Loudspeaker } from "./loudspeaker.js";
import { Microphone } from "./microphone.js";
import { RunPace } from "./run_pace.js";
import { OwnAdvisories } from "./own_advisories.js";
import { Phrases } from "./phrases.js";
import { Workload } from "./workload.js";

const ECHO_MS = 2000;
const CUT = "Your call was cut"; // how the run, or the station, tells that a call has been ended

export class Talk {
  #run;
  #live;
  #consent;
  #own = null;
  #microphone;
  #loudspeaker;
  #advisories;
  #pace;
  #frequencies;
  #phrases;
  #workload;
  #roundTrip = 0; // s
  #isBehind = false; // what comes was sent while the connection was lost
  #asked = null; // when the echo was asked for that ends this

  constructor(run, live, consent) {
    this.#run = run;
    this.#live = live;
    this.#consent = consent;
    this.#microphone = new Microphone({
      send: (wish) => live.send(wish),
      sendSound: (buffer) => live.sendSound(buffer),
      unsent: () => live.unsent(),
      isThere: () => live.isThere,
      frequency: () => this.#frequencies.transmit,
      delay: (event) => this.#delay(event),
      consent,
    });
    consent.whenTakenBack(() => {
      this.#microphone.shut("You have taken back your consent.");
      byId(byId("talk-button").disabled ? "words" : "talk-button").focus();
    });
    this.#loudspeaker = new Loudspeaker((id, after) =>
      live.send({ heard: { id, after_s: this.#afterArrival(after) } }),
    );
    this.#advisories = new OwnAdvisories(
      run,
      (perceived) =>
        live.send({ perceived: { ...perceived, after_s: this.#afterArrival(perceived.after_s) } }),
      (severity, url) => this.#loudspeaker.warn(severity, url),
    );
    this.#pace = new RunPace(run, (factor) =>
      live.wish({ pace: { factor } }, { lost: () => live.refuse("Not set: the connection is lost.") }),
    );
    this.#frequencies = new Frequencies((tune) => live.send({ tune }));
    this.#phrases = new Phrases(run);
    this.#workload = new Workload(run.nasa_tlx, (answer) =>
      live.wish({ answer }, { lost: () => live.refuse("Not answered: the connection is lost.") }),
    );
    this.#microphone.setInfo(null);
    byId("strips").addEventListener("focusin", ({ target }) =>
      this.#phrases.address(target.closest(".flight-strip")?.dataset.callsign),
    );
    byId("seat-take").addEventListener("click", () => this.#loudspeaker.begin());
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
    if (own === this.#own) {
      if (own) this.#frequencies.tell();
      return;
    }
    this.#own = own;
    this.#consent.setSeat(own);
    if (own) {
      this.#loudspeaker.begin();
      this.#takeActive();
    } else {
      this.#microphone.setInfo(null);
      this.#loudspeaker.end();
      this.#advisories.clear();
      this.#frequencies.show([]);
      this.#workload.clear();
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
    this.#workload.clear();
    this.#microphone.setInfo(null);
    this.#consent.end();
  }

  /** Forgets the advisories of the former seat. */
  forget() {
    this.#advisories.clear();
  }

  /** Takes in a message of the server. */
  take({ own, changes, sounds, echo, refused, consent }) {
    this.#catchUp(echo);
    if (consent) {
      this.#consent.take(consent);
      if (!this.#consent.admits("voice")) this.#microphone.deny();
    }
    const told = [
      refused ?? "",
      ...(own ?? []).filter(([kind]) => kind === "notice").map(([, , text]) => text),
    ];
    // Nobody hears what is said from now on.
    if (told.some((text) => text.startsWith(CUT))) this.#microphone.release();
    if (changes?.some(([kind]) => kind === "clock")) this.#pace.draw();
    for (const [kind, row] of this.#own ? (changes ?? []) : []) {
      if (kind === "name") this.#takeActive(); // An advisory knew the aircraft by its address alone.
      if (kind === "advisory") this.#advisories.takeAdvisory(row);
      if (kind === "spoken") this.#advisories.takeSpoken(row);
    }
    for (const [kind, ...rest] of own ?? []) {
      if (kind === "info") this.#prepare(rest[0]);
      if (kind === "question") this.#workload.ask(...rest, this.#run.now ?? 0);
      if (kind === "answered") this.#workload.answered(rest[0]);
    }
    if (changes?.some(([kind]) => kind === "call")) this.#phrases.heard();
    if (sounds && this.#own) this.#frequencies.take(sounds);
    if (sounds && this.#own && !this.#isBehind)
      this.#loudspeaker.take(sounds, {
        isOwn: (id) => id.startsWith(`microphone.${this.#own.replace(/[^A-Za-z0-9]+/g, "_")}.`),
        isDeaf: this.#microphone.isHeld,
        isSlow: Number.parseFloat(this.#run.pace) < 1,
      });
    if (echo !== undefined) this.#roundTrip = (performance.now() - echo) / 1000;
  }

  /** Takes in what has to be known of the seat; the space bar is not to give it back at once. */
  #prepare(info) {
    this.#microphone.setInfo(this.#run.isOver ? null : info);
    this.#pace.setInfo(info);
    this.#advisories.setSpoken(info.spoken_from);
    this.#takeActive(); // What is in force and nobody speaks sounds now.
    this.#frequencies.show(info.frequencies_khz);
    this.#phrases.setSeat(this.#own, info.phraseology);
    if (document.activeElement === byId("seat-take"))
      byId(info.has_sound ? "talk-button" : "words").focus();
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
