// The advisories to the person at a seat: shown large, sounded, spoken; tells the run when that was.

import { badge } from "./advisories.js";
import { byId, html } from "./dom.js";
import { identity } from "./live.js";
import { capital, instruction, known, percent, seconds, words } from "./words.js";

const CONTROLLER = "ATC";

export class OwnAdvisories {
  #run;
  #tell;
  #warn;
  #shown = new Map(); // the newest text of each advisory in force
  #told = new Set();

  /** `tell(perceived)` reports to the run; `warn(severity, url)` sounds, and returns when it is audible, in s. */
  constructor(run, tell, warn) {
    this.#run = run;
    this.#tell = tell;
    this.#warn = warn;
  }

  /** Takes in advisories to a seat, as the run publishes them. */
  takeAdvisory(own, row) {
    const texts = row.texts.filter(({ recipient }) => this.#isFor(own, recipient));
    if (!texts.length) return;
    const name = `${row.equipment}/${row.id}`;
    if (row.active) this.#shown.set(name, { row, text: texts.at(-1) }); else this.#shown.delete(name);
    this.#draw();
    if (!row.active) return;
    const { recipient } = texts.at(-1);
    requestAnimationFrame(() => setTimeout(() => this.#report(row, recipient, "seen", 0)));
    if (row.equipment) this.#sound(row, recipient, null);
  }

  /** Takes in that the assistant speaks an advisory. */
  takeSpoken(own, { id, revision, recipient, sound }) {
    if (!this.#isFor(own, recipient)) return;
    const row = this.#run.advisories.find((one) => one.id === id && one.revision === revision && !one.equipment);
    this.#sound(row ?? { id, revision, severity: "CAUTION" }, recipient, sound ? `api/calls/${encodeURIComponent(sound)}.wav?browser=${identity()}` : null);
  }

  clear() {
    this.#shown.clear();
    this.#draw();
  }

  async #sound(row, recipient, url) {
    const after = await this.#warn(row.severity, url);
    if (after !== null && !row.equipment) this.#report(row, recipient, "heard", after);
  }

  #report({ id, revision, equipment }, recipient, way, after) {
    const name = `${way} ${id} ${revision} ${recipient}`;
    if (equipment || this.#told.has(name)) return;
    this.#told.add(name);
    this.#tell({ id, revision, recipient, way, after_s: after });
  }

  #isFor(own, recipient) {
    return recipient === own || (recipient === CONTROLLER && own === this.#run.controller) || this.#run.callsignOf(recipient) === own;
  }

  #draw() {
    byId("own-advisories").hidden = !this.#shown.size;
    byId("own-advisories").replaceChildren(...[...this.#shown.values()].map(({ row, text }) => html("div", { class: `own-advisory ${row.severity}-fill` },
      html("div", { class: "row-head" }, badge(row.severity), html("span", { class: "dim" }, seconds(row.t))),
      html("div", { class: "own-text" }, text.message),
      text.recommendation ? html("div", { class: "who" }, capital(instruction(text.recommendation))) : null,
      html("div", { class: "dim" }, restsOn(row.evidence)))));
  }
}

function restsOn({ sources, shares, time_to_go_s: toGo, note }) {
  const basis = sources.map((name) => (known(shares[name]) ? `${words(name)} ${percent(shares[name])}` : words(name))).join(", ");
  return [note, basis ? `rests on ${basis}` : "", known(toGo) ? `time to go ${seconds(toGo)}` : ""].filter((part) => part).join("; ");
}
