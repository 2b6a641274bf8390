const SEATS = [["Seat"], ["Calls spoken", "number"], ["Calls typed", "number"], ["Commands", "number"], ["Asked to say again", "number"], ["Readback errors", "number"], ["Readback errors heard", "number"], ["Button to air", "number"], ["Button to another loudspeaker", "number"], ["Reaction time (median)", "number"], ["First warning to button", "number"], ["Advisories not perceived", "number"]];
const REACTIONS = [["Time (s)"], ["Seat"], ["Severity"], ["Advised", "text"], ["Seen", "number"], ["Heard", "number"], ["First action", "text"], ["Reaction time, from", "number"], ["Followed"]];
const CALLS = [["Time (s)"], ["Seat"], ["Call"], ["Frequency", "number"], ["Said", "text"], ["Recognised", "text"], ["Confidence", "number"], ["To the air", "number"], ["To another loudspeaker", "number"], ["Heard at seats", "number"], ["Length", "number"], ["Blocked"], ["Answered after", "number"]];
const WORKLOAD = [["Seat"], ["ISA (mean of 1 to 5)", "number"], ["ISA", "text"], ["Raw TLX (0 to 100)", "number"], ["NASA-TLX", "text"]];
const since = (row, t) => (known(t) ? seconds(t - row.t_advisory_s, 2) : "no");
const short = (value) => ifKnown(value, (time) => seconds(time, 2)), precise = (value) => ifKnown(value, (time) => seconds(time, 3));
const yesOrNo = (value, unknown = "") => (known(value) ? (value ? "yes" : "no") : unknown);
const allOf = (name, time) => data.flatMap((one) => (one[name] ?? []).map((row) => ({ seat: one.seat, ...row }))).sort((a, b) => a[time] - b[time]);

/** Fills a table of people; without rows, the table and its title are left out. */
function fillPeople(id, heads, rows) {
  byId(id).closest("#people > div").hidden = !rows.length;
  fillTable(byId(id), heads, rows, { always: 0 });
}

byId("people").hidden = !data.length;
fillPeople("people-table", SEATS, data.map((one) => [
  one.seat, one.spoken_calls, one.typed_calls, one.commands, one.asked_to_say_again, one.readback_errors, one.readback_errors_heard,
  precise(one.press_to_transmit_s), short(one.press_to_loudspeaker_s), short(one.reaction_time_s), short(one.warning_to_press_s), one.unperceived ?? 0,
]));
fillPeople("reactions-table", REACTIONS, allOf("reactions", "t_advisory_s").map((row) => ({ t: row.t_advisory_s, cells: [
  timeButton(row.t_advisory_s), row.seat, severityText(row.severity), words(row.advised ?? ""), since(row, row.t_seen_s), since(row, row.t_heard_s), words(row.first_action ?? "none"),
  known(row.reaction_time_s) ? `${short(row.reaction_time_s)}, ${row.counted_from}` : row.is_shared ? "shared" : row.is_real_time === false ? "not in real time" : "", yesOrNo(row.followed),
] })));
fillPeople("people-calls-table", CALLS, allOf("calls", "t_s").map((row) => ({ t: row.t_s, cells: [
  timeButton(row.t_s), row.seat, row.way, ifKnown(row.frequency_khz, megahertz), row.said ?? "", row.recognised ?? "", ifKnown(row.confidence, percent), precise(row.to_air_s), short(row.to_loudspeaker_s),
  row.heard_at ?? "", ifKnown(row.length_s, seconds), yesOrNo(row.blocked, "never on the air"), ifKnown(row.answered_after_s, seconds),
] })));
fillPeople("workload-table", WORKLOAD, data.filter((one) => one.workload).map(({ seat, workload: { isa_mean, isa, raw_tlx, nasa_tlx } }) => [
  seat, ifKnown(isa_mean, (mean) => fixed(mean, 1)), isa.map((one) => `${fixed(one.t_s, 0)} s: ${one.rating ?? "no answer"}`).join(", "),
  ifKnown(raw_tlx, (mean) => fixed(mean, 1)), Object.entries(nasa_tlx ?? {}).map(([name, rating]) => `${words(name)} ${rating}`).join(", "),
]));
