// The advisories to the person at a seat: shown large, sounded, spoken; tells the run when that
// was.

import { badge, basisOf } from "./advisories.js";
import { byId, html } from "./dom.js";
import { identity } from "./identity.js";
import { Rows } from "./rows.js";
import { SEVERITIES, capital, instruction, known, seconds } from "./words.js";

const MOST_SHOWN = 10; // at a time, the most severe

export class OwnAdvisories {
  #run;
  #live;
  #loudspeaker;
  // Least severity that the assistant speaks; null: it speaks none; undefined: not known yet.
  spokenFrom = undefined;
  #shown = new Map(); // the newest text of each advisory in force
  #told = new Set();
  #sounded = new Set(); // what was audible, and is not to sound again
  #rows = new Rows(byId("own-advisories"));

  constructor(live, loudspeaker) {
    this.#run = live.run;
    this.#live = live;
    this.#loudspeaker = loudspeaker;
  }

  /** Takes in an advisory, as the run publishes it. */
  takeAdvisory(row) {
    const texts = this.#run.textsOf(row);
    if (!texts.length) return;
    const name = `${row.equipment}/${row.id}`;
    if (row.active) this.#shown.set(name, { row, text: texts.at(-1) });
    else this.#shown.delete(name);
    this.#draw();
    if (!row.active) return;
    const { recipient } = texts.at(-1);
    requestAnimationFrame(() => setTimeout(() => this.#report(row, recipient, "seen", 0)));
    const isSounded = this.#sounded.has(soundOf(row, recipient));
    if ((row.equipment || !this.#isSpoken(row)) && !isSounded) this.#sound(row, recipient, null);
  }

  /** Takes in that the assistant speaks an advisory to somebody. */
  takeSpoken({ id, revision, recipient, sound }) {
    if (!this.#run.isTo(recipient)) return;
    const row = this.#run.advisories.find(
      (one) => one.id === id && one.revision === revision && !one.equipment,
    );
    this.#sound(
      row ?? { equipment: "", id, revision, severity: "CAUTION" },
      recipient,
      sound ? `api/calls/${encodeURIComponent(sound)}.wav?browser=${identity()}` : null,
    );
  }

  /** Forgets everything: whoever has the seat next is another person. */
  clear() {
    for (const kept of [this.#shown, this.#told, this.#sounded]) kept.clear();
    this.spokenFrom = undefined;
    this.#draw();
  }

  #isSpoken({ severity }) {
    if (this.spokenFrom === undefined) return true;
    const from = SEVERITIES.indexOf(this.spokenFrom);
    return from >= 0 && SEVERITIES.indexOf(severity) >= from;
  }

  /** Sounds an advisory, with its voice if there is one, and reports when that was heard. */
  async #sound(row, recipient, url) {
    const name = soundOf(row, recipient);
    this.#sounded.add(name);
    const after = await this.#loudspeaker.warn(row.severity, url);
    if (after === null) this.#sounded.delete(name);
    else this.#report(row, recipient, "heard", after);
  }

  #report({ id, revision, equipment }, recipient, way, after) {
    const name = `${way} ${id} ${revision} ${recipient}`;
    if (equipment || this.#told.has(name)) return;
    this.#told.add(name);
    const after_s = this.#live.afterArrival(after);
    // Whoever has just left the seat need not be told that this came too late.
    this.#live.act({ do: "perceive", id, revision, recipient, way, after_s }).catch(() => {});
  }

  #draw() {
    byId("own-advisories").hidden = !this.#shown.size;
    const rank = ({ row }) => SEVERITIES.indexOf(row.severity),
      shown = [...this.#shown.values()];
    shown.sort((a, b) => rank(b) - rank(a) || b.row.t - a.row.t);
    this.#rows.show(shown.slice(0, MOST_SHOWN), ({ row }) => `${row.equipment}/${row.id}`, inWords);
  }
}

const soundOf = ({ equipment, id, revision }, recipient) =>
  `${equipment} ${id} ${revision} ${recipient}`;

const inWords = ({ row, text }) =>
  html(
    "div",
    { class: `own-advisory ${row.severity}-fill` },
    html("div.row-head", badge(row.severity), html("span.dim", seconds(row.t))),
    html("div.own-text", text.message),
    text.recommendation ? html("div.who", capital(instruction(text.recommendation))) : null,
    html("div.dim", restsOn(row.evidence, text.message)),
  );

function restsOn(evidence, said) {
  const basis = basisOf(evidence),
    { time_to_go_s: toGo, note } = evidence;
  return [
    note === said ? "" : note,
    basis ? `rests on ${basis}` : "",
    known(toGo) ? `time to go ${seconds(toGo)}` : "",
  ]
    .filter(Boolean)
    .join("; ");
}
