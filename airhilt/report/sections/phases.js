/** How strongly a phase is coloured: the more can go wrong in it, the more. */
const STRENGTH = {
  standing: .1, stand: .1, lined_up: .16, hold_short: .1, taxi: .24, line_up: .24, vacate: .24, driving: .24, stopping: .16, walking: .24, en_route: .16, flying: .24,
};
const strength = (phase) => STRENGTH[phase] || 0.42;

function drawPhases() {
  const shown = tracks.slice(0, MOST_ROWS);
  if (!shown.some((track) => track.phases.length > 1)) return () => {};
  byId("phases-figure").hidden = false;
  const frame = timelines(byId("phases"), shown.map((track) => ({ text: track.callsign, colour: track.colour })), "Phases of each actor over time");
  const { chart: { root }, area, x, middles } = frame;
  shown.forEach((track, i) => {
    for (const phase of track.phases) {
      const left = x(phase.from), width = Math.max(x(phase.to) - left, 1.5), text = words(phase.what);
      root.append(svg("rect", { class: "phase", x: left, y: middles[i] - 9, width: Math.max(width - 1, 1), height: 18, fill: track.colour, opacity: strength(phase.what) }));
      if (measure(text) + 8 < width) root.append(svg("text", { x: left + 5, y: middles[i] + 4 }, text));
    }
    for (const event of ownEvents.filter((candidate) => candidate.who === track.callsign)) root.append(eventSymbol(x(event.t), middles[i] - 9, event.kind));
  });
  const follow = followPointer(frame.chart, area, x, (t) => [
    ...shown.map((track) => [track.callsign, track.phases.findLast((phase) => phase.from <= t && t <= phase.to)]).filter(([, phase]) => phase).map(([callsign, phase]) => `${callsign} ${words(phase.what)}`),
    ...ownEvents.filter((event) => Math.abs(event.t - t) < 4 * endS / (area.right - area.left)).slice(0, 4).map((event) => `${event.who}: ${textOf(event)}`),
  ]);
  byId("phases-key").replaceChildren(...EVENTS.filter(([kind]) => ownEvents.some((event) => event.kind === kind)).map(([kind, , name]) => keyItem(eventSymbol(10, 7, kind), name)),
    ...(tracks.length > shown.length ? [html("li", { class: "dim" }, `and ${tracks.length - shown.length} more actors`)] : []));
  return follow;
}

/** Kinds of events that are marked on an actor's row: colour and meaning. */
const EVENTS = [
  ["command", "var(--ink)", "receives a command"], ["failure", "var(--bad)", "failure"], ["unable", "var(--warn)", "unable"], ["pilot_reacts", "var(--accent)", "reacts to an advisory"], ["actor_ended", "var(--bad)", "ended"],
];
const ownEvents = run.events.filter((event) => EVENTS.some(([kind]) => kind === event.kind) && tracks.some((track) => track.callsign === event.who));
function eventSymbol(x, y, kind) {
  const [, colour] = EVENTS.find(([candidate]) => candidate === kind);
  if (kind === "failure" || kind === "unable" || kind === "actor_ended") return crossSymbol(x, y, colour);
  return svg("path", { d: kind === "command" ? `M${x - 4} ${y - 4}H${x + 4}L${x} ${y + 3}Z` : `M${x} ${y - 5}L${x + 5} ${y}L${x} ${y + 5}L${x - 5} ${y}Z`, fill: colour, stroke: "var(--panel)" });
}

return { fit: drawPhases };
