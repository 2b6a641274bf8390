// The mode panel: what autopilot and guidance are to do. A field sets its value with Enter.

import { button, byId, html } from "./dom.js";
import { Offers } from "./offers.js";
import { feet, known } from "./words.js";

const LEAST_CHANGE_FT = 100; // of altitude, for which a vertical speed can be set
// What a field sets: its name, its unit, the least and the greatest value, and its command.
const FIELDS = {
  speed: ["Speed", "kt", 1, 1000, (value) => ({ action: "speed", cas_kt: value })],
  track: [
    "Track",
    "\u00b0 true",
    0,
    360,
    (value, { variation }) => ({
      action: "track",
      track_deg: (value + (variation ?? 0) + 360) % 360,
    }),
  ],
  altitude: ["Altitude", "ft", 0, 60_000, (value) => ({ action: "altitude", altitude_ft: value })],
  rate: [
    "Vertical speed",
    "ft/min",
    100,
    20_000,
    (value, { selected }) => ({
      action: "altitude",
      altitude_ft: selected,
      vertical_rate_fpm: value,
    }),
  ],
};
const SHORT = { rate: "V/S" };
const OF_RUNWAYS = [
  ["Line up", "line_up"],
  ["Take off", "take_off"],
  ["Approach", "land"],
];
const URGENT = [
  ["Go around", "go_around"],
  ["Reject take-off", "cancel_takeoff"],
]; // one of them is shown
const AT_ONCE = [
  ["Hold position", "hold_position"],
  ["Continue", "continue"],
  ["Own route", "resume_route"],
];
const NAMES_IN_VEHICLE = { hold_position: "Brake, hold position", continue: "Drive on" };
const OF_VEHICLES = ["hold_position", "continue"];

export class ModePanel {
  #send;
  #tell;
  #isVehicle = false;
  #offers = new Offers((text, command) => this.#give(text, command));
  // Magnetic variation in degrees, positive east; altitude and selected altitude in ft. Null: it
  // is not known.
  #shown = { variation: null, altitude: null, selected: null };

