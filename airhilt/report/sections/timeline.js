const shown = new Set(Object.keys(KINDS)), events = [...run.events].sort((a, b) => a.t - b.t), byKind = Map.groupBy(events, kindOf);
// Without speech a transcript is the call itself again.
if (events.every((event) => event.kind !== "transcript" || event.engine === "text")) shown.delete("transcript");
const rows = [...fillTable(byId("timeline"), [["Time (s)", "number"], ["Kind", "kind"], ["Who"], ["What", "text"]], events.map((event) => {
  const kind = kindOf(event), severe = event.kind === "advisory" ? kind : kind === "worker_lost" || event.state === "lost" ? "WARNING" : kind === "failure" || kind === "unable" ? "CAUTION" : "INFO";
  const advice = event.recommendation && dim(`Recommended: ${instruction(event.recommendation)}`, "div");
  return { t: event.t, cells: [timeButton(event.t), html("span", { class: `severity-${severe}` }, KINDS[kind]), whoOf(event), [textOf(event), advice]] };
}), { empty: "The log has no events." }).tBodies[0].rows];
const filter = () => events.forEach((event, i) => { rows[i].hidden = !shown.has(kindOf(event)); });
byId("filters").append(...Object.keys(KINDS).filter((kind) => byKind.has(kind)).map((kind) => {
  const button = html("button", { type: "button", "aria-pressed": shown.has(kind) }, `${KINDS[kind]} ${byKind.get(kind).length}`);
  button.addEventListener("click", () => {
    if (!shown.delete(kind)) shown.add(kind);
    button.ariaPressed = shown.has(kind);
    filter();
  });
  return button;
}));
filter();
return { draw: () => (t) => markCurrent(rows, t) };
