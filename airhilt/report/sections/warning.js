/** Parts of the time to first warning: name, and from when to when. */
const PARTS = {
  speech_s: ["Speech", "the call that the warning rests on was still being said"],
  recognition_s: ["Recognition", "the end of that call, until its transcript"],
  evidence_s: ["Evidence", "waiting for that call to begin, or for other evidence; negative: complete before the conflict began"],
  decision_s: ["Decision", "t_dec − t_ready: the evidence was complete, until the advisory"],
  voice_s: ["Voice", "from t_dec to t_tts: the advisory, until it is heard"],
};
const parts = summary && summary.first_warning_parts;
const colour = (part) => `var(--c${Object.keys(PARTS).indexOf(part)})`;

if (!parts) return null;
byId("warning").hidden = false;
const after = summary.time_to_first_warning_after_call_s;
fillTable(byId("warning-parts"), [["Part", "text"], ["Time", "number"]], [
  ...Object.entries(PARTS).map(([part, [name, meaning]]) => [[swatch(colour(part)), ...explained(name, meaning)], seconds(parts[part], 2)]),
  [explained("Time to first warning", "from the beginning of the conflict; negative: warned before it"), seconds(summary.time_to_first_warning_s, 2)],
  ...(known(after) ? [[explained("After the call", "from the end of the call that begins the conflict"), seconds(after, 2)]] : [])]);
byId("warning-begins").textContent = data.begins ? `begins with ${data.begins}, at ${seconds(summary.t_conflict_s)}` : "";

function drawBar() {
  const { root, width } = canvas(byId("warning-bar"), 96, "Parts of the time to first warning"), area = { left: 16, right: width - 16, top: 12, bottom: 48 };
  const values = Object.keys(PARTS).map((part) => parts[part]);
  const low = Math.min(...values, 0), high = values.reduce((sum, value) => sum + Math.max(value, 0), 0);
  const x = scale(low, Math.max(high, low + 1), area.left, area.right, niceTimeStep(Math.max(high - low, 1), 8), (value) => seconds(value));
  bottomAxis(root, area, x, "Parts added up from the beginning of the conflict, in the order of the table");
  let from = 0;
  for (const [part, [name, meaning]] of Object.entries(PARTS)) {
    const value = parts[part], begin = value < 0 ? value : from, end = value < 0 ? 0 : from + value;
    root.append(sayAt(areaRect({ ...area, left: x(begin), right: x(end) }, { class: "part", style: `fill: ${colour(part)}` }), [name, seconds(value, 2), meaning]));
    from += Math.max(value, 0);
  }
}

return { fit: drawBar };
