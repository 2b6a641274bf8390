// The commands that calls have for the person at a seat: a button each, which gives the command.

import { byId, html } from "./dom.js";
import { Rows } from "./rows.js";
import { capital, instruction, known } from "./words.js";

/** Returns a command in words; a track as the instruments show it, magnetic where that is known. */
function inWords(command, { isVehicle, variation }) {
  const points = command.action === "land" ? { via: command.via.length } : {};
  if (command.action === "route") points.route = command.route.length;
  if (command.action === "track" && known(variation))
    points.track_deg = (command.track_deg - variation + 360) % 360;
  return capital(instruction({ ...command, ...points }, isVehicle));
}

export class Offers {
  #give;
  #open = []; // the oldest first
  #rows = new Rows(byId("offers"));

  /** `give(text, command)` gives a command to the own aircraft or vehicle. */
  constructor(give) {
    this.#give = give;
  }

  /** Takes in the offers that are open. */
  take(offers) {
    this.#open = offers;
  }

  /** Shows them in the words of an aircraft or a vehicle, with the variation of the place. */
  draw(seat) {
    this.#rows.show(
      this.#open.map((offer) => ({ ...offer, text: inWords(offer.command, seat) })),
      (offer) => offer.number,
      ({ text, command }) => this.#row(text, command),
    );
  }

  clear() {
    this.#open = [];
  }

  #row(text, command) {
    const button = html("button", { type: "button" }, text);
    button.addEventListener("click", () => this.#give(text, command));
    return html("li", {}, html("span", { class: "dim" }, "When it is time: "), button);
  }
}
