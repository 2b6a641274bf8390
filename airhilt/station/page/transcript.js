// The calls on the radio: what was said, what was recognised with which confidence, who understood
// it.

import { Pane } from "./pane.js";
import { byId, html, timeButton } from "./dom.js";
import { Rows } from "./rows.js";
import { capital, decibels, fixed, known, megahertz, percent, seconds, words } from "./words.js";

/** Confidence below which a word is marked: the paper's tau_ASR. */
const SURE = 0.8;
const MOST_LIVE = 200; // calls of a live run that are listed, the newest

export class Transcript extends Pane {
  #rows = new Rows(byId("calls"));
  #items = [];

  constructor(run, clock) {
    super(run, clock);
    this.redraw();
  }

  /** Shows the calls again, because there are new ones. */
  redraw() {
    const calls = this.run.calls
      .filter((call) => this.run.hears(call))
      .slice(this.clock.live ? -MOST_LIVE : 0);
    const several = new Set(calls.map((call) => call.frequency_khz)).size > 1;
    const empty = !this.clock.live
      ? "Nobody says anything in this run."
      : this.run.seats?.length && !this.run.own
        ? "Take a seat to see what is said there."
        : "Nobody has said anything so far.";
    const shown = calls.map((call) => ({ call, several })),
      items = this.#rows.show(
        shown,
        ({ call }) => call.id,
        (one) => this.#item(one),
        empty,
      );
    this.#items = calls.map((call, i) => ({ call, item: items[i] }));
    this.draw();
  }

  draw() {
    const { t } = this.clock,
      now = this.#items.filter(({ call }) => call.from <= t && t <= call.to),
      last = this.#items.findLast(({ call }) => call.from <= t);
    const shown = now.length ? now : last && t - last.call.to < 3 ? [last] : [],
      kept = shown.at(-1) ?? (this.clock.live ? last : null);
    this.#rows.mark(
      shown.map(({ item }) => item),
      kept?.item,
    );
  }

  /** Shows the row of a call and sets the clock to its beginning. */
  goTo(id) {
    const found = this.run.calls.find((call) => call.id === id);
    if (found) this.clock.set(found.from);
  }

  #item({ call, several }) {
    const who = call.speaker ?? call.transcripts.find((one) => one.speaker)?.speaker ?? "somebody";
    const facts = [
      several ? megahertz(call.frequency_khz) : null,
      known(call.snr_db) ? decibels(call.snr_db) : null,
      call.blocked_by.length ? "blocked" : null,
    ].filter(Boolean);
    const hearings = call.hearings.map(({ who: hearer, outcome }) =>
      html("span", { class: `badge ${outcome}` }, `${hearer}: ${words(outcome)}`),
    );
    return html(
      "li",
      html(
        "div.row-head",
        timeButton(this.clock, call.from, seconds(call.from)),
        html("span.who", who),
        call.addressed ? html("span.dim", `to ${call.addressed}`) : null,
        html("span.dim", facts.join(", ")),
      ),
      known(call.said) ? html("div", call.said || "(carrier without words)") : null,
      call.transcripts.map((one) => this.#heard(one)),
      hearings.length ? html("div.row-head", hearings) : null,
    );
  }

  #heard(one) {
    const marked = one.words.flatMap(({ text, confidence }, i) => {
      const title = `confidence ${fixed(confidence, 2)}`;
      return [i ? " " : "", confidence < SURE ? html("span", { class: "low", title }, text) : text];
    });
    return html(
      "div.heard",
      `${capital(one.engine || "recognised")}, ${percent(one.confidence)}: `,
      marked.length ? marked : one.text || "(nothing)",
    );
  }
}
