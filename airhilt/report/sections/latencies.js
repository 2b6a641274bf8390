/** Stages in words: name, and from when to when each is measured. */
const STAGES = {
  adsb: ["ADS-B", "t_adsb_out − t_adsb_in: a squitter reached the receiver, until its report was given out"],
  asr: ["ASR", "t_asr − t_tx: the start of a call, until its transcript"],
  asr_after_end: ["ASR after the end", "t_asr − t_end: the end of a call, until its transcript"],
  vision: ["Vision", "t_vision − t_frame: the end of an exposure, until its detections"],
  decision: ["Decision", "t_dec − t_ready: the last input that an advisory rests on, until the advisory"],
  tts: ["TTS", "t_tts − t_dec: an advisory, until its audio"],
};

function drawHistogram() {
  const holder = byId("histogram"), ROW_PX = 74;
  if (!data.length) return holder.replaceChildren(dim("No worker finished a step."));
  const chart = canvas(holder, data.length * ROW_PX + 44, "Histogram of latencies by worker"), { root, width } = chart;
  const area = { left: 16, right: width - 24, top: 0, bottom: data.length * ROW_PX };
  const edges = data.flatMap(({ bins }) => bins.flatMap((bin) => [bin.from_s, bin.to_s]));
  let low = Math.floor(Math.log10(Math.min(...edges)) + 1e-3), high = Math.ceil(Math.log10(Math.max(...edges)) - 1e-3);
  while (high - low < 3) { if (high < 0) high += 1; else low -= 1; }
  const x = scale(low, high, area.left, area.right, 1, (decade) => (10 ** decade >= 1 ? `${10 ** decade} s` : 10 ** decade >= 9e-4 ? `${Math.round(10 ** decade * 1e3)} ms` : `${Math.round(10 ** decade * 1e6)} µs`));
  bottomAxis(root, area, x, "Latency (logarithmic); height: share of the worker's steps");
  data.forEach(({ worker, n, bins }, i) => {
    const most = Math.max(...bins.map((bin) => bin.n)), top = i * ROW_PX, base = top + ROW_PX - 6;
    root.append(line(area.left, base, area.right, base, { class: "frame" }), ...bins.map((bin) => {
      const left = x(Math.log10(bin.from_s)), width = Math.max(x(Math.log10(bin.to_s)) - left - 1, 1.5), height = Math.max(bin.n / most * (ROW_PX - 32), 1.5);
      const bar = svg("rect", { x: left, y: base - height, width, height, style: `fill: var(--c${i % MOST_COLOURED})` });
      return sayAt(bar, [worker, `${duration(bin.from_s)} to ${duration(bin.to_s)}`, `${whole(bin.n)} of ${whole(n)} steps`]);
    }));
    root.append(label(area.left + 2, top + 16, worker, { class: "halo bold", "text-anchor": "start" }),
      label(area.left + 8 + measure(worker, true), top + 16, `${whole(n)} steps`, { class: "halo unit", "text-anchor": "start" }));
  });
  return null;
}

const rows = Object.entries(summary ? summary.latencies : {}).map(([stage, { n, p50_s, p95_s, max_s }]) => {
  const worker = stage.replace(/_step$/, "");
  const [name, meaning] = STAGES[stage] || (worker !== stage ? [`Step of ${worker}`, `an input reached the worker ${worker}, until its result was due, waiting included`] : [stage, ""]);
  return [explained(name, meaning), whole(n), duration(p50_s), duration(p95_s), duration(max_s)];
});
fillTable(byId("latencies"), [["Stage", "text"], ...["n", "p50", "p95", "max"].map((name) => [name, "number"])], rows, { empty: "There is no summary.json to take them from." });
const dropped = summary && Object.entries(summary.inputs_dropped).map(([name, n]) => `${name} ${n}`).join(", ");
const missed = summary && Object.entries(summary.steps_missed || {}).map(([name, n]) => `${name} ${n}`).join(", ");
byId("dropped").textContent = summary ? `Inputs dropped: ${dropped || "none."}${missed ? ` Steps without a result: ${missed}.` : ""}` : "";
return { fit: drawHistogram };
