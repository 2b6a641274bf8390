const { calls: said, advisories: spoken } = run.sections.radio;
const groups = [
  ...[...Map.groupBy(said, (call) => call.frequency_khz)].sort().map(([khz, all]) => [megahertz(khz), Map.groupBy(all, (call) => call.who)]),
  ["assistant", Map.groupBy(spoken, (one) => one.recipient)],
];

/** Draws who transmits when, by frequency, and to whom the assistant speaks. */
function drawTransmissions() {
  if (!said.length && !spoken.length) return null;
  const isNarrow = innerWidth <= 620, short = (text) => (text.length > 16 ? `${text.slice(0, 15)}…` : text);
  const wanted = groups.flatMap(([head, rows]) => [...rows].map(([who, of], i) => ({
    of, text: short(head === "assistant" ? `to ${who}` : who), head: i ? null : isNarrow ? "" : head, colour: colourOf(who),
  })));
  const warned = { stroke: "var(--bad)", "stroke-width": 2 }, example = (fill) => svg("rect", { x: 1, y: 2, width: 18, height: 10, rx: 2, fill, ...warned });
  fillKey("transmissions-key", said.some((call) => call.said && call.blocked_by.length) && keyItem(example("var(--dim)"), "blocked by another"),
    said.some((call) => !call.said) && keyItem(example("none"), "a carrier without words"), keyMore(wanted.length - MOST_ROWS));
  return timelines("transmissions", wanted.slice(0, MOST_ROWS), "Transmissions over time", ({ of, colour }, x, y) => of.map((one) => {
    const isBlocked = one.blocked_by?.length > 0;
    return intervalRect(x, one, y - 7, 14, { class: `transmission${isBlocked ? " blocked" : ""}`, rx: 2, fill: one.said ? colour : "none", ...(isBlocked || !one.said ? warned : {}) });
  }), (t) => [
    ...goingOn(said, t).map((call) => `${call.who}${call.addressed ? ` to ${call.addressed}` : ""}: ${call.said || "only a carrier"}${call.blocked_by.length ? " (blocked)" : ""}`),
    ...goingOn(spoken, t).map((one) => `assistant to ${one.recipient}: ${one.said}`),
  ]).follow;
}

return { fit: drawTransmissions };
