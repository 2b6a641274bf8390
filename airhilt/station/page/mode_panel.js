// The mode panel: what autopilot and guidance are to do. A field sets its value with Enter. Each
// command that calls have for the person has a button, which gives it.

import { button, byId, html } from "./dom.js";
import { identsOf } from "./model.js";
import { Rows } from "./rows.js";
import { capital, feet, instruction, known } from "./words.js";

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

/** Returns a command in words; a track as the instruments show it, magnetic where that is known. */
function inWords(command, isVehicle, variation) {
  const points = command.action === "land" ? { via: command.via.length } : {};
  if (command.action === "route") points.route = command.route.length;
  if (command.action === "track" && known(variation))
    points.track_deg = (command.track_deg - variation + 360) % 360;
  return capital(instruction({ ...command, ...points }, isVehicle));
}

/** Says what came of a command. */
function tell(text) {
  byId("panel-state").textContent = text;
}

export class ModePanel {
  #live;
  #isVehicle = false;
  #offers = []; // that are open, the oldest first
  #rows = new Rows(byId("offers"));
  // Magnetic variation in degrees, positive east; altitude and selected altitude in ft. Null: it
  // is not known.
  #shown = { variation: null, altitude: null, selected: null };

  constructor(live) {
    this.#live = live;
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
    const idents = identsOf(airport),
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
    this.#offers = offers;
    this.#drawOffers();
  }

  #drawOffers() {
    this.#rows.show(
      this.#offers.map((offer) => ({
        ...offer,
        text: inWords(offer.command, this.#isVehicle, this.#shown.variation),
      })),
      (offer) => offer.number,
      ({ text, command }) =>
        html(
          "li",
          html("span.dim", "When it is time: "),
          button(text, () => this.#give(text, command)),
        ),
    );
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
    this.takeOffers([]);
  }

  /** Puts the cursor into the field of speed, track or altitude. */
  focus(id) {
    byId(`panel-${id}`).select();
  }

  /** Rejects a take-off, or stops elsewhere on the ground. */
  brake() {
    this.press(this.#action("cancel_takeoff").hidden ? "hold_position" : "cancel_takeoff");
  }

  #action(name) {
    return byId(`panel-${name.replaceAll("_", "-")}`);
  }

  /** Presses a button, if it is shown. */
  press(name) {
    if (!this.#action(name).hidden) this.#action(name).click();
  }

  #give(text, command) {
    tell("");
    this.#live.act({ do: "fly", command }).then(
      (why) => (why ? this.#live.refuse(why) : tell(`Set: ${text}.`)),
      ({ wasSent }) =>
        tell(
          `Not set: the connection is lost.${wasSent ? ` The station may have heard it: ${text}.` : ""}`,
        ),
    );
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
      html(
        "span.dial-name",
        `${SHORT[id] ?? name} `,
        html("span", { class: "dim", id: `panel-${id}-unit` }, unit),
      ),
      html("span.dial", input),
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
      tell(`${name}: expected ${least} to ${most} ${unit}.`);
      return;
    }
    let target = "";
    if (id === "rate") {
      if (selected === null || Math.abs(selected - altitude) < LEAST_CHANGE_FT) {
        tell(`${name}: set another altitude first.`);
        return;
      }
      target = `, ${selected > altitude ? "up" : "down"} to ${feet(selected)}`;
    }
    this.#give(`${name.toLowerCase()} ${value} ${unit}${target}`, command(value, this.#shown));
    input.value = "";
    input.blur();
  }
}
