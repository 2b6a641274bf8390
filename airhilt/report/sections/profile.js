/** Altitudes of the pair and of those within 5,000 ft of it, and the tracks outside of these. */
function altitudeRange() {
  const ranges = tracks.map((track) => ({ track, ...lowAndHigh(track.altitude_ft) }));
  const core = ranges.filter(({ track }) => isPair(track)), from = core.length ? core : ranges, near = 5000;
  const low = Math.min(...from.map((range) => range.low)), high = Math.max(...from.map((range) => range.high));
  const shown = ranges.filter((range) => range.high > low - near && range.low < high + near);
  return {
    low: Math.max(Math.min(...shown.map((range) => range.low)), low - near),
    high: Math.min(Math.max(...shown.map((range) => range.high)), high + near),
    outside: ranges.filter((range) => !shown.includes(range)).map(({ track }) => track),
  };
}
function drawProfile() {
  const holder = byId("profile");
  if (!tracks.length) return holder.replaceChildren(dim("The log has no track."));
  const chart = canvas(holder, 310, "Altitude against time"), { root, width } = chart;
  const { low, high, outside } = altitudeRange(), inside = tracks.filter((track) => !outside.includes(track));
  const labelled = inside.filter((track) => track.prominent);
  const margin = Math.max(...labelled.map((track) => measure(track.callsign, true)), 0) + 12;
  const area = { left: 70, right: width - margin, top: 12, bottom: 266 };
  const pad = airport ? Math.max((high - low) * 0.1, 40) : Math.max((high - low) * 0.14, (2000 - (high - low)) / 2, 250);
  const x = timeScale(area), y = valueScale(low - pad, high + pad, area, 6);
  if (airport) drawGround(root, area, y);
  drawWindow(root, x, area);
  axes(root, area, x, y, "Time (s)", "Altitude (ft)");
  const air = clip(root, "profile-clip", area);
  for (const track of [...inside].reverse()) {
    air.append(svg("path", { class: track.prominent ? "line" : "line faint", stroke: track.colour, d: path(track.t, track.altitude_ft, x, y) }));
  }
  byId("profile-outside").textContent = outside.length ? `Outside the altitudes drawn: ${outside.map((track) => track.callsign).join(", ")}` : "";
  labelEnds(root, labelled, y, area);
  const follow = followPointer(chart, area, x, (t) => [
    ...labelled.map((track) => `${track.callsign} ${feet(stateAt(track, t).altitude)}`),
    ...nearby([...advisories, ...reactions], t, area).slice(0, 4).map((event) => (event.kind === "advisory" ? `${event.severity} to ${event.who}: ${event.text}` : `${event.who} ${event.text}`)),
  ]);
  drawProfileMarks(root, x, y, area);
  return follow;
}

function drawGround(root, area, y) {
  root.append(areaRect({ ...area, top: Math.min(Math.max(y(airport.elevation_m / METRE_PER_FT), area.top), area.bottom) }, { fill: "var(--taxiway)" }));
}

function labelEnds(root, labelled, y, area) {
  const placed = spread(labelled.map((track) => y(track.altitude_ft.at(-1))), 15, area.top + 8, area.bottom - 4);
  root.append(...labelled.map((track, i) => label(area.right + 7, placed[i] + 4, track.callsign, { class: "bold", "text-anchor": "start", style: `fill: ${track.colour}` })));
}

function drawProfileMarks(root, x, y, area) {
  const yOf = (callsign, t) => {
    const track = trackOf(callsign);
    return track ? y(at(track.t, track.altitude_ft, t)) : area.top + 18;
  };
  const rank = (event) => SEVERITIES.indexOf(event.severity), active = advisories.filter((event) => event.active);
  for (const event of active.sort((a, b) => rank(a) - rank(b))) root.append(advisorySymbol(x(event.t), yOf(event.who, event.t) - 9, event.severity));
  for (const event of reactions) root.append(reactionSymbol(x(event.t), yOf(event.who, event.t) + 9));
}

fillKey("profile-key", SEVERITIES.filter((severity) => advisories.some((event) => event.active && event.severity === severity)).map((severity) => keyItem(advisorySymbol(10, 7, severity), severity)),
  reactions.length && keyItem(reactionSymbol(10, 7), "pilot reacts"), advisories.some((event) => !trackOf(event.who)) && dim("at the top: to ATC", "li"), windowKey());
return { fit: drawProfile };
