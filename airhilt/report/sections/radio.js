/** What became of a call with a listener, in words. */
const HEARD = { understood: ["understood", ""], misheard: ["took it for something else", "bad"], unsure: ["was not sure", "warn"], missed: ["missed it", "warn"] };
/** An element that plays a sound, or a link to its file. */
function player(sound, name, from, to) {
  if (!sound) return null;
  if (sound.href) return html("a", { href: sound.href, "aria-label": `Sound of ${name}` }, "sound file");
  return html("audio", { controls: "", preload: "none", src: sound.src, "data-from": from, "data-to": to, "aria-label": `Sound of ${name}` });
}

/** The words recognised: those struck out were said and not recognised, those marked were recognised and not said. */
function recognised(words) {
  const nodes = words.flatMap((one) => (one.kind === "equal" ? [one.heard] : [one.said ? html("del", {}, one.said) : null, one.heard ? html("ins", {}, one.heard) : null]))
    .filter((node) => node !== null);
  return html("div", {}, ...(nodes.length ? nodes.flatMap((node) => [node, " "]) : [html("span", { class: "dim" }, "no words")]));
}

function callRows(call, oneFrequency, oneRatio) {
  const noise = oneRatio ? "" : decibels(call.snr_db), tags = [
    ...(call.blocked_by.length ? [html("span", { class: "tag bad" }, "blocked")] : []),
    ...(call.received ? [] : [html("span", { class: "tag warn" }, "not received")]),
  ];
  const who = [html("div", {}, call.who), call.addressed ? html("div", { class: "dim" }, `to ${call.addressed}`) : null, oneFrequency ? null : html("div", { class: "dim" }, megahertz(call.frequency_khz))];
  const said = [html("div", {}, call.said || html("span", { class: "dim" }, "a carrier without words")), noise || tags.length ? html("div", {}, ...tags.flatMap((tag) => [tag, " "]), html("span", { class: "dim" }, noise)) : null];
  const heard = call.hearings.map((one) => html("div", { class: HEARD[one.outcome][1] }, `${one.who} ${HEARD[one.outcome][0]}${one.outcome === "misheard" ? `: “${one.text}”` : ""}`));
  const first = (transcript) => [html("div", {}, timeButton(call.from)), who, said, ...(transcript || [[], [], []]), heard, player(call.sound, `the call at ${seconds(call.from)}`, call.from, call.to)];
  const results = call.transcripts.map((one) => [[recognised(one.words), engines.length > 1 ? html("div", { class: "dim" }, one.engine) : null], html("div", {}, fixed(one.confidence, 2)), html("div", {}, duration(one.after_end_s))]);
  return [first(results[0]), ...results.slice(1).map((result) => [[], [], [], ...result, [], []])].map((cells) => ({ t: call.from, cells }));
}
const engines = [...new Set(data.calls.flatMap((call) => call.transcripts.map((one) => one.engine)))];

function radioTiles() {
  const r = summary.radio, late = summary.latencies.asr_after_end;
  const also = [[r.blocked, "blocked", "blocked"], [r.stuck_microphone, "stuck microphone"], [r.repeats, "made again", "made again"], [r.say_agains, "to say again", "to say again"], [r.transcripts_missing || 0, "without a transcript", "without a transcript"]]
    .filter(([n]) => n).map(([n, one, many]) => counted(n, one, many));
  const heard = Object.keys(HEARD).filter((outcome) => r.hearing[outcome]).map((outcome) => `${r.hearing[outcome]} ${outcome}`).join(", ");
  const calls = tile("Transmissions", whole(r.transmissions), also.join(", "), heard ? `by those whom they were for: ${heard}` : "", r.blocked || r.stuck_microphone ? "warn" : "");
  if (!r.calls && !known(r.hallucinated)) return [calls];
  const noise = known(r.hallucinated) ? `, noise alone gave words ${counted(r.hallucinated, "time")}` : "";
  return [calls,
    tile("Word error rate", percent(r.wer), known(r.snr_db) ? `at ${decibels(r.snr_db)}` : "", `${counted(r.words, "word")} in ${counted(r.calls, "call")}, by ${list(engines)}${noise}`),
    tile("Callsigns and slots right", percent(r.callsign_accuracy), known(r.slot_accuracy) ? `${percent(r.slot_accuracy)} of slots` : "no slot was said", `callsigns of the roster; ${counted(r.false_slots || 0, "slot")} not said`),
    tile("Transcript after the end", duration(late && late.p95_s), late && late.n ? `median ${duration(late.p50_s)}` : "", "95th percentile, from the end of a call"),
  ];
}

function drawSnr() {
  const levels = summary ? summary.radio.by_snr : [];
  byId("radio-snr").hidden = !levels.length;
  const heads = [["SNR", ""], ["Calls", "number"], ["Word error rate", "number"], ["Callsigns", "number"], ["Slots", "number"], ["False slots", "number"]];
  byId("radio-snr").replaceChildren(plainTable(heads, levels.map((level) => [decibels(level.snr_db), whole(level.calls), percent(level.wer), percent(level.callsign_accuracy), percent(level.slot_accuracy), whole(level.false_slots || 0)])));
}

function drawRadio() {
  const { calls: said, advisories: spokenAdvisories } = data;
  byId("radio").hidden = !said.length && !spokenAdvisories.length;
  byId("spoken-advisories").hidden = !spokenAdvisories.length;
  if (summary) byId("radio-tiles").append(...radioTiles());
  drawSnr();
  const heads = [["Time (s)", "number"], ["From", ""], ["Said", "text"], ["Recognised", "text"], ["Confidence", "number"], ["After end", "number"], ["Heard", ""], ["Sound", ""]];
  const oneOf = (name) => new Set(said.map((call) => call[name])).size === 1;
  const found = said.flatMap((call) => callRows(call, oneOf("frequency_khz"), oneOf("snr_db")));
  const wanted = heads.map(([name], i) => i < 3 || found.some(({ cells }) => [cells[i]].flat().some(known)));
  const table = fillTable(byId("calls"), heads.filter((_, i) => wanted[i]), found.map(({ t, cells }) => ({ t, cells: cells.filter((_, i) => wanted[i]) })));
  byId("radio-legend").replaceChildren(...(engines.length ? ["In what was recognised, ", html("span", { class: "calls" }, html("del", {}, "words struck out"), " were said and not recognised, ", html("ins", {}, "words marked"), " were recognised and not said.")] : []));
  const spoken = fillTable(byId("spoken"), [["Time (s)", "number"], ["To", ""], ["Said", "text"], ["After decision", "number"], ["Sound", ""]],
    spokenAdvisories.map((one) => ({ t: one.from, cells: [html("div", {}, timeButton(one.from)), html("div", {}, one.recipient), html("div", {}, one.said), html("div", {}, duration(one.after_decision_s)), player(one.sound, `the advisory at ${seconds(one.from)}`, one.from, one.to)] })));
  const players = [...document.querySelectorAll("audio")];
  for (const one of players) one.addEventListener("play", () => players.forEach((other) => { if (other !== one && !one.dataset.follows) other.pause(); }));
  return (t) => {
    for (const one of players) followMedia(one, Number(one.dataset.from), Math.min(Number(one.dataset.to), Number(one.dataset.from) + (one.duration || Infinity)), t, clock.sound);
    showRows(t);
  };

  function showRows(t) { [table, spoken].forEach((all) => {
    const current = all.findLast((row) => Number(row.dataset.t) <= t + 1e-6);
    all.forEach((row) => row.classList.toggle("current", row === current));
  }); }
}

return { draw: drawRadio };
