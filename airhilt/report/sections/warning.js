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

function swatch(part) {
  const mark = html("span", { class: "swatch" });
  mark.style.background = colour(part);
  return mark;
}

function drawTable() {
  if (!parts) return;
  byId("warning").hidden = false;
  const row = (name, meaning, value, ...key) => html("tr", {}, html("td", { class: "text" }, ...key, html("b", {}, name), html("div", { class: "dim" }, meaning)), html("td", { class: "number" }, seconds(value, 2)));
  const after = summary.time_to_first_warning_after_call_s;
  byId("warning-parts").append(...Object.entries(PARTS).map(([part, [name, meaning]]) => row(name, meaning, parts[part], swatch(part))),
    row("Time to first warning", "from the begin of the conflict; negative: warned before it", summary.time_to_first_warning_s),
    ...(known(after) ? [row("After the call", "from the end of the call that begins the conflict", after)] : []));
  byId("warning-begins").textContent = data.begins ? `begins with ${data.begins}, at ${seconds(summary.t_conflict_s)}` : "";
}

function drawBar() {
  if (!parts) return;
  const { root, width } = canvas(byId("warning-bar"), 96, "Parts of the time to first warning"), area = { left: 16, right: width - 16, top: 12, bottom: 48 };
  const spans = Object.keys(PARTS).map((part) => ({ part, value: parts[part], colour: colour(part) }));
  const low = Math.min(...spans.map(({ value }) => value), 0), high = spans.reduce((sum, { value }) => sum + Math.max(value, 0), 0);
  const x = scale(low, Math.max(high, low + 1), area.left, area.right);
  x.ticks = ticks(low, high, niceTimeStep(Math.max(high - low, 1), 8));
  x.format = (value) => seconds(value);
  bottomAxis(root, area, x);
  let from = 0;
  for (const { part, value, colour } of spans) {
    const begin = value < 0 ? value : from, end = value < 0 ? 0 : from + value;
    const bar = svg("rect", { class: "part", x: x(begin), y: area.top, width: Math.max(x(end) - x(begin), 0), height: area.bottom - area.top, style: `fill: ${colour}` });
    bar.addEventListener("pointermove", (event) => showTip(event, [PARTS[part][0], seconds(value, 2), PARTS[part][1]]));
    bar.addEventListener("pointerleave", hideTip);
    root.append(bar);
    if (value > 0) from += value;
  }
  root.append(nameBelow(area, "Parts added up from the begin of the conflict, in the order of the table", 38));
}

return { draw: drawTable, fit: drawBar };
