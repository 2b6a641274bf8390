"use strict";
// Events in words.

/** Kinds of events in words, in the order of the filters. */
const KINDS = {
  radio: "Radio call", transcript: "Transcript", WARNING: "WARNING", CAUTION: "CAUTION", ADVISORY: "ADVISORY", INFO: "INFO", equipment: "Equipment",
  failure: "Failure", unable: "Unable", pilot_reacts: "Reaction", command: "Command", conflict: "Conflict", worker_lost: "Worker lost", actor_ended: "Actor ended", status: "Modality", run: "Run",
};
const kindOf = (event) => (event.kind === "advisory" ? event.severity : event.kind in KINDS ? event.kind : "run");

function textOf(event) {
  switch (event.kind) {
    case "radio": return event.text;
    case "transcript": return `${event.text} (${event.engine ? `${event.engine}, ` : ""}confidence ${fixed(event.confidence, 2)})`;
    case "command": return command(event);
    case "failure": return event.line ? `${event.speaker}’s call “${event.line}”: ${event.text}` : event.text;
    case "status": return event.text ? `${event.state}: ${event.text}` : event.state;
    case "conflict": return event.phase === "runway_incursion" ? incursionText(event) : (PHASES[event.phase] || event.phase) + (known(event.horizontal_m)
      ? `: ${distance(event.horizontal_m)} and ${feet(event.vertical_m / METRE_PER_FT)} apart` : "");
    case "advisory": return event.active ? event.text : `over: ${event.text}`;
    case "finished": case "stopped": return `${event.kind}: ${event.text}`;
    default: return event.text;
  }
}
const incursionText = (event) => {
  const [user, intruder] = event.actors.length > 1 ? event.actors : [null, event.actors[0]];
  const apart = known(event.horizontal_m) ? `, ${metres(event.horizontal_m)} and ${feet(event.vertical_m / METRE_PER_FT)} apart` : "";
  return `runway incursion: ${intruder} on runway ${event.runway}${user ? `, in the way of ${user}${apart}` : ", where it has no business"}`;
};
const whoOf = (event) => (event.kind === "radio" && event.to ? `${event.who} to ${event.to}` : ["advisory", "equipment"].includes(event.kind) ? `to ${event.who}` : event.who);
