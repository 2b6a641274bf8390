/** The views of the plan: all traffic and, at an airport, nearer ones. */
const views = (() => {
  const inMiles = (points) => points.map(([east, north]) => [east / METRE_PER_NM, north / METRE_PER_NM]), paved = inMiles(airport ? airport.runways.flatMap((runway) => runway.protected) : []);
  const spot = airport && conflictBox();
  return [
    { name: "All traffic", box: boxOf([...tracks.flatMap((track) => track.east_nm.map((east, i) => [east, track.north_nm[i]])), ...paved]), pad: 1.14, least: 4, markEveryS },
    airport && tracks.length && { name: "Airport", box: boxOf(paved), pad: 1.06, least: 0, markEveryS: 10 },
    spot && { name: run.has_conflict ? "Conflict" : "Closest approach", box: spot, pad: 1, least: 0, markEveryS: 2 },
  ].filter(Boolean);
})();
let view = views.at(closeUp ? -1 : 0);

/** The surroundings of the closest approach of the pair, or of the first incursion. */
function conflictBox() {
  const [first, second] = pair.map(trackOf);
  const both = closest && first && second ? [first, second] : incursions.length ? tracks.filter((track) => track.callsign === incursions[0].intruder) : [];
  if (!both.length) return null;
  const t = both.length > 1 ? closest.t_s : incursions[0].t_s, mean = (values) => values.reduce((a, b) => a + b) / values.length;
  const there = both.map((track) => stateAt(track, t)), east = mean(there.map((state) => state.east)), north = mean(there.map((state) => state.north));
  const reach = (state) => Math.hypot(state.east - east, state.north - north), [within, most] = closeUp ? [4, 400] : [20, 5000], around = [t - within, t, t + within];
  const apart = Math.max(...there.map(reach)), moved = Math.max(...both.flatMap((track) => around.map((time) => reach(stateAt(track, time)))));
  const half = Math.max(Math.min(Math.max(moved, 120 / METRE_PER_NM), most / METRE_PER_NM), apart * 1.3);
  return { east: { low: east - half, high: east + half }, north: { low: north - half, high: north + half } };
}

function drawViews(show) {
  if (views.length < 2) return;
  byId("views").replaceChildren(...views.map((candidate) => {
    const button = html("button", { type: "button", "aria-pressed": candidate === view }, candidate.name);
    button.addEventListener("click", () => {
      view = candidate;
      [...byId("views").children].forEach((other) => other.setAttribute("aria-pressed", other === button));
      show();
    });
    return button;
  }));
}

function drawPlan() {
  const holder = byId("plan");
  if (!tracks.length) return holder.replaceChildren(dim("The log has no track."));
  const width = widthOf(holder), left = airport ? 64 : 54, most = innerWidth > 920 ? Math.min(width * 1.5, 690) : Math.min(Math.max(width * 0.8, 300), 560);
  const extent = ({ low, high }) => Math.max(high - low, view.least || 0.01), asHigh = (width - left - 12) * extent(view.box.north) / extent(view.box.east);
  const chart = canvas(holder, Math.min(Math.max(asHigh + 56, 300), most), view.name === "All traffic" ? "Plan view of all tracks" : `Plan view: ${view.name}`);
  const { root } = chart, area = { left, right: width - 12, top: 12, bottom: chart.height - 44 };
  const { x, y, perNm, near } = planeScales(area, view.box, view.pad, view.least, true);
  if (airport) drawAirport(clip(root, "airport-clip", area), x, y, perNm / METRE_PER_NM, area);
  axes(root, area, x, y, ...["East", "North"].map((name) => `${name} (${near ? "m" : "NM"})`));
  const ground = clip(root, "plan-clip", area);
  for (const track of [...tracks].reverse()) drawTrack(ground, track, x, y);
  const reserved = drawClosest(ground, x, y, area);
  if (airport) reserved.push(drawScaleBar(root, perNm, near, area));
  const moving = svg("g", {});
  ground.append(moving);
  pointOut(chart, tracks.flatMap((track) => track.t.map((t, i) => [x(track.east_nm[i]), y(track.north_nm[i]), { track, t }])), 18, stateLines);
  return (t) => moving.replaceChildren(...planAt(t, x, y, perNm, area, reserved));
}

function drawTrack(ground, track, x, y) {
  ground.append(svg("path", { class: track.prominent ? "line" : "line faint", stroke: track.colour, d: path(track.east_nm, track.north_nm, x, y) }));
  if (track.prominent) {
    for (const t of ticks(view.markEveryS, track.t.at(-1), view.markEveryS)) {
      ground.append(svg("circle", { cx: x(at(track.t, track.east_nm, t)), cy: y(at(track.t, track.north_nm, t)), r: 2.6, fill: track.colour }));
    }
  }
  ground.append(svg("circle", { cx: x(track.east_nm[0]), cy: y(track.north_nm[0]), r: track.prominent ? 5 : 3, fill: "var(--panel)", stroke: track.colour, "stroke-width": 2 }));
}

