/** Stages in words: name, and from when to when each is measured. */
const STAGES = {
  adsb: ["ADS-B", "t_adsb_out − t_adsb_in: a squitter reached the receiver, until its report was given out"],
  asr: ["ASR", "t_asr − t_tx: the start of a call, until its transcript"],
  asr_after_end: ["ASR after the end", "t_asr − t_end: the end of a call, until its transcript"],
  vision: ["Vision", "t_vision − t_frame: the end of an exposure, until its detections"],
  decision: ["Decision", "t_dec − t_ready: the last input that an advisory rests on, until the advisory"],
  tts: ["TTS", "t_tts − t_dec: an advisory, until its audio"],
};

function drawLatencies() {
  const stages = Object.entries(summary ? summary.latencies : {});
  const rowsOf = stages.map(([stage, figures]) => {
    const worker = stage.endsWith("_step") ? stage.slice(0, -5) : null;
    const [name, meaning] = STAGES[stage] || (worker ? [`Step of ${worker}`, `an input reached the worker ${worker}, until its result was due, waiting included`] : [stage, ""]);
    return html("tr", {}, html("td", { class: "text" }, html("b", {}, name), html("div", { class: "dim" }, meaning)), html("td", { class: "number" }, whole(figures.n)),
      ...["p50_s", "p95_s", "max_s"].map((figure) => html("td", { class: "number" }, duration(figures[figure]))));
  });
  byId("latencies").append(...(rowsOf.length ? rowsOf : [html("tr", {}, html("td", { colspan: 5 }, "There is no summary.json to take them from."))]));
  const dropped = Object.entries(summary ? summary.inputs_dropped : {});
  byId("dropped").textContent = !summary ? "" : dropped.length ? `Inputs dropped: ${dropped.map(([name, n]) => `${name} ${n}`).join(", ")}` : "Inputs dropped: none.";
}

function drawHistogram() {
  const holder = byId("histogram"), workers = data;
  if (!workers.length) { holder.replaceChildren(html("p", { class: "dim" }, "No worker finished a step.")); return; }
  const rowHeight = 74, chart = canvas(holder, workers.length * rowHeight + 44, "Histogram of latencies by worker"), { root, width } = chart;
  const area = { left: 16, right: width - 24, top: 0, bottom: workers.length * rowHeight };
  const edges = workers.flatMap(({ bins }) => bins.flatMap((bin) => [bin.from_s, bin.to_s]));
  let low = Math.floor(Math.log10(Math.min(...edges)) + 1e-3), high = Math.ceil(Math.log10(Math.max(...edges)) - 1e-3);
  while (high - low < 3) { if (high < 0) high += 1; else low -= 1; }
  const x = scale(low, high, area.left, area.right);
  x.ticks = ticks(low, high, 1);
  x.format = (decade) => (10 ** decade >= 1 ? `${10 ** decade} s` : 10 ** decade >= 9e-4 ? `${Math.round(10 ** decade * 1e3)} ms` : `${Math.round(10 ** decade * 1e6)} µs`);
  bottomAxis(root, area, x);
  root.append(nameBelow(area, "Latency (logarithmic); height: share of the worker's steps", 36));
  workers.forEach((worker, i) => drawBars(root, worker, x, i * rowHeight, rowHeight, area, `var(--c${i % MOST_COLOURED})`));
}

function drawBars(root, worker, x, top, height, area, colour) {
  const most = Math.max(...worker.bins.map((bin) => bin.n)), base = top + height - 6, tall = height - 32;
  root.append(svg("line", { class: "frame", x1: area.left, x2: area.right, y1: base, y2: base }));
  for (const bin of worker.bins) {
    const left = x(Math.log10(bin.from_s)), right = x(Math.log10(bin.to_s)), h = Math.max(bin.n / most * tall, 1.5);
    const bar = svg("rect", { x: left, y: base - h, width: Math.max(right - left - 1, 1.5), height: h, style: `fill: ${colour}` });
    bar.addEventListener("pointermove", (event) => showTip(event, [worker.worker, `${duration(bin.from_s)} to ${duration(bin.to_s)}`, `${whole(bin.n)} of ${whole(worker.n)} steps`]));
    bar.addEventListener("pointerleave", hideTip);
    root.append(bar);
  }
  root.append(svg("text", { class: "halo bold", x: area.left + 2, y: top + 16 }, worker.worker), svg("text", { class: "halo unit", x: area.left + 8 + measure(worker.worker, true), y: top + 16 }, `${whole(worker.n)} steps`));
}

return { draw: drawLatencies, fit: drawHistogram };
