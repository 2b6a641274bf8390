// The actors as a table: the words for what the plan draws.

import { Pane } from "./pane.js";
import { byId, html, svg } from "./dom.js";
import { bearing, feet, whole, words } from "./words.js";

export class Traffic extends Pane {
  #body = byId("traffic").tBodies[0];
  #rows = [];
  #told = 0;

  constructor(run, clock) {
    super(run, clock);
    this.redraw();
  }

  /** Makes the rows again, because there are new actors. */
  redraw() {
    this.#rows = this.run.tracks.map((track) => {
      const cells = Array.from({ length: 4 }, (_, i) => html("td", { class: i ? "number" : null }));
      const swatch = svg(
        "svg",
        { class: "swatch", viewBox: "0 0 10 10", "aria-hidden": "true" },
        svg("rect", { width: 10, height: 10, fill: `var(${track.colour})` }),
      );
      const head = html("th", { scope: "row" }, swatch, track.callsign);
      return { track, cells, head, row: html("tr", head, ...cells) };
    });
    this.#body.replaceChildren(...this.#rows.map(({ row }) => row));
    this.#told = -1;
    this.draw();
  }

  draw() {
    const now = performance.now(),
      { t, playing } = this.clock;
    if (playing && now - this.#told < 200) return;
    this.#told = now;
    for (const { track, cells, head, row } of this.#rows) {
      const state = track.state(t, this.run.span),
        gone = state.ended ? "ended" : state.isThere ? "" : "not there yet",
        numbers = gone ? ["", "", ""] : numbersOf(state);
      row.className = gone ? "gone" : "";
      head.className = (!gone && this.run.severityOf(track.callsign, t)) || "";
      const what = [words(track.type), gone || state.phase].filter(Boolean).join(", ");
      [what, ...numbers].forEach((text, i) => (cells[i].textContent = text));
    }
  }
}

/** Returns altitude, speed and heading. */
const numbersOf = ({ onGround, altitude, knots, heading }) => [
  onGround ? "ground" : feet(altitude),
  `${whole(knots)} kt`,
  bearing(((heading * 180) / Math.PI + 360) % 360),
];