/** Marks where the pair was nearest, and returns the boxes that its label takes. */
function drawClosest(ground, x, y, area) {
  const [first, second] = pair.map(trackOf);
  if (!closest || !first || !second) return [];
  const ends = [first, second].map((track) => stateAt(track, closest.t_s)).map((state) => [x(state.east), y(state.north)]);
  const px = (ends[0][0] + ends[1][0]) / 2, py = (ends[0][1] + ends[1][1]) / 2;
  const text = `${known(timeOf("collision")) ? "collision" : "closest approach"}, ${seconds(closest.t_s)}`, width = measure(text);
  const lx = Math.min(Math.max(px, area.left + width / 2 + 6), area.right - width / 2 - 6), ly = py + 64 > area.bottom ? py - 58 : py + 64;
  ground.append(line(...ends[0], ...ends[1], { stroke: "var(--ink)", "stroke-width": 1.5 }),
    line(px, py + (ly > py ? 8 : -8), lx, ly > py ? ly - 13 : ly + 5, { stroke: "var(--dim)" }), crossSymbol(px, py), label(lx, ly, text, { class: "halo" }));
  return [{ left: lx - width / 2 - 4, right: lx + width / 2 + 4, top: ly - 14, bottom: ly + 5 }];
}

function stateLines({ track, t }) {
  const state = stateAt(track, t), where = airport ? (value) => `${whole(value * METRE_PER_NM)} m` : miles;
  return [track.callsign, `t = ${seconds(t)}`, `${airport ? `${state.phase}, ` : ""}${feet(state.altitude)}, ${whole(state.speed)} kt`, `east ${where(state.east)}, north ${where(state.north)}`];
}

const REACH_NM = 3000 / METRE_PER_NM; // of a field of view that is drawn
const LONGEST_LOOK_S = 1; // for which a bearing is shown after its picture

/** Returns the field of view of each camera at a time, and lines in the directions of what was found in it. */
function camerasAt(t, x, y, perNm) {
  return (data || []).flatMap((camera) => {
    const pose = camera.poses.findLast(([from]) => from <= t + 1e-6) || camera.poses[0], [, east, north, heading] = pose;
    const cx = x(east), cy = y(north), reach = Math.max(REACH_NM * perNm, 30), half = camera.fov_deg / 2;
    const end = (degrees, far) => { const angle = degrees * Math.PI / 180; return [cx + far * Math.sin(angle), cy - far * Math.cos(angle)]; };
    const [ax, ay] = end(heading - half, reach), [bx, by] = end(heading + half, reach), found = camera.found.findLast(([from]) => from <= t + 1e-6);
    const lines = found && t - found[0] < LONGEST_LOOK_S ? found[1] : [];
    return [svg("path", { class: "cone", d: `M${cx} ${cy}L${ax} ${ay}A${reach} ${reach} 0 ${camera.fov_deg > 180 ? 1 : 0} 1 ${bx} ${by}Z` }),
      ...lines.map((degrees) => line(cx, cy, ...end(degrees, 1.5 * reach), { class: "bearing" }))];
  });
}

/** Returns aircraft, their data blocks and the ring of the separation minimum at a time. */
function planAt(t, x, y, perNm, area, reserved) {
  const nodes = camerasAt(t, x, y, perNm), states = tracks.map((track) => ({ track, state: stateAt(track, t) }));
  const taken = [...states.map(({ state }) => boxAround(x(state.east), y(state.north), 16, 16)), ...reserved];
  const focus = states.find(({ track, state }) => track.callsign === pair[0] && !state.ended);
  if (focus && !closeUp) nodes.push(svg("circle", { class: "ring", cx: x(focus.state.east), cy: y(focus.state.north), r: minimumNm * perNm }));
  for (const { track, state } of states) {
    const px = x(state.east), py = y(state.north);
    if (airport) nodes.push(fill(bodySymbol(px, py, track, state, perNm / METRE_PER_NM), { opacity: state.ended ? 0.5 : null }));
    if (state.ended) nodes.push(crossSymbol(px, py, track.colour));
    else if (!airport) nodes.push(arrowSymbol(px, py, state.heading, track.colour));
  }
  for (const { track, state } of states) {
    const px = x(state.east), py = y(state.north), away = px < area.left || px > area.right || py < area.top || py > area.bottom;
    const block = away ? track.prominent && pointAway(track, px, py, taken, area, perNm) : placeBlock(track, state, px, py, taken, area);
    if (block) nodes.push(block);
  }
  return nodes;
}

