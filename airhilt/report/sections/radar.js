const flightLevel = (ft) => `A${String(Math.round(ft / 100)).padStart(3, "0")}`;
const plotColour = (plot) => (plot.actor ? colourOf(plot.actor) : "var(--ink)");

/** Symbol of a plot: a cross for an echo of the skin, a square for a reply, both for both. */
function plotSymbol(x, y, kind, colour, style = "plot") {
  const cross = `M${x - 4} ${y}H${x + 4}M${x} ${y - 4}V${y + 4}`, square = `M${x - 4} ${y - 4}H${x + 4}V${y + 4}H${x - 4}Z`;
  return svg("path", { class: style, d: kind === "primary" ? cross : kind === "secondary" ? square : square + cross, fill: "none", stroke: colour });
}

/** The part of the plane that is drawn: all plots, and the antenna unless it is far from them. */
function surroundings(radar) {
  const box = (points) => boxOf(points.map(({ east_nm, north_nm }) => [east_nm, north_nm])), size = ({ east, north }) => Math.max(east.high - east.low, north.high - north.low);
  const all = box([radar, ...radar.plots]), plots = radar.plots.length ? box(radar.plots) : all;
  return size(all) > 3 * size(plots) ? plots : all;
}

/** Draws the plots of a radar around its antenna; returns what shows those of the turn before a time. */
function drawRadar(radar, holder, number) {
  const width = widthOf(holder), chart = canvas(holder, Math.min(Math.max(width * 0.75, 300), 560), `Plots of radar ${radar.site}`);
  const { root } = chart, area = { left: 54, right: width - 12, top: 12, bottom: chart.height - 44 };
  const { east, north } = surroundings(radar), from = ({ low, high }, zero) => ({ low: low - zero, high: high - zero });
  const shift = { x: radar.east_nm, y: radar.north_nm }; // distances are from the antenna
  const { x, y, perNm, step } = planeScales(area, { east: from(east, shift.x), north: from(north, shift.y) }, 1.3, 2);
  const ground = clip(root, `radar-clip-${number}`, area);
  if (airport) drawAirport(ground, (value) => x(value - shift.x), (value) => y(value - shift.y), perNm / METRE_PER_NM, area);
  drawRings(ground, x, y, perNm, area, step);
  axes(root, area, x, y, "East of the antenna (NM)", "North (NM)");
  const at = (plot) => [x(plot.east_nm - shift.x), y(plot.north_nm - shift.y)];
  for (const plot of radar.plots) ground.append(plotSymbol(...at(plot), plot.kind, plotColour(plot), "plot past"));
  const fresh = svg("g", {});
  root.append(fresh);
  pointOut(chart, radar.plots.map((plot) => [...at(plot), plot]), 14, plotLines);
  return (t) => fresh.replaceChildren(...radar.plots.filter((plot) => plot.t <= t && t - plot.t < radar.rotation_s).flatMap((plot) => freshNodes(plot, ...at(plot), area)));
}

/** Draws range rings around the antenna, each with its radius on the side towards the plots. */
function drawRings(ground, x, y, perNm, area, step) {
  const far = Math.max(...[area.left, area.right].flatMap((px) => [area.top, area.bottom].map((py) => Math.hypot(x.invert(px), y.invert(py)))));
  const middle = [x.invert((area.left + area.right) / 2), y.invert((area.top + area.bottom) / 2)], away = Math.hypot(...middle) || 1;
  const turn = Math.atan2(middle[0], middle[1]) + (away < far / 2 ? 0.6 : Math.atan(0.35 * (area.bottom - area.top) / perNm / away));
  for (let radius = step; radius <= far; radius += step) {
    ground.append(svg("circle", { class: "range-ring", cx: x(0), cy: y(0), r: radius * perNm }),
      label(x(radius * Math.sin(turn)), y(radius * Math.cos(turn)) + 4, `${fixed(radius, digitsOf(step))} NM`, { class: "unit small" }));
  }
  ground.append(svg("circle", { class: "antenna", cx: x(0), cy: y(0), r: 5 }), svg("circle", { cx: x(0), cy: y(0), r: 1.5, fill: "var(--dim)" }));
}

/** A plot of the last turn with its codes. */
function freshNodes(plot, px, py, area) {
  const text = [plot.mode_a, known(plot.mode_c_ft) ? flightLevel(plot.mode_c_ft) : null].filter(known).join(" ") || "primary", flip = px + 12 + measure(text) > area.right, colour = plotColour(plot);
  return [plotSymbol(px, py, plot.kind, colour), svg("circle", { cx: px, cy: py, r: 8, fill: "none", stroke: colour }),
    label(px + (flip ? -12 : 12), py + 4, text, { class: "halo", "text-anchor": flip ? "end" : "start", style: `fill: ${colour}` })];
}

const plotLines = (plot) => [`${plot.kind} plot, t = ${seconds(plot.t)}`, `${miles(plot.range_m / METRE_PER_NM)}, ${fixed(plot.azimuth_deg, 1)}°`,
  plot.mode_a && `Mode A ${plot.mode_a}`, known(plot.mode_c_ft) && `Mode C ${feet(plot.mode_c_ft)}`, plot.actor && `of ${plot.actor}`].filter(Boolean);

/** How often each actor was detected, of how many turns of the antenna. */
function detectionTable(radar) {
  const heads = [["Actor"], ...["Turns", "Detected", "Primary", "Replies", "Both"].map((name) => [name, "number"])];
  return fillTable(html("table"), heads, radar.detected.map(({ actor, turns, primary, secondary, combined }) => {
    const all = primary + secondary + combined;
    return [coloured(actor), whole(turns), all ? `${whole(all)} (${percent(Math.min(all / Math.max(turns, 1), 1))})` : "never", ...[primary, secondary, combined].map(whole)];
  }));
}

function figure(radar, number) {
  const kind = radar.kind === "terminal" ? "terminal radar" : "en-route radar", example = (type, text) => keyItem(plotSymbol(10, 7, type, "var(--ink)"), text);
  return html("div", { class: "radar" },
    html("figure", { class: "panel" }, html("figcaption", {}, `${words(radar.site)} `, html("span", {}, `${kind}, one turn in ${seconds(radar.rotation_s)}`)), html("div", { id: `radar-${number}` }),
      html("ul", { class: "key" }, example("primary", "primary plot"), example("secondary", "Mode A/C reply"), example("combined", "both"),
        dim("colours tell the actor, which the radar does not know; a plot without Mode C lies at its slant range", "li"))),
    html("div", { class: "panel scroll", tabindex: 0, role: "region", "aria-label": `Actors detected by radar ${radar.site}` }, detectionTable(radar)));
}

byId("radar").hidden = !data.length;
byId("radars").append(...data.map(figure));
return {
  fit() {
    const shown = data.map((radar, i) => drawRadar(radar, byId(`radar-${i}`), i));
    return (t) => shown.forEach((show) => show(t));
  },
};
