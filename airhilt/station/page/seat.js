// The seat of a person: task cards, words for the radio, and the displays of the seat.

import { Displays } from "./displays.js";
import { byId, html } from "./dom.js";
import { addressee } from "./neighbours.js";
import { Rows } from "./rows.js";
import { bearing, feet, known, percent, seconds, whole, words } from "./words.js";

const MOST_TASKS = 50; // cards at a time, the newest

export class Seat {
  #run;
  #live;
  #own = null;
  #isLeaving = false; // somebody has asked for that
  #tasks = [];
  #rows = new Rows(byId("tasks"));
  #displays;
  #clock;
  #consent;

  constructor(run, live, clock, cameras, consent) {
    this.#run = run;
    this.#consent = consent;
    this.#clock = clock;
    this.#live = live;
    byId("seat").hidden = !run.seats?.length;
    const seats = run.seats ?? [],
      named = addressee(); // A page that is for a seat offers no other.
    byId("seat-name").replaceChildren(
      ...(seats.includes(named) ? [named] : seats).map((name) =>
        html("option", { value: name }, name),
      ),
    );
    this.#displays = new Displays(
      run,
      clock,
      cameras,
      (command, answers) => live.wish({ fly: command }, answers),
      (text) => {
        byId("panel-state").textContent = text;
      },
    );
    byId("seat-take").addEventListener("click", () => {
      this.#isLeaving = Boolean(this.#own);
      live.wish(this.#own ? { leave: this.#own } : { take: byId("seat-name").value }, {
        lost: () => {
          this.#isLeaving = false;
          this.refuse("Not done: the connection is lost.");
        },
      });
    });
    byId("say").addEventListener("submit", (event) => {
      event.preventDefault();
      const text = byId("words").value.trim();
      if (!text) return;
      this.#consent.ask("words", {
        then: (isGiven) => {
          if (isGiven) this.#say(text);
          else this.refuse("Nothing was said.");
        },
        lost: () => this.refuse("Nothing was said: the connection is lost. Say it when it is there again."),
      });
    });
    this.setSeats({});
  }

  get keys() {
    return this.#displays.keys;
  }

  /** Shows on the displays only calls on the frequencies that a function returns. */
  hearOnly(heard) {
    this.#displays.hearOnly(heard);
  }

  /** Takes in which seats are free, taken or one's own. */
  setSeats(seats) {
    const before = this.#own;
    this.#own = Object.keys(seats).find((name) => seats[name] === "yours") ?? null;
    const isLost = before && !this.#own && !this.#isLeaving;
    this.#run.own = this.#own;
    byId("seat-take").textContent = this.#own ? "Leave the seat" : "Take the seat";
    byId("seat-name").disabled = Boolean(this.#own);
    if (this.#own) byId("seat-name").value = this.#own;
    if (isLost)
      this.refuse(
        seats[before] === "taken"
          ? `The connection was lost, and the seat ${before} is taken: by your old connection, which ends soon and gives it back to you, or by somebody else.`
          : `The seat ${before} was given back while the connection was lost, and its script goes on. Take it again.`,
      );
    else if (this.#own && this.#own !== before) byId("seat-state").textContent = "";
    else if (!this.#own)
      byId("seat-state").textContent = Object.keys(seats)
        .filter((name) => seats[name] === "taken")
        .map((name) => `${name} is taken.`)
        .join(" ");
    byId("seat-hint").textContent = this.#own
      ? ""
      : "Who takes a seat speaks and acts there, and sees what that seat sees. Until then its calls wait.";
    byId("say").hidden = !this.#own || this.#run.isOver;
    this.#displays.setSeat(this.#own);
    // Nobody at a seat goes back in time.
    if (this.#own && !this.#clock.following) this.#clock.follow();
    this.#drawTasks();
  }

  get own() {
    return this.#own;
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
    this.#drawTasks();
  }

  /** Takes in what only the person at the own seat sees. */
  take(changes) {
    const info = changes.findLast(([kind]) => kind === "info");
    if (info) {
      this.#run.ownCategory = info[1].category;
      this.#displays.arrange();
    }
    const own = changes.filter(([kind]) => kind === "state"); // where the own vehicle is
    if (own.length) this.#run.apply(own);
    const instruments = changes.findLast(([kind]) => kind === "cockpit");
    if (instruments) {
      this.#displays.take(instruments[1]);
      this.#showInstruments(instruments[1]);
    }
    const offers = changes.filter(([kind]) => kind === "offer").map(([, offer]) => offer);
    if (offers.length) this.#displays.takeOffers(offers);
    const isOpen = (card) =>
      !card.done &&
      !changes.some(([kind, other]) => kind === "task" && other.done && other.line === card.line) &&
      !this.#run.calls.some((call) => call.id === card.line) &&
      !this.#tasks.some((other) => other.line === card.line);
    const done = changes
      .filter(([kind, card]) => kind === "task" && card.done)
      .map(([, card]) => card.line);
    this.#tasks = this.#tasks.filter((card) => !done.includes(card.line));
    const notices = changes.filter(([kind]) => kind === "notice");
    if (notices.length) {
      this.refuse(notices.at(-1)[2]);
      byId("panel-state").textContent = "";
    }
    this.#tasks.push(
      ...changes
        .filter(([kind]) => kind === "task")
        .map(([, card]) => card)
        .filter(isOpen),
    );
    this.#tasks.splice(0, this.#tasks.length - MOST_TASKS);
    this.#drawTasks();
  }

  /** Takes cards away once somebody has made their calls. */
  heard(calls) {
    const made = new Set(calls.map((call) => call.id));
    this.#tasks = this.#tasks.filter((card) => !made.has(card.line));
    this.#drawTasks();
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
    byId("instruments").textContent = parts.filter((part) => part).join(", ");
    byId("instruments").hidden = false;
  }

  #drawTasks() {
    this.#rows.show(
      this.#tasks.filter((card) => card.seat === this.#own),
      (card) => card.line,
      (card) => this.#row(card),
    );
    if (!this.#own) byId("instruments").hidden = true;
  }

  #row(card) {
    const button = html("button", { type: "button" }, card.text);
    button.addEventListener("click", () => {
      byId("words").value = card.text;
      byId("words").focus();
    });
    return html(
      "li",
      {},
      html(
        "span",
        { class: "dim" },
        `Due since ${seconds(card.t)}${card.addressed ? `, to ${card.addressed}` : ""}: `,
      ),
      button,
    );
  }

  /** Says what was typed, unless that has been said or changed since. */
  #say(text) {
    const typed = byId("words").value.trim();
    if (typed !== text) {
      if (typed) this.refuse("What you typed has changed before you could say it. Say it again.");
      return;
    }
    byId("words").value = "";
    this.refuse("");
    this.#live.wish({ say: { text } }, { lost: (wasSent) => this.#takeBack(text, wasSent) });
  }

  /** Gives words back that the station may not have heard, before what was typed meanwhile. */
  #takeBack(text, wasSent) {
    const field = byId("words");
    field.value = [text, field.value].filter((part) => part).join(" ");
    this.refuse(
      wasSent
        ? "The connection was lost before the station had heard your last words. They are in the field: if nobody answers, say them again."
        : "Nothing was said: the connection is lost. Say it when it is there again.",
    );
  }
}
