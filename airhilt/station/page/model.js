// What the server said of the run, prepared for drawing: tracks in metres, states at any time,
// events.

import { RadarPlots } from "./radar_plots.js";
import { at, before, headingAt } from "./series.js";
import { METRE_PER_NM, SEVERITIES, instruction, known, words } from "./words.js";

const COLOURS = 8;
const LONGEST_INTERVAL_S = 12; // between two reports of an actor: a turn of a surveillance radar
// Intervals between reports for which an actor is shown further on after the last one.
const AHEAD = 1.5;
const RATE_SPAN_S = 10; // over which a vertical rate that no sensor reports is a mean
// Of an actor of a live run that are kept: the older ones in the longer steps.
const MOST_STATES = 3000;
const MOST_TRACKS = 200; // of a live run that are kept: those that were reported last
// Of a live run that are kept, the newest; bars of latencies for some ten minutes.
const MOST_ROWS = { calls: 1000, events: 2000, advisories: 1000, latencies: 4000 };
const CONTROLLER = "ATC"; // as recipient of advisories

/** Returns the identifiers of the ends of all runways; none without an airport. */
export const identsOf = (airport) =>
  (airport?.runways ?? []).flatMap(({ ends }) => ends.map(({ ident }) => ident));

/** The track of one actor. */
export class Track {
  patience = 1; // s without a state after which the actor has ended

  constructor(given, index) {
    Object.assign(this, given);
    this.east = given.east_nm.map((value) => value * METRE_PER_NM);
    this.north = given.north_nm.map((value) => value * METRE_PER_NM);
    this.colour = `--c${index % COLOURS}`;
  }

  get first() {
    return this.t[0];
  }
  get last() {
    return this.t[this.t.length - 1];
  }

  /** Indices of points of the track, not many more than `most`, and the last one. */
  thinned(most) {
    const step = Math.ceil(this.t.length / most);
    return [...this.t.keys()].filter((i) => (this.t.length - 1 - i) % step === 0);
  }

  /** Metres east and north of the centre at a time. */
  place(t) {
    return [at(this.t, this.east, t), at(this.t, this.north, t)];
  }

  /** The state at a time: the first one before it, the last one after it. */
  state(t, span) {
    const now = Math.min(Math.max(t, this.first), this.last);
    const from = Math.max(now - span, this.first),
      to = Math.min(now + span, this.last),
      seconds = Math.max(to - from, 1e-9);
    const [e1, n1] = this.place(from),
      [e2, n2] = this.place(to),
      [east, north] = this.place(t);
    const moved = Math.hypot(e2 - e1, n2 - n1);
    const { speed, course } = this.velocity(now) ?? {
      speed: moved / seconds,
      course: moved > 0.5 ? Math.atan2(e2 - e1, n2 - n1) : 0,
    };
    return {
      east,
      north,
      speed,
      knots: (speed * 3600) / METRE_PER_NM,
      course,
      heading: this.heading_deg ? headingAt(this, now) : course,
      altitude: at(this.t, this.altitude_ft, now),
      rate: this.verticalRate(now),
      onGround: this.on_ground.some(([down, up]) => down <= now && now <= up),
      phase: words(this.phases.findLast((phase) => phase.from <= now)?.what ?? ""),
      isThere: t >= this.first - 1,
      ended: t > this.last + this.patience,
    };
  }

  /** Speed and course as a sensor has them, null if they follow from the places. */
  velocity() {
    return null;
  }

  /**
   * Vertical rate in ft/min: a mean, as altitudes come in steps of 25 ft or 100 ft (RTCA DO-260B,
   * ICAO Annex 10).
   */
  verticalRate(t) {
    const to = Math.min(t + RATE_SPAN_S / 2, this.last),
      from = Math.max(to - RATE_SPAN_S, this.first),
      climbed = at(this.t, this.altitude_ft, to) - at(this.t, this.altitude_ft, from);
    return to > from ? (climbed / (to - from)) * 60 : 0;
  }
}

/** The track of an actor of a live run, to which states are added. */
export class LiveTrack extends Track {
  patience = 15;
  #velocities = []; // m/s eastward and northward, and ft/min upward where a sensor reports that
  #interval = 0; // s between two reports, rather too long than too short

  constructor(callsign, category, type, index) {
    const names = "t east_nm north_nm altitude_ft heading_deg on_ground phases".split(" "),
      rows = Object.fromEntries(names.map((name) => [name, []]));
    super({ callsign, category, type, ...rows }, index);
  }

