// Questions to a person, each with a scale or a choice; NASA-TLX is one such questionnaire.

import { html } from "./dom.js";

const MOST_BUTTONS = 11; // steps of a scale that are buttons; one with more is a slider

export class Questionnaire {
  #items;
  answers = {}; // by the names of the items

  /** Shows all items as not answered; `place` is the element in which they are. */
  constructor(place, { name, items }) {
    this.name = name;
    this.#items = items;
    place.replaceChildren(...items.map((item) => this.#row(item)));
  }

  /** Names, on the page, of the items that nobody has answered yet. */
  get missing() {
    return this.#items
      .filter(({ name }) => !(name in this.answers))
      .map(({ title, question }) => title ?? question);
  }

  #row(item) {
    if (item.type === "choice") return this.#choice(item);
    return item.steps > MOST_BUTTONS ? this.#slider(item) : this.#steps(item);
  }

  #slider({ name, title, question, low, high, steps, first, interval }) {
    const last = first + (steps - 1) * interval;
    const input = html("input", {
      type: "range",
      min: first,
      max: last,
      step: interval,
      value: first + Math.floor((steps - 1) / 2) * interval,
      class: "untouched",
      "aria-valuetext": "not answered",
      "aria-label": title ? `${title}. ${question}` : question,
    });
    for (const event of ["input", "click"])
      input.addEventListener(event, () => {
        this.answers[name] = Number(input.value);
        input.classList.remove("untouched");
        input.removeAttribute("aria-valuetext");
      });
    return html(
      "label.item.scale",
      html("span.name", ...inWords(title, question)),
      html("span.end", low),
      input,
      html("span.end", high),
    );
  }

  #steps({ name, title, question, low, high, steps, first, interval }) {
    const numbers = Array.from({ length: steps }, (_, i) => first + i * interval);
    return html(
      "fieldset.item",
      html("legend", ...inWords(title, question)),
      html(
        "div.scale.stepped",
        html("span.end", low),
        html("span.steps", ...numbers.map((n) => this.#button(name, n))),
        html("span.end", high),
      ),
    );
  }

  #choice({ name, title, question, choices }) {
    return html(
      "fieldset.item",
      html("legend", ...inWords(title, question)),
      html("div.choices", ...choices.map((text) => this.#button(name, text))),
    );
  }

  #button(name, answer) {
    const input = html("input", { type: "radio", name, value: answer });
    input.addEventListener("change", () => {
      this.answers[name] = answer;
    });
    return html("label", input, ` ${answer}`);
  }
}

const inWords = (title, question) => (title ? [html("strong", title), ` ${question}`] : [question]);
