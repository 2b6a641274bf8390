// Flight progress strips: one an aircraft or vehicle that the controller expects, in the order that
// the controller gives them.

import { Pane } from "./pane.js";
import { button, byId, html } from "./dom.js";
import { level } from "./labels.js";
import { whole, words } from "./words.js";

const PERIOD_MS = 500;

export class Strips extends Pane {
  #list = byId("strips");
  #strips = new Map();
  #drawn = 0;

  constructor(run, clock) {
    super(run, clock);
    this.#list.addEventListener("keydown", (event) => this.#key(event));
  }

  /** Adds strips of those who are new, and shows what is known of all. */
  draw() {
    if (performance.now() - this.#drawn < PERIOD_MS) return;
    this.#drawn = performance.now();
    const callsigns = this.#callsigns();
    for (const callsign of callsigns) if (!this.#strips.has(callsign)) this.#add(callsign);
    for (const [callsign, strip] of this.#strips)
      if (callsigns.includes(callsign)) this.#fill(callsign, strip);
      else this.#remove(callsign);
  }

  #callsigns() {
    const seen = this.run.tracks
      .filter((track) => track.category !== "wildlife")
      .map((track) => track.callsign);
    return [...new Set([...Object.keys(this.run.categories ?? {}), ...seen])];
  }

  #add(callsign) {
    const note = html("input", {
      type: "text",
      class: "strip-note",
      maxlength: 40,
      autocomplete: "off",
      "aria-label": `Note on ${callsign}`,
      placeholder: "note",
    });
    const [type, where, said] = ["type", "where", "said"].map((name) =>
      html("span", { class: `strip-${name}` }),
    );
    const cock = button("\u25b6", () => this.#cock(item), {
      "aria-pressed": "false",
      "aria-label": `Cock the strip of ${callsign}`,
      title: "Cock the strip: something is left to do (X)",
    });
    const item = html(
      "li",
      { class: "flight-strip", tabindex: 0, "data-callsign": callsign },
      html("span.strip-name", html("span.who", callsign), type),
      html("span.strip-middle", where, said),
      note,
      cock,
    );
    this.#strips.set(callsign, { item, type, where, said, cock });
    this.#list.append(item);
  }

  /** Takes all strips away. */
  clear() {
    for (const callsign of [...this.#strips.keys()]) this.#remove(callsign);
  }

  /** Takes away a strip that was known by an address, because its callsign is known now. */
  #remove(callsign) {
    this.#strips.get(callsign).item.remove();
    this.#strips.delete(callsign);
  }

  #fill(callsign, { item, type, where, said }) {
    const track = this.run.track(callsign),
      state = track?.state(this.clock.t, this.run.span),
      isThere = state && !state.ended && state.isThere,
      kind = this.run.categories?.[callsign] ?? track?.category ?? "",
      severity = this.run.severityOf(callsign, this.clock.t) ?? "",
      knots = isThere ? whole(state.knots) : "",
      call = this.#lastCall(callsign);
    Object.assign(item.dataset, { kind, severity });
    type.textContent = [words(track?.type || kind), severity].filter(Boolean).join(" ");
    where.textContent = !isThere
      ? "not seen"
      : state.onGround
        ? `ground ${knots} kt`
        : `${level(state.altitude)}  ${knots} kt`;
    said.title = said.textContent = call?.transcripts.at(-1)?.text ?? call?.said ?? "";
  }

  /** The last call of this callsign that the recogniser has understood. */
  #lastCall(callsign) {
    return this.run.calls.findLast(
      (call) =>
        this.run.hears(call) &&
        call.from <= this.clock.t &&
        (call.addressed === callsign ||
          call.speaker === callsign ||
          call.transcripts.some((one) => one.speaker === callsign)),
    );
  }

  #cock(item) {
    const is = item.classList.toggle("cocked");
    this.#strips.get(item.dataset.callsign).cock.setAttribute("aria-pressed", is);
  }

  #key(event) {
    const item = event.target;
    if (!item.classList.contains("flight-strip")) return;
    const other = { ArrowUp: item.previousElementSibling, ArrowDown: item.nextElementSibling }[
      event.key
    ];
    if (event.key === "x") this.#cock(item);
    else if (event.key === "Enter") item.querySelector(".strip-note").focus();
    else if (other && event.altKey) {
      if (event.key === "ArrowUp") other.before(item);
      else other.after(item);
      item.focus();
    } else if (other) other.focus();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
