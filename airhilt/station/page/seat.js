// The seat of a person: task cards, words for the radio, and the displays of the seat.

import { Pane } from "./pane.js";
import { Displays } from "./displays.js";
import { button, byId, html, offer, on, onSubmit } from "./dom.js";
import { addressee } from "./neighbours.js";
import { Rows } from "./rows.js";
import { bearing, feet, known, percent, seconds, whole, words } from "./words.js";

/** Uses to which a person agrees, by what is chosen in the form of the seat. */
const USES = { voice: ["voice", "words"], words: ["words"], none: [] };
const BEFORE = "Take this seat to speak and act, and to see what it sees. Its calls wait for you. ",
  LOGGED = "What you do at the seat, and what it shows you, is logged. ",
  TYPED = "What you type is said to everybody, and kept as text.";

/** Returns what becomes of what a person says and types. */
const consequence = (isRecorded) =>
  `What you say is recognised, everybody in the run hears it, and its programs get it. ${
    isRecorded
      ? "It is recorded as sound and as text."
      : "Its sound is not recorded, its words are as they were recognised."
  } ${TYPED}`;

export class Seat extends Pane {
  #live;
  #tasks = [];
  #notice = null; // the last one, as it was shown
  #seats = {};
  #rows = new Rows(byId("tasks"));
  #displays;

  constructor(run, live, clock, cameras) {
    super(run, clock);
    this.#live = live;
    byId("seat").hidden = !run.seats?.length;
    const seats = run.seats ?? [],
      named = addressee(); // A page that is for a seat offers no other.
    offer(byId("seat-name"), seats.includes(named) ? [named] : seats);
    on("seat-name", "change", () => this.#hint());
    this.#displays = new Displays(run, clock, cameras, live);
    onSubmit(byId("seat-form"), () => {
      if (!live.isThere) this.refuse("Not done: the connection is lost.");
      else if (this.run.own) live.leave();
      else live.sit(byId("seat-name").value, USES[byId("seat-uses").value]);
    });
    on("seat-uses", "change", (event) => {
      if (this.run.own) live.agree(USES[event.target.value]);
    });
    onSubmit(byId("say"), () => {
      const text = byId("words").value.trim();
      if (text) this.#say(text);
    });
    this.setSeats({});
    this.setPhase();
  }

  /** Offers the seats once the run can answer for them. */
  setPhase() {
    byId("seat-take").disabled = this.run.live && (this.run.phase ?? "waiting") === "waiting";
  }

  get keys() {
    return this.#displays.keys;
  }

  /** Takes in which seats are free, taken or one's own. */
  setSeats(seats) {
    const before = this.run.own;
    this.#seats = seats;
    const own = Object.keys(seats).find((name) => seats[name].is === "yours") ?? null;
    if (own !== before) Object.assign(this.run, { own, ownCategory: null });
    this.run.advised += 1;
    byId("seat-take").textContent = own ? "Leave the seat" : "Take the seat";
    byId("seat-name").disabled = Boolean(own);
    if (own) byId("seat-name").value = own;
    else if (before) byId("seat-uses").value = ""; // Who has it next chooses anew.
    if (own !== before) this.refuse("");
    this.#hint();
    byId("say").hidden = !own || this.run.isOver;
    this.#displays.setSeat(own);
    // Nobody at a seat goes back in time.
    if (own && !this.clock.following) this.clock.follow();
    this.drawTasks();
  }

  /** Shows before a seat is taken what it is for, and what becomes of what is said there. */
  #hint() {
    const name = byId("seat-name").value,
      taken = Object.keys(this.#seats).filter((one) => this.#seats[one].is === "taken");
    byId("seat-hint").textContent = this.run.own
      ? ""
      : [
          ...taken.map((one) => `${one} is taken. `),
          BEFORE,
          LOGGED,
          consequence(this.#seats[name]?.recorded ?? true),
        ].join("");
  }

  /** Shows why something was not done. */
  refuse(text) {
    byId("seat-state").textContent = text;
  }

  /** Takes in that the run is over: nobody hears what is typed. */
  end() {
    byId("say").hidden = true;
  }

  /** Forgets what the former seat has shown, and what was typed there and not sent. */
  forget() {
    this.#tasks = [];
    this.#displays.forget();
    byId("words").value = "";
    for (const id of ["instruments", "panel-state"]) byId(id).textContent = "";
    this.drawTasks();
  }

  /** Takes in what only the person at the own seat sees. */
  take(changes) {
    const newest = Object.fromEntries(changes.map(([kind, ...what]) => [kind, what]));
    if (newest.seat) this.#takeState(newest.seat[0]);
    if (newest.state) this.run.apply([["state", ...newest.state]]); // where the own vehicle is
    if (newest.cockpit) {
      this.#displays.take(newest.cockpit[0]);
      this.#showInstruments(newest.cockpit[0]);
    }
  }

  #takeState({ category, uses, tasks, offers, notice }) {
    if (this.run.ownCategory !== category) {
      this.run.ownCategory = category;
      this.#displays.arrange();
    }
    byId("seat-uses").value = uses.includes("voice") ? "voice" : uses.length ? "words" : "none";
    byId("words").disabled = byId("say-button").disabled = !uses.length;
    byId("words").placeholder = uses.length
      ? "Type a call, or choose a phrase"
      : "To type, choose above that it may be used";
    this.#displays.panel.takeOffers(offers);
    this.#tasks = tasks;
    if (notice && JSON.stringify(notice) !== this.#notice) {
      this.refuse(notice.text);
      byId("panel-state").textContent = "";
    }
    this.#notice = JSON.stringify(notice);
    this.drawTasks();
  }

  #showInstruments(shown) {
    const parts = [
      `${whole(shown.airspeed_kt)} kt`,
      feet(shown.altitude_ft),
      `${whole(shown.vertical_speed_fpm)} ft/min`,
      `heading ${bearing(shown.heading_deg)} ${shown.north}`,
      known(shown.radio_height_ft) ? `radio height ${feet(shown.radio_height_ft)}` : null,
      shown.gear === 1 ? "gear down" : shown.gear === 0 ? "gear up" : "gear moving",
      `flaps ${percent(shown.flaps)}`,
      words(shown.mode),
      `selected ${feet(shown.selected_altitude_ft)}, ${whole(shown.selected_airspeed_kt)} kt`,
    ];
    byId("instruments").textContent = parts.filter(Boolean).join(", ");
    byId("instruments").hidden = false;
  }

