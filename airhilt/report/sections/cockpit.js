const INSTRUMENTS = [
  ["Airspeed (kt)", (state) => whole(state.airspeed_kt)], ["Mach", (state) => fixed(state.mach, 2)], ["Altitude (ft)", (state) => whole(state.altitude_ft)],
  ["V/S (ft/min)", (state) => whole(state.vertical_speed_fpm)], ["Heading (°)", (state) => bearing(state.heading_deg).slice(0, -1)], ["Track (°)", (state) => bearing(state.track_deg).slice(0, -1)],
  ["GS (kt)", (state) => whole(state.ground_speed_kt)], ["Selected (ft)", (state) => whole(state.selected_altitude_ft)], ["Mode", (state) => words(state.mode)],
];

function drawCockpits() {
  byId("cockpit").hidden = !data.length;
  const kind = (name) => (name === "Mode" ? "kind" : "number");
  const cells = data.map(() => INSTRUMENTS.map(([name]) => html("td", { class: kind(name) })));
  byId("instruments").replaceChildren(html("thead", {}, html("tr", {}, html("th", { scope: "col" }, "Aircraft"), ...INSTRUMENTS.map(([name]) => html("th", { scope: "col", class: kind(name) }, name)))),
    html("tbody", {}, ...data.map(({ callsign }, i) => html("tr", {}, html("th", { scope: "row", style: `color: ${colourOf(callsign)}` }, callsign), ...cells[i]))));
  return (t) => data.forEach(({ states }, i) => {
    const state = states[before(states.map((one) => one.t), t)];
    INSTRUMENTS.forEach(([, read], k) => { cells[i][k].textContent = read(state); });
  });
}

return { draw: drawCockpits };
