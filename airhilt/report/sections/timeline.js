function drawTimeline() {
  const shown = new Set(Object.keys(KINDS)), counts = {}, events = [...run.events].sort((a, b) => a.t - b.t);
  for (const event of events) counts[kindOf(event)] = (counts[kindOf(event)] || 0) + 1;
  // Without speech a transcript is the call itself again.
  if (events.every((event) => event.kind !== "transcript" || event.engine === "text")) shown.delete("transcript");
  const list = events.map((event) => {
    const kind = kindOf(event), severe = event.kind === "advisory" ? `severity-${kind}` : kind === "worker_lost" || event.state === "lost" ? "severity-WARNING" : kind === "failure" || kind === "unable" ? "severity-CAUTION" : "";
    const advice = event.recommendation ? html("div", { class: "dim" }, `Recommended: ${instruction(event.recommendation)}`) : null;
    const row = html("tr", { "data-t": event.t }, html("td", { class: "number" }, html("button", { type: "button", "aria-label": `Show ${fixed(event.t, 1)} seconds` }, fixed(event.t, 1))),
      html("td", { class: `kind ${severe}` }, KINDS[kind]), html("td", {}, whoOf(event)), html("td", { class: "text" }, textOf(event), advice));
    row.addEventListener("click", () => clock.set(event.t));
    return { event, kind, row };
  });
  const filter = () => list.forEach(({ kind, row }) => { row.hidden = !shown.has(kind); });
  for (const [kind, name] of Object.entries(KINDS)) {
    if (!counts[kind]) continue;
    const button = html("button", { type: "button", "aria-pressed": shown.has(kind) }, `${name} ${counts[kind]}`);
    button.addEventListener("click", () => {
      if (!shown.delete(kind)) shown.add(kind);
      button.setAttribute("aria-pressed", shown.has(kind));
      filter();
    });
    byId("filters").append(button);
  }
  byId("timeline").append(...(list.length ? list.map(({ row }) => row) : [html("tr", {}, html("td", { colspan: 4 }, "The log has no events."))]));
  filter();
  let current = null;
  return (t) => {
    const latest = list.findLast(({ event, kind }) => event.t <= t + 1e-6 && shown.has(kind));
    if (current) current.row.classList.remove("current");
    if (latest) latest.row.classList.add("current");
    current = latest;
  };
}

return { draw: drawTimeline };
