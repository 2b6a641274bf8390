/** Draws who transmits when, by frequency, and to whom the assistant speaks. */
function drawTransmissions() {
  const { calls: said, advisories: spoken } = run.sections.radio;
  if (!said.length && !spoken.length) return () => {};
  byId("transmissions-figure").hidden = false;
  const speakers = (khz) => [...new Set(said.filter((call) => call.frequency_khz === khz).map((call) => call.who))];
  const wanted = [
    ...[...new Set(said.map((call) => call.frequency_khz))].sort().flatMap((khz) => speakers(khz).map((who, i) => ({ who, head: i ? "" : megahertz(khz), of: said.filter((call) => call.who === who && call.frequency_khz === khz) }))),
    ...[...new Set(spoken.map((one) => one.recipient))].map((who, i) => ({ who, name: `to ${who}`, head: i ? "" : "assistant", of: spoken.filter((one) => one.recipient === who) })),
  ], shown = wanted.slice(0, MOST_ROWS);
  const holder = byId("transmissions"), narrow = holder.clientWidth < 560, short = (text) => (text.length > 16 ? `${text.slice(0, 15)}…` : text);
  const frame = timelines(holder, shown.map(({ who, name, head }) => ({ text: short(name || who), head: narrow ? "" : head, colour: colourOf(who) })), "Transmissions over time", shown.flatMap(({ head }, i) => (head && i ? [i] : [])));
  const { chart: { root }, area, x, middles } = frame;
  shown.forEach(({ of, who }, i) => {
    for (const one of of) {
      const blocked = one.blocked_by && one.blocked_by.length, colour = one.said ? colourOf(who) : "none";
      root.append(svg("rect", { class: `transmission${blocked ? " blocked" : ""}`, x: x(one.from), y: middles[i] - 7, width: Math.max(x(one.to) - x(one.from), 2), height: 14, rx: 2, fill: colour, ...(blocked || !one.said ? { stroke: "var(--bad)", "stroke-width": 2 } : {}) }));
    }
  });
  const on = (all, t) => all.filter((one) => one.from <= t && t < one.to);
  const follow = followPointer(frame.chart, area, x, (t) => [
    ...on(said, t).map((call) => `${call.who}${call.addressed ? ` to ${call.addressed}` : ""}: ${call.said || "only a carrier"}${call.blocked_by.length ? " (blocked)" : ""}`),
    ...on(spoken, t).map((one) => `assistant to ${one.recipient}: ${one.said}`),
  ]);
  const example = (attributes) => svg("rect", { x: 1, y: 2, width: 18, height: 10, rx: 2, fill: "none", stroke: "var(--bad)", "stroke-width": 2, ...attributes });
  byId("transmissions-key").replaceChildren(...(said.some((call) => call.said && call.blocked_by.length) ? [keyItem(example({ fill: "var(--dim)" }), "blocked by another")] : []),
    ...(said.some((call) => !call.said) ? [keyItem(example({}), "a carrier without words")] : []),
    ...(wanted.length > shown.length ? [html("li", { class: "dim" }, `and ${wanted.length - shown.length} more`)] : []));
  return follow;
}

return { fit: drawTransmissions };
