// The advisories of the assistant, each with what it rests on.

import { Pane } from "./pane.js";
import { button, byId, html, svg, timeButton } from "./dom.js";
import { FILLED } from "./pen.js";
import { Rows } from "./rows.js";
import { capital, instruction, known, percent, seconds, words } from "./words.js";

const SHAPES = {
  INFO: "M8 2a6 6 0 1 0 .01 0M8 7v4M8 4.6v.6",
  ADVISORY: "M8 1.5L14.5 8 8 14.5 1.5 8z",
  CAUTION: "M8 2L15 14H1z",
  WARNING: "M5 1.5h6L14.5 5v6L11 14.5H5L1.5 11V5z",
};
const MOST_LIVE = 200; // of a live run that are listed, the newest
const MOST_ANNOUNCED = 3; // at once, the newest

/** The severity of an advisory, by shape, text and colour. */
export const badge = (severity) =>
  html(
    "span",
    { class: `badge ${severity} ${FILLED.includes(severity) ? "filled" : ""}` },
    svg(
      "svg",
      { viewBox: "0 0 16 16", "aria-hidden": "true" },
      svg("path", { d: SHAPES[severity] ?? SHAPES.INFO }),
    ),
    severity,
  );

/** What an advisory rests on, with the share of each source. */
export const basisOf = ({ sources, shares }) =>
  sources
    .map((name) => (known(shares[name]) ? `${words(name)} ${percent(shares[name])}` : words(name)))
    .join(", ");

export class Advisories extends Pane {
  #rows = new Rows(byId("advisories"));
  #links;
  #items = [];
  #listed = null; // which advisories were listed last
  #last = 0;
  #names = null; // of the advisories that were listed last

  /** `links.call(id)` and `links.camera(name)` show what an advisory rests on. */
  constructor(run, clock, links) {
    super(run, clock);
    this.#links = links;
    this.redraw();
  }

  /** Shows the advisories again, because there are new ones. */
  redraw() {
    const rows = this.run.advisories
      .filter((row) => this.run.textsOf(row).length)
      .slice(this.clock.live ? -MOST_LIVE : 0);
    const shown = rows.map((row) => ({ ...row, texts: this.run.textsOf(row) })),
      name = (row) => `${row.equipment}/${row.id}/${row.revision}`;
    const items = this.#rows.show(
      shown,
      name,
      (row) => this.#item(row),
      `No advisory ${this.clock.live ? "so far" : "in this run"}.`,
    );
    this.#items = rows.map((row, i) => ({ row, item: items[i] }));
    this.#announceNew(rows, name);
    this.#listed = this.run.advised;
    this.draw();
  }

  /** Forgets the advisories; those that come next are no new ones. */
  forget() {
    this.redraw();
    this.#names = null;
  }

  draw() {
    if (this.#listed !== this.run.advised) {
      this.redraw();
      return;
    }
    const { t } = this.clock,
      active = new Set(this.run.activeAdvisories(t)),
      now = this.#items.filter(({ row }) => active.has(row));
    this.#announceTimely(t);
    this.#rows.mark(now.map(({ item }) => item));
  }

  /** Announces advisories whose time has just come while the clock plays. */
  #announceTimely(t) {
    if (this.clock.playing && t > this.#last)
      this.#announce(this.run.advisories.filter((row) => this.#last < row.t && row.t <= t));
    this.#last = t;
  }

  /**
   * Announces advisories that have just come of a live run; those of before are known, when the
   * page is opened.
   */
  #announceNew(rows, name) {
    const before = this.#names;
    this.#names = new Set(rows.map(name));
    if (before && this.clock.following)
      this.#announce(rows.filter((row) => !before.has(name(row))));
  }

  /**
   * Tells a screen reader of advisories; those to the own seat are an alert where they are shown.
   */
  #announce(rows) {
    const told = rows
      .filter((row) => row.active)
      .slice(-MOST_ANNOUNCED)
      .map((row) => `${row.severity}: ${row.texts[0]?.message ?? ""}`);
    if (told.length && !this.run.own) byId("alert").textContent = told.join(". ");
  }

  #item(row) {
    const source = row.equipment ? `${words(row.equipment)}, ` : "",
      texts = [...new Map(row.texts.map((text) => [text.message, text])).values()];
    const to = (message) =>
      row.texts
        .filter((text) => text.message === message)
        .map((text) => text.recipient)
        .join(", ");
    return html(
      "li",
      html(
        "div.row-head",
        timeButton(this.clock, row.t, seconds(row.t)),
        row.active ? badge(row.severity) : html("span.badge", "over"),
        html("span.dim", `${source}${words(row.kind)}`),
      ),
      texts.map((text) =>
        html(
          "div",
          html("span.dim", `${to(text.message)}: `),
          text.message,
          text.recommendation ? html("span.who", ` (${instruction(text.recommendation)})`) : null,
        ),
      ),
      row.active ? this.#evidence(row.evidence) : null,
    );
  }

  #evidence(evidence) {
    const link = (text, show) => button(text, () => show(text), { class: "time" });
    const facts = [
      ["rests on", basisOf(evidence)],
      ["rules", evidence.rules.map(words).join(", ")],
      ["note", evidence.note],
      ["runway", evidence.runway],
      ["time to go", known(evidence.time_to_go_s) ? seconds(evidence.time_to_go_s) : null],
      ["time to loss", known(evidence.time_to_loss_s) ? seconds(evidence.time_to_loss_s) : null],
      ["calls", evidence.radio_ids.map((id) => link(id, this.#links.call))],
      ["cameras", evidence.camera_ids.map((name) => link(name, this.#links.camera))],
      ["tracks", evidence.tracks.join(", ")],
      ["faults", evidence.inconsistencies.join(", ")],
    ].filter(([, value]) => known(value) && value !== "" && value.length);
    const spaced = (value) =>
      Array.isArray(value) ? value.flatMap((node, i) => (i ? [", ", node] : [node])) : value;
    return html(
      "details",
      html("summary", "Evidence"),
      html(
        "dl",
        facts.flatMap(([name, value]) => [html("dt", capital(name)), html("dd", spaced(value))]),
      ),
    );
  }
}