  add([t, east, north, altitude, velocity, heading, onGround, phase]) {
    if (this.t.length && t <= this.last) return;
    if (this.t.length)
      this.#interval = Math.min(Math.max(t - this.last, 0.8 * this.#interval), LONGEST_INTERVAL_S);
    const wasOnGround = this.on_ground.length && this.on_ground.at(-1)[1] === this.last;
    if (onGround && wasOnGround) this.on_ground.at(-1)[1] = t;
    else if (onGround) this.on_ground.push([t, t]);
    if (this.phases.at(-1)?.what !== phase) this.phases.push({ from: t, what: phase });
    this.t.push(t);
    this.east.push(east);
    this.north.push(north);
    this.altitude_ft.push(altitude);
    this.heading_deg.push(heading);
    this.#velocities.push(velocity);
    if (this.t.length > MOST_STATES) this.#thin();
  }

  /** Keeps every second state of the older half, so that a run of any length needs no more memory. */
  #thin() {
    const thinned = (values) => values.filter((_, i) => i % 2 === 0 || i > MOST_STATES / 2);
    for (const name of ["t", "east", "north", "altitude_ft", "heading_deg"])
      this[name] = thinned(this[name]);
    this.#velocities = thinned(this.#velocities);
  }

  /**
   * After its last report an actor goes on straight, for a little more than it takes until the next
   * one.
   */
  place(t) {
    const [east, north] = super.place(t),
      ahead = Math.min(t - this.last, AHEAD * this.#interval);
    if (!(ahead > 0)) return [east, north];
    const [eastward, northward] = this.#velocities.at(-1);
    return [east + eastward * ahead, north + northward * ahead];
  }

  velocity(t) {
    const [east, north] = this.#velocities[before(this.t, t)];
    return { speed: Math.hypot(east, north), course: Math.atan2(east, north) };
  }

  /** Vertical rate in ft/min as it was reported last, or a mean. */
  verticalRate(t) {
    return this.#velocities[before(this.t, t)][2] ?? super.verticalRate(t);
  }
}

/** Puts a row into a list in the place of the one that is the same, or at its end. */
function put(rows, row, isSame) {
  const i = rows.findLastIndex(isSame);
  if (i < 0) rows.push(row);
  else rows[i] = row;
}

/** Bounds of no place at all, in m. */
export const NOWHERE = { east: [Infinity, -Infinity], north: [Infinity, -Infinity] };

/** Returns the bounds that hold a place as well. */
export const widened = ({ east, north }, place) => ({
  east: [Math.min(east[0], place[0]), Math.max(east[1], place[0])],
  north: [Math.min(north[0], place[1]), Math.max(north[1], place[1])],
});

/** A run as the page shows it. */
export class Run {
  #callsigns = new Map(); // by the addresses under which actors were known first
  #active = { t: null, rows: [] };
  advised = 0; // changes so far of the advisories that are seen
  #moments = null; // until somebody asks for them
  ownCategory = null; // of the seat: "unit", "aircraft" or "vehicle"; null until it is known
  own = null; // the seat of the person at this page, who sees the advisories to it alone
  tuned = () => null; // returns the frequencies in kHz that are listened to here; null: all
  plots = new RadarPlots();
  #actors; // that have had a track so far

  constructor(given) {
    Object.assign(this, { latencies: [] }, given);
    const pair = given.pair ?? [];
    const order = [...given.tracks].sort(
      (a, b) => pair.includes(b.callsign) - pair.includes(a.callsign),
    );
    this.tracks = order.map((track, index) => new Track(track, index));
    this.#actors = order.length;
    // Seconds before and after an instant over which its speed is a mean.
    this.span = given.airport ? 1 : 4;
    this.title = given.scenario.title || given.scenario.name;
    this.bounds = this.tracks
      .flatMap(({ east, north }) => east.map((metres, i) => [metres, north[i]]))
      .reduce(widened, NOWHERE);
  }

  /** Forgets what was seen of a live run: another seat sees something else. */
  forget() {
    for (const name of ["tracks", "cameras", ...Object.keys(MOST_ROWS)]) this[name] = [];
    this.plots = new RadarPlots();
    this.bounds = NOWHERE;
    this.#callsigns.clear();
    this.advised += 1;
    this.#moments = null;
    this.#actors = 0;
  }

  /** True once a live run goes on no more. */
  get isOver() {
    return ["finished", "stopped", "gone"].includes(this.phase);
  }

