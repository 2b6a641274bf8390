/** Times before the threshold that are marked on an approach, in s. */
const BEFORE_THRESHOLD_S = [60, 30, 10];
const colourOfCategory = (category) => (category && !SEVERE.includes(category) ? "var(--warn)" : "var(--bad)");
const used = data.filter((runway) => runway.occupants.length || runway.approaches.length).sort((a, b) => a.runway.localeCompare(b.runway));

function drawRunways() {
  if (!used.length) return null;
  const rows = used.flatMap((runway) => [...new Set([...runway.approaches, ...runway.occupants].map((interval) => interval.what))].map((actor, i) => ({
    runway: runway.runway, text: actor, head: i ? null : runway.runway, colour: colourOf(actor),
    approaches: runway.approaches.filter((interval) => interval.what === actor), stays: runway.occupants.filter((interval) => interval.what === actor),
  })));
  const { root, x, middles, follow } = timelines("runways", rows, "Runway occupancy over time", ({ approaches, stays, colour }, scaled, y) => [
    ...approaches.flatMap((approach) => approachNodes(approach, scaled, y, colour)),
    ...stays.map((stay) => intervalRect(scaled, stay, y - 7, 14, { class: "occupied", rx: 3, fill: colour })),
  ], (t, near) => [
    ...used.flatMap((runway) => { const there = goingOn(runway.occupants, t); return there.length ? [`${runway.runway}: ${list(there.map((stay) => stay.what))} in the protected area`] : []; }),
    ...used.flatMap((runway) => goingOn(runway.approaches, t).map((approach) => `${approach.what} to land on ${approach.runway}${known(approach.threshold) ? (t < approach.threshold ? `, ${seconds(approach.threshold - t, 0)} from the threshold` : ", past the threshold") : ""}`)),
    ...near(incursions.map((incursion) => ({ ...incursion, t: incursion.t_s }))).map(({ category, intruder }) => `runway incursion${category ? `, ${CATEGORIES[category][0]}` : ""}: ${intruder}`),
  ]);
  for (const { runway, intruder, user, category, t_s } of incursions) {
    const [own, other] = [intruder, user].map((actor) => middles[rows.findIndex((row) => row.runway === runway && row.text === actor)]);
    if (own && other) root.append(line(x(t_s), own, x(t_s), other, { stroke: colourOfCategory(category), "stroke-width": 1.6 }));
    if (own) root.append(incursionSymbol(x(t_s), own, category));
  }
  return follow;
}

/** An approach as a line until it is down or has gone around; ticks count down to its threshold. */
function approachNodes({ from, to, threshold }, x, y, colour) {
  const times = known(threshold) ? BEFORE_THRESHOLD_S.map((left) => threshold - left).filter((t) => t > from) : [];
  return [line(x(from), y, x(to), y, { class: "approach", stroke: colour, "stroke-width": 2 }),
    ...times.map((t) => line(x(t), y - 4, x(t), y + 4, { stroke: colour, "stroke-width": 1.5 })),
    known(threshold) && svg("path", { class: "threshold", d: `M${x(threshold) - 5} ${y - 8}H${x(threshold) + 5}L${x(threshold)} ${y - 1}Z`, fill: colour, stroke: "var(--panel)" })];
}

const incursionSymbol = (x, y, category, colour = colourOfCategory(category)) => svg("g", { class: "incursion" }, svg("circle", { cx: x, cy: y, r: 8.5, fill: "var(--panel)", stroke: colour, "stroke-width": 2 }),
  label(x, y + 4.3, !category || category === "accident" ? "!" : category, { class: "bold", style: `fill: ${colour}` }));

const coming = data.flatMap((runway) => runway.approaches), isTimed = coming.some((approach) => known(approach.threshold));
fillKey("runways-key", windowKey(), keyItem(svg("rect", { y: 2, width: 20, height: 10, rx: 3, fill: "var(--dim)" }), "in the protected area"),
  coming.length && keyItem(keyLine({ stroke: "var(--dim)", "stroke-width": 2 }), "on approach"),
  isTimed && [keyItem(svg("path", { d: "M10 2V12", stroke: "var(--dim)", "stroke-width": 1.5 }), `${BEFORE_THRESHOLD_S.join(", ")} s before the threshold`), keyItem(svg("path", { d: "M5 3H15L10 11Z", fill: "var(--dim)" }), "over the threshold")],
  [...new Set(incursions.map((incursion) => incursion.category))].map((category) => keyItem(incursionSymbol(10, 7, category), category ? `runway incursion, ${CATEGORIES[category][0]}` : "runway incursion")));
return { fit: drawRunways };
