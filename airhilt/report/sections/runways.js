/** Times before the threshold that are marked on an approach, in s. */
const BEFORE_THRESHOLD_S = [60, 30, 10];
function drawRunways() {
  const used = data.filter((runway) => runway.occupants.length || runway.approaches.length).sort((a, b) => a.runway.localeCompare(b.runway));
  if (!used.length) return () => {};
  byId("runways-figure").hidden = false;
  const rowsOf = used.flatMap((runway) => [...new Set([...runway.approaches, ...runway.occupants].map((interval) => interval.what))].map((actor, i) => ({ runway, actor, first: !i })));
  const names = rowsOf.map(({ runway, actor, first }) => ({ text: actor, head: first ? runway.runway : "", colour: colourOf(actor) }));
  const frame = timelines(byId("runways"), names, "Runway occupancy over time", rowsOf.flatMap(({ first }, i) => (first && i ? [i] : [])));
  const { chart: { root }, area, x, middles } = frame, rowOf = (name, actor) => rowsOf.findIndex((row) => row.runway.runway === name && row.actor === actor);
  rowsOf.forEach(({ runway, actor }, i) => {
    const own = (intervals) => intervals.filter((interval) => interval.what === actor), y = middles[i];
    for (const approach of own(runway.approaches)) root.append(...approachNodes(approach, x, y, colourOf(actor)));
    for (const stay of own(runway.occupants)) root.append(svg("rect", { class: "occupied", x: x(stay.from), y: y - 7, width: Math.max(x(stay.to) - x(stay.from), 2), height: 14, rx: 3, fill: colourOf(actor) }));
  });
  for (const incursion of incursions) {
    const i = rowOf(incursion.runway, incursion.intruder), k = incursion.user ? rowOf(incursion.runway, incursion.user) : -1;
    if (i < 0) continue;
    const colour = incursion.category && !SEVERE.includes(incursion.category) ? "var(--warn)" : "var(--bad)", cx = x(incursion.t_s);
    if (k >= 0) root.append(svg("line", { x1: cx, x2: cx, y1: middles[i], y2: middles[k], stroke: colour, "stroke-width": 1.6 }));
    root.append(incursionSymbol(cx, middles[i], incursion.category, colour));
  }
  return followPointer(frame.chart, area, x, (t) => [
    ...used.flatMap((runway) => { const there = goingOn(runway.occupants, t); return there.length ? [`${runway.runway}: ${list(there.map((stay) => stay.what))} in the protected area`] : []; }),
    ...used.flatMap((runway) => goingOn(runway.approaches, t).map((approach) => `${approach.what} to land on ${approach.runway}${known(approach.threshold) ? (t < approach.threshold ? `, ${seconds(approach.threshold - t, 0)} from the threshold` : ", past the threshold") : ""}`)),
    ...incursions.filter((incursion) => Math.abs(incursion.t_s - t) < 4 * endS / (area.right - area.left)).map((incursion) => `runway incursion${incursion.category ? `, ${CATEGORIES[incursion.category][0]}` : ""}: ${incursion.intruder}`),
  ]);
}

/** An approach as a line until it is down or has gone around; ticks count down to its threshold. */
function approachNodes(approach, x, y, colour) {
  const nodes = [svg("line", { class: "approach", x1: x(approach.from), x2: x(approach.to), y1: y, y2: y, stroke: colour, "stroke-width": 2 })];
  if (!known(approach.threshold)) return nodes;
  for (const left of BEFORE_THRESHOLD_S) {
    const t = approach.threshold - left;
    if (t > approach.from) nodes.push(svg("line", { x1: x(t), x2: x(t), y1: y - 4, y2: y + 4, stroke: colour, "stroke-width": 1.5 }));
  }
  nodes.push(svg("path", { class: "threshold", d: `M${x(approach.threshold) - 5} ${y - 8}H${x(approach.threshold) + 5}L${x(approach.threshold)} ${y - 1}Z`, fill: colour, stroke: "var(--panel)" }));
  return nodes;
}

const incursionSymbol = (x, y, category, colour) => svg("g", { class: "incursion" }, svg("circle", { cx: x, cy: y, r: 8.5, fill: "var(--panel)", stroke: colour, "stroke-width": 2 }),
  svg("text", { class: "bold", x, y: y + 4.3, "text-anchor": "middle", style: `fill: ${colour}` }, !category || category === "accident" ? "!" : category));

function drawKey() {
  const coming = data.flatMap((runway) => runway.approaches), timed = coming.some((approach) => known(approach.threshold));
  byId("runways-key").append(...windowKey(), keyItem(svg("rect", { y: 2, width: 20, height: 10, rx: 3, fill: "var(--dim)" }), "in the protected area"),
    ...(coming.length ? [keyItem(keyLine({ stroke: "var(--dim)", "stroke-width": 2 }), "on approach")] : []),
    ...(timed ? [keyItem(svg("path", { d: "M10 2V12", stroke: "var(--dim)", "stroke-width": 1.5 }), `${BEFORE_THRESHOLD_S.join(", ")} s before the threshold`), keyItem(svg("path", { d: "M5 3H15L10 11Z", fill: "var(--dim)" }), "over the threshold")] : []),
    ...[...new Set(incursions.map((incursion) => incursion.category))].map((category) => keyItem(incursionSymbol(10, 7, category, category && !SEVERE.includes(category) ? "var(--warn)" : "var(--bad)"), category ? `runway incursion, ${CATEGORIES[category][0]}` : "runway incursion")));
}

return { draw: drawKey, fit: drawRunways };