  /** The events that one may jump to, in the order of their times. */
  get moments() {
    return (this.#moments ??= momentsOf(this));
  }

  /** Takes in the changes of a live run, and returns which parts of it are different now. */
  apply(changes) {
    const changed = new Set();
    for (const [kind, ...rest] of changes) {
      changed.add(kind);
      if (this.#takers[kind]?.(...rest)) changed.add("track");
    }
    if (changed.has("call")) this.calls.sort((a, b) => a.from - b.from);
    for (const [name, most] of Object.entries(MOST_ROWS))
      if (this[name].length > 1.2 * most) this[name].splice(0, this[name].length - most);
    if (changed.has("call") || changed.has("event")) this.#moments = null;
    if (["advisory", "name", "briefing"].some((kind) => changed.has(kind))) this.advised += 1;
    return changed;
  }

  /** What takes in each kind of change; true if the actors are others than before. */
  #takers = {
    clock: (t, phase, pace, behind = 0) => {
      Object.assign(this, { now: Math.max(t ?? 0, this.now ?? 0), phase, pace, behind });
    },
    briefing: (controller, airport, categories) => {
      Object.assign(this, { controller, airport, categories, span: airport ? 1 : 4 });
    },
    state: (...state) => this.#addState(state),
    plot: (plot) => {
      this.plots.add(plot, this.tracks);
      this.bounds = widened(this.bounds, [plot.east, plot.north]);
    },
    name: (address, callsign) => this.#rename(address, callsign),
    call: (call) => put(this.calls, call, (one) => one.id === call.id),
    advisory: (row) =>
      put(this.advisories, row, (one) =>
        ["id", "revision", "equipment"].every((part) => one[part] === row[part]),
      ),
    event: (row) => void this.events.push(row),
    latency: (bar) => void this.latencies.push(bar),
    camera: (camera) => void this.cameras.push(camera),
  };

  /**
   * Takes in the callsign of an actor that was known by its address until now. Where the truth has
   * told of the callsign meanwhile, the address is the same actor once more.
   */
  #rename(address, callsign) {
    this.#callsigns.set(address, callsign);
    const track = this.track(address);
    if (!track) return true;
    if (this.track(callsign)) this.tracks.splice(this.tracks.indexOf(track), 1);
    else track.callsign = callsign;
    return true;
  }

  /** Adds a state, and returns true if the actor or its type is new. */
  #addState([name, category, type, ...state]) {
    const known = this.track(name),
      track = known ?? new LiveTrack(name, category, type, this.#actors++),
      isNew = !known || track.type !== type;
    if (!known) this.#addTrack(track);
    track.type = type;
    track.category = this.categories?.[name] ?? category;
    track.add(state);
    if (!known) this.plots.explain(track);
    this.now = Math.max(this.now ?? 0, state[0]);
    this.bounds = widened(this.bounds, [state[1], state[2]]);
    return isNew;
  }

  /**
   * Adds a track, in the place of the one whose last report is the oldest if there are too many.
   */
  #addTrack(track) {
    if (this.tracks.length >= MOST_TRACKS) {
      const oldest = this.tracks.reduce((a, b) => (b.last < a.last ? b : a));
      this.tracks.splice(this.tracks.indexOf(oldest), 1);
    }
    this.tracks.push(track);
  }

  track(callsign) {
    return this.tracks.find((track) => track.callsign === callsign);
  }

  /** The callsign of an actor that an advisory may know by its address alone. */
  callsignOf(name) {
    return this.#callsigns.get(name) ?? name;
  }

  /** True if a call is on a frequency that is listened to here. */
  hears(call) {
    const heard = this.tuned();
    return !heard || heard.includes(call.frequency_khz);
  }

  /** Texts of an advisory that are seen here. */
  textsOf(row) {
    return this.own === null
      ? row.texts
      : row.texts.filter(({ recipient }) => this.isTo(recipient));
  }

  /** True if what is sent to a recipient is for the own seat. */
  isTo(recipient) {
    return (
      recipient === this.own ||
      (recipient === CONTROLLER && this.own === this.controller) ||
      this.callsignOf(recipient) === this.own
    );
  }

  states(t) {
    return this.tracks.map((track) => ({ track, state: track.state(t, this.span) }));
  }

  /** Highest severity of the advisories that are active for an actor at a time, or null. */
  severityOf(callsign, t) {
    const ranks = this.activeAdvisories(t)
      .filter((row) => row.traffic.some((name) => this.callsignOf(name) === callsign))
      .map((row) => SEVERITIES.indexOf(row.severity));
    return ranks.length ? SEVERITIES[Math.max(...ranks)] : null;
  }

  /**
   * The newest revision of each advisory that is seen at a time, where its conflict is not over;
   * found once for each time.
   */
  activeAdvisories(t) {
    if (this.#active.t === t && this.#active.advised === this.advised) return this.#active.rows;
    const newest = new Map();
    for (const row of this.advisories)
      if (row.t <= t && this.textsOf(row).length) newest.set(`${row.equipment}/${row.id}`, row);
    const rows = [...newest.values()].filter((row) => row.active);
    this.#active = { t, advised: this.advised, rows };
    return rows;
  }

  /** Horizontal and vertical distance of the pair at a time, null without a pair. */
  apart(t) {
    const [first, second] = (this.pair ?? []).map((callsign) => this.track(callsign));
    if (!first || !second || t > Math.min(first.last, second.last) + 1) return null;
    const [a, b] = [first.state(t, 0), second.state(t, 0)];
    return {
      horizontal: Math.hypot(a.east - b.east, a.north - b.north),
      vertical: Math.abs(a.altitude - b.altitude),
    };
  }
}