  /**
   * `send(command, { heard, lost })` gives a command to the own aircraft, and calls one of the two
   * once it is known whether the station has heard it; `tell(text)` says what came of it.
   */
  constructor(send, tell) {
    this.#send = send;
    this.#tell = tell;
    byId("panel-values").replaceChildren(...Object.keys(FIELDS).map((id) => this.#field(id)));
    const runway = html("select", { id: "panel-runway", "aria-label": "Runway" });
    byId("panel-runways").replaceChildren(
      runway,
      ...OF_RUNWAYS.map(([name, action]) => button(name, () => this.#atRunway(name, action))),
    );
    const actions = [...URGENT, ...AT_ONCE].map(([name, action]) => this.#atOnce(name, action));
    byId("panel-actions").replaceChildren(...actions);
  }

  /** Offers what an aircraft or a vehicle can do, and the runways of the airport. */
  offer(category, airport) {
    const idents = (airport?.runways ?? []).flatMap((runway) =>
        runway.ends.map((end) => end.ident),
      ),
      isVehicle = category === "vehicle";
    byId("panel-title").textContent = isVehicle ? "Vehicle" : "Mode panel";
    byId("panel-values").hidden = isVehicle;
    byId("panel-runways").hidden = isVehicle || !idents.length;
    this.#isVehicle = isVehicle;
    for (const [name, action] of AT_ONCE) {
      this.#action(action).hidden = isVehicle && !OF_VEHICLES.includes(action);
      this.#action(action).textContent = (isVehicle && NAMES_IN_VEHICLE[action]) || name;
    }
    this.#shown.variation = airport?.variation_deg ?? null;
    const north = `\u00b0 ${known(this.#shown.variation) ? "mag" : "true"}`;
    byId("panel-track-unit").textContent = north;
    byId("panel-track").ariaLabel = `Track in ${north}`;
    this.#offerActions("");
    this.#drawOffers();
    const select = byId("panel-runway"),
      chosen = select.value;
    if (select.options.length !== idents.length)
      select.replaceChildren(
        ...idents.map((ident) =>
          html("option", { value: ident, selected: ident === chosen }, ident),
        ),
      );
  }

  /** Takes in what the instruments show. */
  take({ mode, altitude_ft: altitude, selected_altitude_ft: selected }) {
    Object.assign(this.#shown, { altitude, selected });
    this.#offerActions(mode);
  }

  /** Takes in which commands calls have for the person, and have no more. */
  takeOffers(offers) {
    this.#offers.take(offers);
    this.#drawOffers();
  }

  #drawOffers() {
    this.#offers.draw({ isVehicle: this.#isVehicle, variation: this.#shown.variation });
  }

  /** A take-off is rejected where there is no approach to break off. */
  #offerActions(mode) {
    const isRolling = mode === "takeoff_roll";
    this.#action("go_around").hidden = this.#isVehicle || isRolling;
    this.#action("cancel_takeoff").hidden = this.#isVehicle || !isRolling;
  }

  /** Forgets what was shown and typed. */
  clear() {
    Object.assign(this.#shown, { altitude: null, selected: null });
    for (const id of Object.keys(FIELDS)) byId(`panel-${id}`).value = "";
    this.#offers.clear();
    this.#drawOffers();
  }

  /** Puts the cursor into the field of speed, track or altitude. */
  focus(id) {
    byId(`panel-${id}`).select();
  }

  /** Rejects a take-off, or stops elsewhere on the ground. */
  brake() {
    this.#press(this.#action("cancel_takeoff").hidden ? "hold_position" : "cancel_takeoff");
  }

  goAround() {
    this.#press("go_around");
  }

  #action(name) {
    return byId(`panel-${name.replaceAll("_", "-")}`);
  }

  /** Presses a button, if it is shown. */
  #press(name) {
    if (!this.#action(name).hidden) this.#action(name).click();
  }

  #give(text, command) {
    this.#tell("");
    this.#send(command, {
      heard: () => this.#tell(`Set: ${text}.`),
      lost: (wasSent) =>
        this.#tell(
          `Not set: the connection is lost.${wasSent ? ` The station may have heard it: ${text}.` : ""}`,
        ),
    });
  }

  #atOnce(name, action) {
    const made = button(name, () => this.#give(made.textContent, { action }));
    made.id = `panel-${action.replaceAll("_", "-")}`;
    return made;
  }

  #atRunway(name, action) {
    const runway = byId("panel-runway").value;
    this.#give(`${name}, runway ${runway}`, { action, runway });
  }

  #field(id) {
    const [name, unit] = FIELDS[id];
    const input = html("input", {
      type: "text",
      inputmode: "decimal",
      autocomplete: "off",
      id: `panel-${id}`,
      size: 5,
      "aria-label": `${name} in ${unit}`,
    });
    const form = html(
      "form",
      {},
      html(
        "span",
        { class: "dial-name" },
        `${SHORT[id] ?? name} `,
        html("span", { class: "dim", id: `panel-${id}-unit` }, unit),
      ),
      html("span", { class: "dial" }, input),
      html("button", { "aria-label": `Set ${name.toLowerCase()}` }, "Set"),
    );
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.#set(id, input);
    });
    return form;
  }

  /** Gives the command of a field, or says why it cannot be given. */
  #set(id, input) {
    const [name, , least, most, command] = FIELDS[id],
      unit = byId(`panel-${id}-unit`).textContent,
      value = Number(input.value),
      { altitude, selected } = this.#shown;
    if (input.value.trim() === "" || !(value >= least && value <= most)) {
      this.#tell(`${name}: expected ${least} to ${most} ${unit}.`);
      return;
    }
    let target = "";
    if (id === "rate") {
      if (selected === null || Math.abs(selected - altitude) < LEAST_CHANGE_FT) {
        this.#tell(`${name}: set another altitude first.`);
        return;
      }
      target = `, ${selected > altitude ? "up" : "down"} to ${feet(selected)}`;
    }
    this.#give(`${name.toLowerCase()} ${value} ${unit}${target}`, command(value, this.#shown));
    input.value = "";
    input.blur();
  }
}
