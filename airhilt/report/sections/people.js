const SEATS = [["Seat"], ["Calls spoken", "number"], ["Calls typed", "number"], ["Commands", "number"], ["Asked to say again", "number"], ["Button to air", "number"], ["Reaction time (median)", "number"]];
const REACTIONS = [["Time (s)"], ["Seat"], ["Severity"], ["Advised", "text"], ["Seen", "number"], ["Heard", "number"], ["First action", "text"], ["Reaction time", "number"], ["Followed", "text"]];
const since = (row, t) => (known(t) ? seconds(t - row.t_advisory_s, 2) : "no");

function drawPeople() {
  byId("people").hidden = !data.length;
  fillTable(byId("people-table"), SEATS, data.map((one) => ({ cells: [
    one.seat, one.spoken_calls, one.typed_calls, one.commands, one.asked_to_say_again,
    known(one.press_to_transmit_s) ? seconds(one.press_to_transmit_s, 3) : "", known(one.reaction_time_s) ? seconds(one.reaction_time_s, 2) : "",
  ] })));
  const rows = data.flatMap((one) => one.reactions.map((row) => ({ seat: one.seat, ...row }))).sort((a, b) => a.t_advisory_s - b.t_advisory_s);
  fillTable(byId("reactions-table"), REACTIONS, rows.map((row) => ({ t: row.t_advisory_s, cells: [
    timeButton(row.t_advisory_s), row.seat, html("span", { class: `severity-${row.severity}` }, row.severity), words(row.advised ?? ""),
    since(row, row.t_seen_s), since(row, row.t_heard_s), words(row.first_action ?? "none"),
    known(row.reaction_time_s) ? seconds(row.reaction_time_s, 2) : "", known(row.followed) ? (row.followed ? "yes" : "no") : "",
  ] })));
}

return { draw: drawPeople };
