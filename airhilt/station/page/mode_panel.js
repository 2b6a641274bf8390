// The mode panel: what autopilot and guidance are to do. A field sets its value with Enter. Each
// command that calls have for the person has a button, which gives it.

import { button, byId, html, offer, onSubmit } from "./dom.js";
import { identsOf } from "./model.js";
import { Rows } from "./rows.js";
import { capital, feet, instruction, known } from "./words.js";

const LEAST_CHANGE_FT = 100; // of altitude, for which a vertical speed can be set
// Command that each field sets.
const COMMANDS = {
  speed: (value) => ({ action: "speed", cas_kt: value }),
  track: (value, { variation }) => ({
    action: "track",
    track_deg: (value + (variation ?? 0) + 360) % 360,
  }),
  altitude: (value) => ({ action: "altitude", altitude_ft: value }),
  rate: (value, { selected }) => ({
    action: "altitude",
    altitude_ft: selected,
    vertical_rate_fpm: value,
  }),
};
// Names of what is done at once, in an aircraft and in a vehicle, where it can be done there.
const AT_ONCE = {
  hold_position: ["Hold position", "Brake, hold position"],
  continue: ["Continue", "Drive on"],
  resume_route: ["Own route"],
};

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
    for (const form of byId("panel-values").children)
      onSubmit(form, () => this.#set(form.dataset.field, form.querySelector("input")));
    for (const made of byId("panel-runways").querySelectorAll("button"))
      made.addEventListener("click", () => this.#atRunway(made));
    for (const made of byId("panel-actions").children)
      made.addEventListener("click", () =>
        this.#give(made.textContent, { action: made.dataset.action }),
      );
  }

  /** Offers what an aircraft or a vehicle can do, and the runways of the airport. */
  offer(category, airport) {
    const idents = identsOf(airport),
      isVehicle = category === "vehicle";
    byId("panel-title").textContent = isVehicle ? "Vehicle" : "Mode panel";
    byId("panel-values").hidden = isVehicle;
    byId("panel-runways").hidden = isVehicle || !idents.length;
    this.#isVehicle = isVehicle;
    for (const [action, names] of Object.entries(AT_ONCE)) {
      this.#action(action).hidden = !names[Number(isVehicle)];
      this.#action(action).textContent = names[Number(isVehicle)];
    }
    this.#shown.variation = airport?.variation_deg ?? null;
    const north = `\u00b0 ${known(this.#shown.variation) ? "mag" : "true"}`;
    byId("panel-track-unit").textContent = north;
    byId("panel-track").ariaLabel = `Track in ${north}`;
    this.#offerActions("");
    this.#drawOffers();
    offer(byId("panel-runway"), idents);
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
    for (const id of Object.keys(COMMANDS)) byId(`panel-${id}`).value = "";
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

  #atRunway({ textContent: name, dataset: { action } }) {
    const runway = byId("panel-runway").value;
    this.#give(`${name}, runway ${runway}`, { action, runway });
  }

  /** Gives the command of a field, or says why it cannot be given. */
  #set(id, input) {
    const { name, min, max } = input,
      unit = byId(`panel-${id}-unit`).textContent,
      value = Number(input.value),
      { altitude, selected } = this.#shown;
    if (input.value.trim() === "" || !(value >= Number(min) && value <= Number(max))) {
      tell(`${name}: expected ${min} to ${max} ${unit}.`);
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
    this.#give(`${name.toLowerCase()} ${value} ${unit}${target}`, COMMANDS[id](value, this.#shown));
    input.value = "";
    input.blur();
  }
}
