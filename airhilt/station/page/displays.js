// The displays of a seat: a cockpit for the pilot of an aircraft, a scope with strips for a
// controller.

import { Pane } from "./pane.js";
import { byId } from "./dom.js";
import { ModePanel } from "./mode_panel.js";
import { NavigationDisplay } from "./navigation_display.js";
import { PrimaryFlightDisplay } from "./primary_flight_display.js";
import { Strips } from "./strips.js";
import { spoken, tcasOf } from "./tcas.js";

const PERIOD_MS = 200; // of the messages: five a second
const TURNING = ["heading_deg", "track_deg"];

/** The instruments of the own aircraft between two messages: what is drawn moves evenly. */
class Instruments {
  #before = null;
  #newest = null;
  #arrived = 0;

  /** Forgets the aircraft of another seat. */
  clear() {
    this.#before = this.#newest = null;
  }

  /** Takes in a message. */
  take(shown) {
    this.#before = this.now() ?? shown;
    this.#newest = shown;
    this.#arrived = performance.now();
  }

  /** What the instruments show at this moment, null before the first message. */
  now() {
    if (!this.#newest) return null;
    const part = Math.min((performance.now() - this.#arrived) / PERIOD_MS, 1),
      shown = { ...this.#newest };
    for (const [name, to] of Object.entries(this.#newest)) {
      const from = this.#before[name];
      if (typeof to !== "number" || typeof from !== "number") continue;
      const change = TURNING.includes(name) ? ((to - from + 540) % 360) - 180 : to - from;
      shown[name] = from + change * part;
    }
    for (const name of TURNING) shown[name] = (shown[name] + 360) % 360;
    return shown;
  }
}

/** Kinds of seats, by the categories of those who are at them. */
const KINDS = { aircraft: "pilot", vehicle: "driver", unit: "controller" };

export class Displays extends Pane {
  #seat = null;
  #arranged = null; // the airport for which the displays are arranged
  #instruments = new Instruments();
  #pfd = new PrimaryFlightDisplay();
  #nd;
  #strips;
  panel;
  #cameras;

  constructor(run, clock, cameras, live) {
    super(run, clock);
    this.#cameras = cameras;
    this.#nd = new NavigationDisplay(run, clock);
    this.#strips = new Strips(run, clock);
    this.panel = new ModePanel(live);
    requestAnimationFrame(() => this.#draw());
  }

  /** Keys of the displays, each for the seats that have what it works. */
  get keys() {
    const panel = this.panel,
      nd = this.#nd;
    return [
      ["s", "cockpit: speed", () => panel.focus("speed")],
      ["h", "cockpit: track", () => panel.focus("track")],
      ["a", "cockpit: altitude", () => panel.focus("altitude")],
      ["v", "cockpit: vertical speed", () => panel.focus("rate")],
      ["g", "cockpit: go around", () => panel.press("go_around")],
      ["r", "cockpit: longer range", () => nd.step(1)],
      ["e", "cockpit: shorter range", () => nd.step(-1)],
      ["b", "brake, hold position, reject take-off", () => panel.brake(), ["pilot", "driver"]],
    ].map(([name, text, act, seats = ["pilot"]]) => ({
      names: [name],
      text,
      act,
      isUsed: () => seats.includes(document.body.dataset.seat),
    }));
  }

  /** Takes in which seat the person has, null for none. */
  setSeat(seat) {
    if (seat !== this.#seat) {
      this.#instruments.clear();
      this.#nd.reset();
    }
    this.#seat = seat;
    this.arrange();
  }

  /** Shows the displays of a seat of its category, once that is known. */
  arrange() {
    const category = this.run.ownCategory;
    this.#arranged = this.run.airport;
    if (category) document.body.dataset.seat = KINDS[category];
    else delete document.body.dataset.seat;
    this.#cameras.offer(!category ? undefined : category === "unit" ? null : this.#seat);
    this.panel.offer(category, this.run.airport);
  }

  /** Forgets the former seat: strips with their notes, instruments, and what was not set yet. */
  forget() {
    this.#strips.clear();
    this.#instruments.clear();
    this.panel.clear();
    this.#drawCockpit(null);
  }

  /** Takes in what the instruments show. */
  take(shown) {
    this.#instruments.take(shown);
    this.panel.take(shown);
  }

  #drawCockpit(shown) {
    const told = tcasOf(this.run, this.clock.t),
      label = ["Primary flight display", spoken(told)].filter(Boolean).join(", ");
    this.#pfd.draw(shown, told);
    this.#nd.draw(this.#seat, shown, told);
    if (byId("pfd").ariaLabel !== label) byId("pfd").ariaLabel = label;
  }

  #draw() {
    if (this.#arranged !== this.run.airport) this.arrange(); // It comes with the briefing.
    const shown = this.#instruments.now(),
      { seat } = document.body.dataset;
    if (seat === "pilot") this.#drawCockpit(shown);
    if (seat === "controller") this.#strips.draw();
    requestAnimationFrame(() => this.#draw());
  }
}
