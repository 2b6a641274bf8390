// The actors as a table: the words for what the plan draws.

import { byId, html, svg } from "./dom.js";
import { METRE_PER_NM } from "./model.js";
import { bearing, feet, whole, words } from "./words.js";

export class Traffic {
  #body = byId("traffic").tBodies[0];
  #run;
  #clock;
  #rows = [];
  #told = 0;

  constructor(run, clock) {
    this.#run = run;
    this.#clock = clock;
    this.redraw();
  }

  /** Makes the rows again, because there are new actors. */
  redraw() {
    this.#rows = this.#run.tracks.map((track) => {
      const cells = Array.from({ length: 4 }, (_, i) => html("td", { class: i ? "number" : null }));
      const swatch = svg(
        "svg",
        { class: "swatch", viewBox: "0 0 10 10", "aria-hidden": "true" },
        svg("rect", { width: 10, height: 10, fill: `var(${track.colour})` }),
      );
      return {
        track,
        cells,
        row: html("tr", {}, html("th", { scope: "row" }, swatch, track.callsign), ...cells),
      };
    });
    this.#body.replaceChildren(...this.#rows.map(({ row }) => row));
    this.#told = -1;
    this.draw();
  }

  draw() {
    const now = performance.now();
    if (this.#clock.playing && now - this.#told < 200) return;
    this.#told = now;
    for (const { track, cells, row } of this.#rows) {
      const state = track.state(this.#clock.t, this.#run.span),
        gone = state.ended || !state.isThere;
      row.className = gone
        ? "gone"
        : this.#run.severityOf(track.callsign, this.#clock.t)
          ? "alert"
          : "";
      const what = gone ? (state.ended ? "ended" : "not there yet") : state.phase;
      const texts = [
        [words(track.type), what].filter((text) => text).join(", "),
        ...(gone
          ? ["", "", ""]
          : [
              state.onGround ? "ground" : feet(state.altitude),
              `${whole((state.speed * 3600) / METRE_PER_NM)} kt`,
              bearing(((state.heading * 180) / Math.PI + 360) % 360),
            ]),
      ];
      cells.forEach((cell, i) => {
        cell.textContent = texts[i];
      });
    }
  }
}
