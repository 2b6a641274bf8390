const HEADS = [["Time (s)"], ["Severity"], ["To"], ["What and why", "text"], ["Says it rests on", "text"], ["Calls, cameras, tracks", "text"], ["Time to go", "number"]];
const restsOn = ({ sources, shares }) => sources.map((name) => (known(shares[name]) ? `${name} ${fixed(100 * shares[name], 0)} %` : name)).join(", ");
const basis = (what, names) => names.length > 0 && html("div", {}, `${what}: ${names.join(", ")}`);

byId("evidence").hidden = !data.length;
fillTable(byId("evidence-table"), HEADS, data.map((row) => ({ t: row.t, cells: [
  timeButton(row.t), severityText(row.severity), row.recipients.join(", "), [html("div", {}, row.note), dim([row.id, ...row.rules].join(", "), "div")],
  restsOn(row), [basis("calls", row.radio), basis("cameras", row.cameras), basis("tracks", row.tracks), basis("not so (unknown, not delivered by then, or of others)", row.unfounded)], ifKnown(row.time_to_go_s, seconds),
] })));