  /** Shows the cards of calls that nobody has made yet. */
  drawTasks() {
    this.#rows.show(
      this.run.own
        ? this.#tasks.filter(({ line }) => !this.run.calls.some((call) => call.id === line))
        : [],
      (card) => card.line,
      (card) => this.#row(card),
    );
    if (!this.run.own) byId("instruments").hidden = true;
  }

  #row(card) {
    const choose = () => {
      byId("words").value = card.text;
      byId("words").focus();
    };
    return html(
      "li",
      html(
        "span.dim",
        `Due since ${seconds(card.t)}${card.addressed ? `, to ${card.addressed}` : ""}: `,
      ),
      button(card.text, choose),
    );
  }

  /** Says what was typed; what is refused, or may not have been heard, is given back. */
  #say(text) {
    byId("words").value = "";
    this.refuse("");
    this.#live.act({ do: "text", text }).then(
      (why) => why && this.#giveBack(text, why),
      ({ wasSent }) =>
        this.#giveBack(
          text,
          wasSent
            ? "The connection was lost before the run had heard your last words. They are in the field: if nobody answers, say them again."
            : "Nothing was said: the connection is lost. Say it when it is there again.",
        ),
    );
  }

  /** Gives words back, before what was typed meanwhile. */
  #giveBack(text, why) {
    const field = byId("words");
    field.value = [text, field.value].filter(Boolean).join(" ");
    this.refuse(why);
  }
}
