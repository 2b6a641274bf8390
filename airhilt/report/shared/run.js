// What happened in the run.

const run = given, summary = run.summary;

/** Phases of a conflict, in words. */
const PHASES = {
  begun: "conflict begins", opened: "conflict window opens", closed: "conflict window closes", loss_of_separation: "separation lost",
  nmac: "near mid-air collision", collision: "collision", tcas_ta: "TCAS TA", tcas_ra: "TCAS RA",
  runway_incursion: "runway incursion",
};
/** Categories of runway incursions, and what they mean: FAA Order 7050.1B, appendix A. */
const CATEGORIES = {
  accident: ["accident", "the two collided"],
  A: ["category A", "serious: a collision was narrowly avoided"],
  B: ["category B", "separation decreased, with a significant potential for collision"],
  C: ["category C", "ample time or distance to avoid a collision"],
  D: ["category D", "incorrect presence on a runway, with no immediate consequence"],
};
const SEVERE = ["accident", "A", "B"];
/** Rank of CAUTION, from which on an advisory is spoken. */
const SPOKEN = 2;
/** Largest number of actors that each have a colour of their own. */
const MOST_COLOURED = 8;

const pair = run.pair || [];
/** True if an event is about the pair alone. */
const inPair = (event) => event.actors && event.actors.every((actor) => pair.includes(actor));
const conflictPhases = run.events.filter((event) => event.kind === "conflict");
const happened = (phase) => conflictPhases.some((event) => event.phase === phase);
/** Time at which the pair came to a phase of its conflict, or null. */
const timeOf = (phase) => conflictPhases.find((event) => event.phase === phase && inPair(event))?.t ?? null;
const [advisories, reactions, calls, failures] = ["advisory", "pilot_reacts", "radio", "failure"].map((kind) => run.events.filter((event) => event.kind === kind));
const minimumNm = run.separation.horizontal_nm || 5;
const minimumFt = run.separation.vertical_ft || 1000;
const endS = Math.max(run.end_s, 1);
/** Time between two marks on a track. */
const markEveryS = endS <= 600 ? 30 : endS <= 1800 ? 120 : 600;
const closest = summary && summary.closest_approach;
const airport = run.airport;
const incursions = summary ? summary.runway_incursions : conflictPhases.filter((event) => event.phase === "runway_incursion").map((event) => ({
  t_s: event.t, runway: event.runway, user: event.actors.length > 1 ? event.actors[0] : null, intruder: event.actors.at(-1), category: null,
}));
const worst = summary && summary.runway_incursion_category;
