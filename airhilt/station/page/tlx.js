// The sliders of NASA-TLX.

import { byId, html } from "./dom.js";

/**
 * Scales: name in the answers, name on the page, question, and both ends (Hart & Staveland 1988).
 */
const SCALES = [
  [
    "mental_demand",
    "Mental demand",
    "How mentally demanding was the task?",
    "Very low",
    "Very high",
  ],
  [
    "physical_demand",
    "Physical demand",
    "How physically demanding was the task?",
    "Very low",
    "Very high",
  ],
  [
    "temporal_demand",
    "Temporal demand",
    "How hurried or rushed was the pace of the task?",
    "Very low",
    "Very high",
  ],
  [
    "performance",
    "Performance",
    "How successful were you in doing what you were asked to do?",
    "Perfect",
    "Failure",
  ],
  [
    "effort",
    "Effort",
    "How hard did you have to work to reach your level of performance?",
    "Very low",
    "Very high",
  ],
  [
    "frustration",
    "Frustration",
    "How insecure, discouraged, irritated, stressed and annoyed were you?",
    "Very low",
    "Very high",
  ],
];

export class Tlx {
  #touched = new Set();

  /** Shows all sliders in their middle, as not answered. */
  begin() {
    this.#touched.clear();
    byId("scales").replaceChildren(...SCALES.map((scale) => this.#row(scale)));
  }

  /** Names of the scales that nobody has answered yet. */
  get missing() {
    return SCALES.filter(([id]) => !this.#touched.has(id)).map(([, name]) => name);
  }

  get answers() {
    return Object.fromEntries(SCALES.map(([id]) => [id, Number(byId(`tlx-${id}`).value)]));
  }

  #row([id, name, question, low, high]) {
    const input = html("input", {
      type: "range",
      min: 0,
      max: 100,
      step: 5,
      value: 50,
      id: `tlx-${id}`,
      class: "untouched",
      "aria-label": `${name}. ${question}`,
    });
    for (const event of ["input", "click"])
      input.addEventListener(event, () => {
        this.#touched.add(id);
        input.classList.remove("untouched");
      });
    return html(
      "label",
      { class: "scale" },
      html("span", { class: "name" }, html("strong", {}, name), ` ${question}`),
      html("span", { class: "end" }, low),
      input,
      html("span", { class: "end" }, high),
    );
  }
}
