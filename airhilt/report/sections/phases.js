/** How strongly a phase is coloured: the more can go wrong in it, the more. */
const STRENGTH = {
  standing: .1, stand: .1, lined_up: .16, hold_short: .1, taxi: .24, line_up: .24, vacate: .24, driving: .24, stopping: .16, walking: .24, en_route: .16, flying: .24,
};
/** Kinds of events that are marked on an actor's row: colour and meaning. */
const EVENTS = {
  command: ["var(--ink)", "receives a command"], failure: ["var(--bad)", "failure"], unable: ["var(--warn)", "unable"], pilot_reacts: ["var(--accent)", "reacts to an advisory"], no_response: ["var(--warn)", "does not respond"], actor_ended: ["var(--bad)", "ended"],
};
const ownEvents = run.events.filter((event) => event.kind in EVENTS && trackOf(event.who));
function eventSymbol(x, y, kind) {
  const fill = EVENTS[kind][0];
  switch (kind) {
    case "command": return svg("path", { d: `M${x - 4} ${y - 4}H${x + 4}L${x} ${y + 3}Z`, fill, stroke: "var(--panel)" });
    case "pilot_reacts": return svg("path", { d: `M${x} ${y - 5}L${x + 5} ${y}L${x} ${y + 5}L${x - 5} ${y}Z`, fill, stroke: "var(--panel)" });
    default: return crossSymbol(x, y, fill);
  }
}

function phaseMarks({ text: callsign, phases, colour }, x, y) {
  const marks = phases.flatMap(({ from, to, what }) => {
    const left = x(from), width = Math.max(x(to) - left, 1.5), text = words(what);
    return [svg("rect", { class: "phase", x: left, y: y - 9, width: Math.max(width - 1, 1), height: 18, fill: colour, opacity: STRENGTH[what] ?? 0.42 }),
      measure(text) + 8 < width && label(left + 5, y + 4, text, { "text-anchor": "start" })];
  });
  return [...marks, ...ownEvents.filter((event) => event.who === callsign).map((event) => eventSymbol(x(event.t), y - 9, event.kind))];
}

function drawPhases() {
  const shown = tracks.slice(0, MOST_ROWS).map(({ callsign, colour, phases }) => ({ text: callsign, colour, phases }));
  if (!shown.some(({ phases }) => phases.length > 1)) return null;
  fillKey("phases-key", Object.entries(EVENTS).map(([kind, [, name]]) => ownEvents.some((event) => event.kind === kind) && keyItem(eventSymbol(10, 7, kind), name)), keyMore(tracks.length - shown.length, " actors"));
  return timelines("phases", shown, "Phases of each actor over time", phaseMarks, (t, near) => [
    ...shown.flatMap(({ text, phases }) => { const phase = phases.findLast(({ from, to }) => from <= t && t <= to); return phase ? [`${text} ${words(phase.what)}`] : []; }),
    ...near(ownEvents).slice(0, 4).map((event) => `${event.who}: ${textOf(event)}`),
  ]).follow;
}

return { fit: drawPhases };
