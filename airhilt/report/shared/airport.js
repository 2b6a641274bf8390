// The airport below the traffic.

/** Largest number of taxiways that are named. */
const MOST_LETTERS = 60;

/** Draws the airport; `x` and `y` place nautical miles east and north of its reference point. */
function drawAirport(ground, x, y, perMetre, area) {
  const px = (point) => [x(point[0] / METRE_PER_NM), y(point[1] / METRE_PER_NM)];
  const ring = (points) => `${points.map((point, i) => `${i ? "L" : "M"}${px(point).map((value) => value.toFixed(1)).join(" ")}`).join("")}Z`;
  const shape = (style, points, more = {}) => svg("path", { class: style, d: ring(points), ...more });
  const leg = ([e1, n1, e2, n2], more) => line(...px([e1, n1]), ...px([e2, n2]), more);
  const named = (node, name) => fill(node, {}, [svg("title", {}, name)]);
  ground.append(svg("defs", {}, svg("pattern", { id: "hatch", width: 7, height: 7, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" }, line(0, 0, 0, 7, { stroke: "var(--hatch)", "stroke-width": 1 }))));
  ground.append(...airport.water.map((water) => named(shape("water", water.outline), water.name)));
  ground.append(...airport.taxiways.flatMap(({ legs, width_m, name }) => legs.map((points) => named(leg(points, { class: "taxiway", "stroke-width": Math.max(width_m * perMetre, 1) }), words(name)))));
  ground.append(...airport.runways.map((runway) => shape("protected", runway.protected, { fill: "url(#hatch)" })));
  ground.append(...airport.runways.map((runway) => shape("runway", runway.pavement, { stroke: "var(--runway)", "stroke-width": runway.width_m * perMetre < 2 ? 2 : 0 })));
  ground.append(...airport.runways.filter((runway) => runway.width_m * perMetre > 6).map(({ ends }) => line(...px(ends[0].start), ...px(ends[1].start), { class: "centreline", "stroke-dasharray": `${30 * perMetre} ${20 * perMetre}` })));
  ground.append(...airport.buildings.map((building) => named(shape("building", building.outline), building.name)));
  const taken = [];
  const write = (text, [cx, cy], style, turn = 0) => {
    const free = isInside(boxAround(cx, cy, 20, 20), area) && firstFree([boxAround(cx, cy, measure(text, true) + 6, 16)], taken);
    if (free) ground.append(label(cx, cy + 4, text, { class: style, transform: turn ? `rotate(${turn.toFixed(1)} ${cx.toFixed(1)} ${cy.toFixed(1)})` : null }));
    return Boolean(free);
  };
  const between = (a, b, part) => [a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part];
  for (const runway of airport.runways) {
    const [a, b] = runway.ends.map((end) => px(end.start)), length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length < 40) continue;
    const shown = runway.ends.filter((end, i) => write(end.ident, between(i ? b : a, i ? a : b, -14 / length), "halo bold")).length;
    if (shown) continue;
    const turn = Math.atan((b[1] - a[1]) / (b[0] - a[0] || 1e-9)) * 180 / Math.PI;
    const aside = (runway.width_m * perMetre / 2 + 11) / length, beside = ([cx, cy]) => [cx + (b[1] - a[1]) * aside, cy - (b[0] - a[0]) * aside];
    const inside = Array.from({ length: 81 }, (_, i) => beside(between(a, b, i / 80))).filter((point) => isInside(boxAround(...point, 96, 96), area));
    inside.some((point) => write(runway.name, point, "halo bold", turn));
  }
  if (perMetre < 0.12) return;
  ground.append(...airport.holds.map((hold) => named(leg(hold.line, { class: "hold" }), `hold ${words(hold.name)}`)));
  if (airport.tower) { const [cx, cy] = px(airport.tower); ground.append(named(svg("path", { d: `M${cx} ${cy - 7}L${cx + 5} ${cy + 5}H${cx - 5}Z`, fill: "var(--dim)", stroke: "var(--panel)" }), "tower")); }
  const size = ([e1, n1, e2, n2]) => Math.hypot(e2 - e1, n2 - n1);
  for (const taxiway of airport.taxiways.filter((candidate) => candidate.name !== "ramp").slice(0, MOST_LETTERS)) {
    taxiway.legs.toSorted((a, b) => size(b) - size(a)).some(([e1, n1, e2, n2]) => [0.5, 0.25, 0.75].some((part) => write(words(taxiway.name), between(px([e1, n1]), px([e2, n2]), part), "halo unit small")));
  }
}

/** Draws a scale bar, and returns the box that it takes. */
function drawScaleBar(root, perNm, near, area) {
  const unit = near ? perNm / METRE_PER_NM : perNm, room = (area.right - area.left) / 4;
  const length = [5000, 2000, 1000, 500, 200, 100, 50, 20, 10, 5, 2, 1, 0.5, 0.2, 0.1].find((nice) => nice * unit <= room);
  const left = area.left + 12, right = left + length * unit, y = area.bottom - 12, text = near ? `${whole(length)} m` : `${length} NM`;
  root.append(svg("path", { class: "rule", d: `M${left} ${y - 6}V${y}H${right}V${y - 6}` }), label((left + right) / 2, y - 7, text, { class: "halo" }));
  return { left: left - 4, right: right + 4, top: y - 24, bottom: area.bottom };
}