/** Points from the edge of the plan to an actor outside of it. */
function pointAway(track, px, py, taken, area, perNm) {
  const halfWidth = (area.right - area.left) / 2, halfHeight = (area.bottom - area.top) / 2, cx = area.left + halfWidth, cy = area.top + halfHeight, dx = px - cx, dy = py - cy;
  const share = Math.min((halfWidth - 10) / Math.abs(dx || 1e-9), (halfHeight - 10) / Math.abs(dy || 1e-9));
  const ex = cx + dx * share, ey = cy + dy * share, text = `${track.callsign}, ${distance((1 - share) * Math.hypot(dx, dy) / perNm * METRE_PER_NM)} off`;
  const width = measure(text, true) + 6, wantedX = ex - Math.sign(dx) * (Math.abs(dx) * share > halfWidth * 2 / 3 ? width / 2 + 14 : 0);
  const tx = Math.min(Math.max(wantedX, area.left + width / 2 + 4), area.right - width / 2 - 4);
  const boxes = [0, 16, -16, 32, -32, 48].map((shift) => boxAround(tx, Math.min(Math.max(ey + shift + (tx === ex ? -Math.sign(dy) * 18 : 0), area.top + 12), area.bottom - 12), width, 18));
  const box = firstFree(boxes, taken) ?? boxes[0];
  return svg("g", {}, arrowSymbol(ex, ey, Math.atan2(dx, -dy), track.colour), label(tx, box.cy + 4, text, { class: "halo bold", style: `fill: ${track.colour}` }));
}

/** Directions in which the data block of an actor may lie, the best first. */
const AROUND = [[0, -1], [0, 1], [1, -1], [-1, -1], [1, 1], [-1, 1], [1, 0], [-1, 0]];

function placeBlock(track, state, px, py, taken, area) {
  const arrow = Math.abs(state.rate) < 150 ? "" : state.rate > 0 ? " ↑" : " ↓";
  const second = state.ended ? "ended" : airport && state.onGround ? `${state.phase}${state.speed > 1 ? `, ${whole(state.speed)} kt` : ""}` : `${feet(state.altitude)}${arrow}`;
  const lines = track.prominent ? [track.callsign, second] : [track.callsign];
  const width = Math.max(...lines.map((text, i) => measure(text, !i))) + 6, height = lines.length * 15 + 2;
  const boxes = (track.prominent ? [14, 34, 58] : [14]).flatMap((far) => AROUND.map(([dx, dy]) => (
    { far, ...boxAround(px + dx * (far + width / 2 - (dy ? 8 : 0)), py + dy * (far + height / 2 - 2), width, height) })));
  const box = firstFree(boxes.filter((one) => isInside(one, area)), taken);
  return box && svg("g", {}, box.far > 14 && line(px, py, box.cx, box.cy, { stroke: "var(--dim)", opacity: .6 }),
    lines.map((text, i) => label(box.cx, box.top + 12 + i * 15, text, { class: i ? "halo" : "halo bold", style: i ? null : `fill: ${track.colour}` })));
}

/** Columns of the traffic: name, class, and what is read off a state. */
const COLUMNS = [
  ["Phase", "", (state) => state.phase],
  ["Altitude (ft)", "number", (state) => (airport && state.onGround ? "ground" : whole(state.altitude))], ["Rate (ft/min)", "number", (state) => whole(Math.round(state.rate / 50) * 50)],
  ["Speed (kt)", "number", (state) => whole(state.speed)], [airport ? "Heading (°)" : "Track (°)", "number", (state) => bearing(state.heading * 180 / Math.PI + 360).slice(0, -1)],
].slice(airport ? 0 : 1);

function drawStates() {
  const columns = COLUMNS.map(([name, kind, read], i) => [name, kind, (state) => (state.ended ? (i ? "" : "ended") : read(state))]);
  return fillStates(byId("states"), [[airport ? "Actor" : "Aircraft", "row"], ["Type"]], columns, tracks.map((track) => ({ cells: [[swatch(track.colour), track.callsign], words(track.type)], at: (t) => stateAt(track, t) })));
}

function drawPlanKey() {
  const example = (category) => tracks.some((track) => track.category === category) && keyItem(bodySymbol(10, 7, { category, colour: "var(--dim)" }, { heading: Math.PI / 2, onGround: true }, 0), category);
  fillKey("plan-key", airport && ["aircraft", "vehicle", "wildlife"].map(example),
    keyItem(svg("circle", { cx: 10, cy: 7, r: 5, fill: "none", stroke: "var(--dim)", "stroke-width": 2 }), "start"),
    keyItem(svg("circle", { cx: 10, cy: 7, r: 2.6, fill: "var(--dim)" }), `every ${view.markEveryS} s`),
    closest && pair.length && keyItem(crossSymbol(10, 7), known(timeOf("collision")) ? "collision" : "closest approach"),
    pair.length && !closeUp && keyItem(keyLine({ class: "minimum" }), `${minimumNm} NM around ${pair[0]}`),
    data?.length && [keyItem(svg("path", { class: "cone", d: "M1 7L19 1V13Z" }), "view of a camera"), keyItem(keyLine({ class: "bearing" }), "bearing of a detection")],
    airport && [keyItem(svg("rect", { class: "protected", x: .5, y: .5, width: 19, height: 13, fill: "url(#hatch)" }), "protected area"), keyItem(keyLine({ class: "hold" }), "hold line")]);
}

let showPlan = null;
return {
  draw() {
    byId("plan-caption").textContent = airport ? `around the reference point of ${airport.icao}` : "NM around the centre of the traffic";
    drawViews(() => { showPlan = drawPlan(); drawPlanKey(); showPlan(clock.t); });
    drawPlanKey();
    return drawStates();
  },
  fit() {
    showPlan = drawPlan();
    return (t) => showPlan?.(t);
  },
};
