// Phrases for the situation, that can be chosen instead of typed.

import { button, byId, offer, on } from "./dom.js";
import { identsOf } from "./model.js";
import { Rows } from "./rows.js";
import { ask } from "./server.js";
import { METRE_PER_FT, METRE_PER_NM } from "./words.js";

const PERIOD_MS = 3000;

export class Phrases {
  #run;
  #own = null;
  #style = "faa";
  #told = "";
  #asked = 0;
  #rows = new Rows(byId("phrase-list"));

  constructor(run) {
    this.#run = run;
    for (const id of ["phrase-to", "phrase-runway"]) on(id, "change", () => this.renew());
    setInterval(() => this.renew(), PERIOD_MS);
  }

  /** Takes in the own seat, null for none, and the phraseology of the run. */
  setSeat(own, style = this.#style) {
    const isOther = own !== this.#own;
    this.#own = own;
    this.#style = style;
    byId("phrases").hidden = !own;
    if (isOther) {
      this.#show([]);
      this.#asked += 1; // What comes yet is for the former seat.
    }
    this.#told = "";
    this.renew();
  }

  /** Offers what can be said to an actor. */
  address(callsign) {
    if (![...byId("phrase-to").options].some(({ value }) => value === callsign)) return;
    byId("phrase-to").value = callsign;
    this.renew();
  }

  get #isUnit() {
    return this.#run.ownCategory === "unit";
  }

  #situation() {
    const { categories, ownCategory, airport, now } = this.#run,
      callsign = this.#isUnit ? byId("phrase-to").value : this.#own;
    const track = this.#run.track(callsign),
      state = track?.state(now ?? 0, this.#run.span),
      category = this.#isUnit
        ? (categories[callsign] ?? track?.category ?? "aircraft")
        : ownCategory;
    return {
      speaker: ownCategory,
      callsign: callsign || null,
      style: this.#style,
      category,
      on_ground: Boolean(state?.onGround),
      runway: airport ? byId("phrase-runway").value || null : null,
      altitude_ft: state && category === "aircraft" ? Math.round(state.altitude / 100) * 100 : null,
      ...(state && airport ? this.#fromAirport(state, airport) : {}),
      heading_deg: state ? magnetic(state.heading, airport?.variation_deg ?? 0) : null,
      heard: this.#isUnit ? "" : (this.#lastCall()?.slice(0, 600) ?? ""),
    };
  }

  /** Where an actor is seen from the airport: its reference point is the centre of the plan. */
  #fromAirport({ altitude, east, north }, { elevation_m }) {
    return {
      height_ft: Math.round((altitude - elevation_m / METRE_PER_FT) / 100) * 100,
      distance_nm: Math.round(Math.hypot(east, north) / METRE_PER_NM),
    };
  }

  /** Words of the last call to the own crew, as they were recognised. */
  #lastCall() {
    const call = this.#run.calls.findLast((one) =>
      one.transcripts.some((heard) => heard.addressee === this.#own),
    );
    return call?.transcripts.at(-1)?.text;
  }

  /** Offers what can be said now, such as a readback when a call has come. */
  async renew() {
    if (!this.#run.ownCategory || !this.#run.categories) return;
    const idents = identsOf(this.#run.airport),
      spoken = Object.keys(this.#run.categories).filter((name) => name !== this.#own);
    offer(byId("phrase-to"), spoken);
    offer(byId("phrase-runway"), idents);
    byId("phrase-to-label").hidden = !this.#isUnit;
    byId("phrase-runway-label").hidden = !idents.length || this.#run.ownCategory === "aircraft";
    const situation = this.#situation(),
      told = JSON.stringify(situation);
    if (told === this.#told) return;
    this.#told = told;
    const asked = ++this.#asked;
    try {
      const phrases = await ask("api/phrases", situation);
      if (asked === this.#asked) this.#show(phrases);
    } catch {
      this.#told = "";
    } // The server does not answer; the page tells that.
  }

  #show(phrases) {
    this.#rows.show(
      phrases,
      ({ label, text }) => `${label}: ${text}`,
      ({ label, text }) => button(label, () => choose(text), { title: text }),
    );
  }
}

/** Puts a phrase into the field for a call. */
function choose(text) {
  byId("words").value = text;
  byId("say-button").focus();
}

/** Returns the magnetic heading of a true one in radians, in steps of 10 degrees. */
function magnetic(true_rad, variation) {
  const heading = (true_rad * 180) / Math.PI - variation;
  return (((Math.round(heading / 10) % 36) + 36) % 36) * 10;
}
