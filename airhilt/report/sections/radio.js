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
  const nodes = words.flatMap((one) => (one.kind === "equal" ? [one.heard] : [one.said && html("del", {}, one.said), one.heard && html("ins", {}, one.heard)])).filter(Boolean);
  return html("div", {}, nodes.length ? nodes.flatMap((node) => [node, " "]) : dim("no words", "span"));
}

function callRows(call, oneFrequency, oneRatio) {
  const noise = oneRatio ? "" : decibels(call.snr_db), tag = (is, tone, text) => is && [html("span", { class: `tag ${tone}` }, text), " "];
  const tags = [tag(call.blocked_by.length > 0, "bad", "blocked"), tag(!call.received, "warn", "not received")].filter(Boolean);
  const who = [html("div", {}, call.who), call.addressed && dim(`to ${call.addressed}`, "div"), !oneFrequency && dim(megahertz(call.frequency_khz), "div")];
  const said = [html("div", {}, call.said || dim("a carrier without words", "span")), (noise || tags.length > 0) && html("div", {}, tags.flat(), dim(noise, "span"))];
  const heard = call.hearings.map((one) => html("div", { class: HEARD[one.outcome][1] }, `${one.who} ${HEARD[one.outcome][0]}${one.outcome === "misheard" ? `: “${one.text}”` : ""}`));
  const [first = [[], [], []], ...others] = call.transcripts.map((one) => [[recognised(one.words), engines.length > 1 && dim(one.engine, "div")], html("div", {}, fixed(one.confidence, 2)), html("div", {}, duration(one.after_end_s))]);
  const complete = [html("div", {}, timeButton(call.from)), who, said, ...first, heard, player(call.sound, `the call at ${seconds(call.from)}`, call.from, call.to)];
  return [complete, ...others.map((result) => [[], [], [], ...result, [], []])].map((cells) => ({ t: call.from, cells }));
}
const engines = [...new Set(data.calls.flatMap((call) => call.transcripts.map((one) => one.engine)))];

function radioTiles() {
  const r = summary.radio, late = summary.latencies.asr_after_end;
  const also = [[r.blocked, "blocked", "blocked"], [r.stuck_microphone, "stuck microphone"], [r.repeats, "made again", "made again"], [r.say_agains, "to say again", "to say again"], [r.transcripts_missing || 0, "without a transcript", "without a transcript"]]
    .filter(([n]) => n).map(([n, one, many]) => counted(n, one, many));
  const heard = Object.keys(HEARD).filter((outcome) => r.hearing[outcome]).map((outcome) => `${r.hearing[outcome]} ${outcome}`).join(", ");
  const calls = tile("Transmissions", whole(r.transmissions), also.join(", "), heard ? `by their addressees: ${heard}` : "", r.blocked || r.stuck_microphone ? "warn" : "");
  if (!r.calls && !known(r.hallucinated)) return [calls];
  const noise = known(r.hallucinated) ? `, noise alone gave words ${counted(r.hallucinated, "time")}` : "";
  return [calls,
    tile("Word error rate", percent(r.wer), known(r.snr_db) ? `at ${decibels(r.snr_db)}` : "", `${counted(r.words, "word")} in ${counted(r.calls, "call")}, by ${list(engines)}${noise}`),
    tile("Callsigns and slots right", percent(r.callsign_accuracy), known(r.slot_accuracy) ? `${percent(r.slot_accuracy)} of slots` : "no slot was said", `callsigns of the roster; ${counted(r.false_slots || 0, "slot")} not said`),
    tile("Transcript after the end", duration(late && late.p95_s), late && late.n ? `median ${duration(late.p50_s)}` : "", "95th percentile, from the end of a call"),
  ];
}

function drawRadio() {
  const { calls, advisories } = data, levels = summary ? summary.radio.by_snr : [];
  byId("radio").hidden = !calls.length && !advisories.length;
  byId("spoken-advisories").hidden = !advisories.length;
  byId("radio-legend").hidden = !engines.length;
  if (summary) byId("radio-tiles").append(...radioTiles());
  byId("radio-snr").parentElement.hidden = !levels.length;
  fillTable(byId("radio-snr"), [["SNR"], ...["Calls", "Word error rate", "Callsigns", "Slots", "False slots"].map((name) => [name, "number"])],
    levels.map((level) => [decibels(level.snr_db), whole(level.calls), percent(level.wer), percent(level.callsign_accuracy), percent(level.slot_accuracy), whole(level.false_slots || 0)]));
  const isOne = (name) => new Set(calls.map((call) => call[name])).size === 1;
  fillTable(byId("calls"), [["Time (s)", "number"], ["From"], ["Said", "text"], ["Recognised", "text"], ["Confidence", "number"], ["After end", "number"], ["Heard"], ["Sound"]],
    calls.flatMap((call) => callRows(call, isOne("frequency_khz"), isOne("snr_db"))), { always: 3 });
  fillTable(byId("spoken"), [["Time (s)", "number"], ["To"], ["Said", "text"], ["After decision", "number"], ["Sound"]],
    advisories.map((one) => ({ t: one.from, cells: [...[timeButton(one.from), one.recipient, one.said, duration(one.after_decision_s)].map((text) => html("div", {}, text)), player(one.sound, `the advisory at ${seconds(one.from)}`, one.from, one.to)] })));
  const tables = ["calls", "spoken"].map((id) => [...byId(id).tBodies[0].rows]), players = [...document.querySelectorAll("audio")];
  for (const one of players) one.addEventListener("play", () => players.forEach((other) => { if (other !== one && !one.dataset.follows) other.pause(); }));
  return (t) => {
    for (const one of players) followMedia(one, Number(one.dataset.from), Math.min(Number(one.dataset.to), Number(one.dataset.from) + (one.duration || Infinity)), t, clock.sound);
    tables.forEach((rows) => markCurrent(rows, t));
  };
}

return { draw: drawRadio };
