const COLUMNS = [
  ["Airspeed (kt)", "number", (state) => whole(state.airspeed_kt)], ["Mach", "number", (state) => fixed(state.mach, 2)], ["Altitude (ft)", "number", (state) => whole(state.altitude_ft)],
  ["V/S (ft/min)", "number", (state) => whole(state.vertical_speed_fpm)], ["Heading (°)", "number", (state) => bearing(state.heading_deg).slice(0, -1)], ["Track (°)", "number", (state) => bearing(state.track_deg).slice(0, -1)],
  ["GS (kt)", "number", (state) => whole(state.ground_speed_kt)], ["Selected (ft)", "number", (state) => whole(state.selected_altitude_ft)], ["Mode", "kind", (state) => words(state.mode)],
];

byId("cockpit").hidden = !data.length;
const showStates = fillStates(byId("instruments"), [["Aircraft", "row"]], COLUMNS, data.map(({ callsign, states }) => {
  const times = states.map(({ t }) => t);
  return { cells: [coloured(callsign, "span")], at: (t) => states[before(times, t)] };
}));

return { draw: () => showStates };