const PHASES = {
  begun: "conflict begins",
  opened: "conflict window opens",
  closed: "conflict window closes",
  loss_of_separation: "loss of separation",
  nmac: "near mid-air collision",
  tcas_ta: "TCAS traffic advisory due",
  tcas_ra: "TCAS resolution advisory due",
  runway_incursion: "runway incursion",
  collision: "collision",
};
// Kinds of events to which nobody jumps: calls have rows of their own.
const UNTOLD = ["radio", "transcript", "llm", "unregistered"];

/** The events that one may jump to, in the order of their times. */
function momentsOf(run) {
  const calls = run.calls.map(({ from, speaker, said }) => ({
    t: from,
    text: `${speaker ?? "somebody"}: ${said ?? ""}`,
  }));
  const others = run.events
    .filter(({ kind, t }) => !UNTOLD.includes(kind) && t > 0)
    .map((event) => ({ t: event.t, text: textOf(event) }));
  const people = personMoments(run.summary?.people),
    seen = new Set(),
    all = [...calls, ...others, ...people].sort((a, b) => a.t - b.t);
  return all.filter((one) => {
    const key = `${one.t.toFixed(1)} ${one.text}`;
    return !seen.has(key) && seen.add(key);
  });
}

function textOf(event) {
  switch (event.kind) {
    case "advisory":
      return event.active ? `${event.severity}: ${event.text}` : `over: ${event.text}`;
    case "conflict":
      return `${PHASES[event.phase] ?? words(event.phase)}, ${event.who}`;
    case "command":
      return `${event.who}: ${commandOf(event.text)}`;
    case "status":
      return `${words(event.who)} ${event.state}${event.text ? `: ${event.text}` : ""}`;
    case "finished":
    case "stopped":
      return `run ${event.kind}`;
    default:
      return [words(event.kind), event.who, event.text]
        .filter((part) => known(part) && part !== "")
        .join(", ");
  }
}

/** Returns a command in words, or its text if that is none. */
function commandOf(text) {
  try {
    return instruction(JSON.parse(text));
  } catch {
    return text;
  }
}

function ofReaction({ seat, reaction }) {
  const about = [reaction.severity, words(reaction.advised ?? "")].filter(Boolean).join(", "),
    began = reaction.counted_from === "seen" ? reaction.t_seen_s : reaction.t_heard_s;
  return [
    { t: reaction.t_seen_s, text: `${seat} sees ${about}` },
    { t: reaction.t_heard_s, text: `${seat} hears ${about}` },
    {
      t: known(reaction.reaction_time_s) && known(began) ? began + reaction.reaction_time_s : null,
      text: `${seat} reacts to ${about}: ${words(reaction.first_action ?? "")}`,
    },
  ];
}

function ofRating({ seat, rating }) {
  return known(rating.rating)
    ? {
        t: rating.t_s + rating.answered_after_s,
        text: `${seat} answers: workload ${rating.rating}`,
      }
    : { t: rating.t_s, text: `${seat} does not answer for the workload` };
}

/** The moments of people that a summary has; none in a run that goes on. */
function personMoments(people = []) {
  const found = people.flatMap(({ seat, reactions, workload }) => [
    ...reactions.flatMap((reaction) => ofReaction({ seat, reaction })),
    ...(workload?.isa ?? []).map((rating) => ofRating({ seat, rating })),
  ]);
  return found.filter(({ t }) => known(t));
}
