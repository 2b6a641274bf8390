const SEATS = [["Seat"], ["Calls spoken", "number"], ["Calls typed", "number"], ["Commands", "number"], ["Asked to say again", "number"], ["Readback errors", "number"], ["Readback errors heard", "number"], ["Button to air", "number"], ["Button to another loudspeaker", "number"], ["Reaction time (median)", "number"], ["First warning to button", "number"], ["Advisories not perceived", "number"]];
const REACTIONS = [["Time (s)"], ["Seat"], ["Severity"], ["Advised", "text"], ["Seen", "number"], ["Heard", "number"], ["First action", "text"], ["Reaction time, from", "number"], ["Followed"]];
const CALLS = [["Time (s)"], ["Seat"], ["Call"], ["Frequency", "number"], ["Said", "text"], ["Recognised", "text"], ["Confidence", "number"], ["To the air", "number"], ["To another loudspeaker", "number"], ["Heard at seats", "number"], ["Length", "number"], ["Blocked"], ["Answered after", "number"]];
const WORKLOAD = [["Seat"], ["ISA (mean of 1 to 5)", "number"], ["ISA", "text"], ["Raw TLX (0 to 100)", "number"], ["NASA-TLX", "text"]];
const since = (row, t) => (known(t) ? seconds(t - row.t_advisory_s, 2) : "no");

/** Fills a table and leaves out columns without any value; without rows, the table and its title are left out. */
function fill(name, heads, rows) {
  const table = byId(name), used = heads.map((_, i) => rows.some(({ cells }) => cells[i] !== ""));
  const kept = (all) => all.filter((_, i) => used[i]);
  table.closest("#people > div").hidden = !rows.length;
  fillTable(table, kept(heads), rows.map(({ t, cells }) => ({ t, cells: kept(cells) })));
}

function drawPeople() {
  byId("people").hidden = !data.length;
  fill("people-table", SEATS, data.map((one) => ({ cells: [
    one.seat, one.spoken_calls, one.typed_calls, one.commands, one.asked_to_say_again, one.readback_errors, one.readback_errors_heard,
    known(one.press_to_transmit_s) ? seconds(one.press_to_transmit_s, 3) : "", known(one.press_to_loudspeaker_s) ? seconds(one.press_to_loudspeaker_s, 2) : "", known(one.reaction_time_s) ? seconds(one.reaction_time_s, 2) : "", known(one.warning_to_press_s) ? seconds(one.warning_to_press_s, 2) : "", one.unperceived ?? 0,
  ] })));
  const rows = data.flatMap((one) => one.reactions.map((row) => ({ seat: one.seat, ...row }))).sort((a, b) => a.t_advisory_s - b.t_advisory_s);
  fill("reactions-table", REACTIONS, rows.map((row) => ({ t: row.t_advisory_s, cells: [
    timeButton(row.t_advisory_s), row.seat, html("span", { class: `severity-${row.severity}` }, row.severity), words(row.advised ?? ""),
    since(row, row.t_seen_s), since(row, row.t_heard_s), words(row.first_action ?? "none"),
    known(row.reaction_time_s) ? `${seconds(row.reaction_time_s, 2)}, ${row.counted_from}` : row.is_shared ? "shared" : row.is_real_time === false ? "not in real time" : "", known(row.followed) ? (row.followed ? "yes" : "no") : "",
  ] })));
  const calls = data.flatMap((one) => (one.calls ?? []).map((row) => ({ seat: one.seat, ...row }))).sort((a, b) => a.t_s - b.t_s);
  const some = (value, text) => (known(value) ? text(value) : "");
  fill("people-calls-table", CALLS, calls.map((row) => ({ t: row.t_s, cells: [
    timeButton(row.t_s), row.seat, row.way, some(row.frequency_khz, megahertz), row.said ?? "", row.recognised ?? "", some(row.confidence, percent),
    some(row.to_air_s, (value) => seconds(value, 3)), some(row.to_loudspeaker_s, (value) => seconds(value, 2)), row.heard_at ?? "", some(row.length_s, seconds), known(row.blocked) ? (row.blocked ? "yes" : "no") : "never on the air",
    some(row.answered_after_s, seconds),
  ] })));
  const asked = data.filter((one) => one.workload);
  fill("workload-table", WORKLOAD, asked.map(({ seat, workload }) => ({ cells: [
    seat, known(workload.isa_mean) ? fixed(workload.isa_mean, 1) : "", workload.isa.map((one) => `${fixed(one.t_s, 0)} s: ${one.rating ?? "no answer"}`).join(", "),
    known(workload.raw_tlx) ? fixed(workload.raw_tlx, 1) : "", workload.nasa_tlx ? Object.entries(workload.nasa_tlx).map(([name, rating]) => `${words(name)} ${rating}`).join(", ") : "",
  ] })));
}

return { draw: drawPeople };
