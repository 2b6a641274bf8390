const HEADS = [["Time (s)"], ["Severity"], ["To"], ["What and why", "text"], ["Rests on", "text"], ["Calls, cameras, tracks", "text"], ["Time to go", "number"]];
const restsOn = (row) => row.sources.map((name) => (known(row.shares[name]) ? `${name} ${fixed(100 * row.shares[name], 0)} %` : name)).join(", ");
const basis = (row) => [["calls", row.radio], ["cameras", row.cameras], ["tracks", row.tracks]].filter(([, names]) => names.length)
  .map(([what, names]) => html("div", {}, `${what}: ${names.join(", ")}`));

function drawEvidence() {
  byId("evidence").hidden = !data.length;
  fillTable(byId("evidence-table"), HEADS, data.map((row) => ({ t: row.t, cells: [
    timeButton(row.t), html("span", { class: `severity-${row.severity}` }, row.severity), row.recipients.join(", "),
    [html("div", {}, row.note), html("div", { class: "dim" }, [row.id, ...row.rules].join(", "))],
    restsOn(row), basis(row), known(row.time_to_go_s) ? seconds(row.time_to_go_s) : "",
  ] })));
}

return { draw: drawEvidence };
