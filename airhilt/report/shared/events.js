// Events in words.

/** Kinds of events in words, in the order of the filters. */
const KINDS = {
  radio: "Radio call", transcript: "Transcript", WARNING: "WARNING", CAUTION: "CAUTION", ADVISORY: "ADVISORY", INFO: "INFO", equipment: "Equipment",
  failure: "Failure", unable: "Unable", pilot_reacts: "Reaction", no_response: "No response", controller_reacts: "Controller reacts", controller_silent: "Controller silent", command: "Command", conflict: "Conflict", worker_lost: "Worker lost", step_missed: "No result", actor_ended: "Actor ended", status: "Modality", run: "Run",
};
const kindOf = (event) => (event.kind === "advisory" ? event.severity : event.kind in KINDS ? event.kind : "run");

function textOf(event) {
  const { kind, text, actors, phase } = event, apart = (sign, read) => (known(event.horizontal_m) ? `${sign} ${read(event.horizontal_m)} and ${feet(event.vertical_m / METRE_PER_FT)} apart` : "");
  switch (kind) {
    case "transcript": return `${text} (${event.engine ? `${event.engine}, ` : ""}confidence ${fixed(event.confidence, 2)})`;
    case "command": try { return instruction(JSON.parse(text), trackOf(event.who)?.category === "vehicle"); } catch { return text; }
    case "failure": return event.line ? `${event.speaker}’s call “${event.line}”: ${text}` : text;
    case "status": return text ? `${event.state}: ${text}` : event.state;
    case "conflict": return phase !== "runway_incursion" ? (PHASES[phase] || phase) + apart(":", distance)
      : `runway incursion: ${actors.at(-1)} on runway ${event.runway}${actors.length > 1 ? `, in the way of ${actors[0]}${apart(",", metres)}` : ", where it has no business"}`;
    case "advisory": return event.active ? text : `over: ${text}`;
    case "finished": case "stopped": return `${kind}: ${text}`;
    default: return text;
  }
}
const whoOf = (event) => (event.kind === "radio" && event.to ? `${event.who} to ${event.to}` : ["advisory", "equipment"].includes(event.kind) ? `to ${event.who}` : event.who);
