function numberTiles() {
  const s = summary, time = (value) => (known(value) ? seconds(value, 2) : "–");
  const unwarned = !run.has_conflict ? "no conflict is annotated" : known(s.t_first_warning_s) ? "does not apply to this run" : "there was no warning of the conflict";
  const isEarly = known(s.time_to_first_warning_s) && s.time_to_first_warning_s < 0;
  const least = (name, value, text, other, minimum) => (known(value)
    ? tile(name, text(value), `${whole(value)} m`, `least while less than the ${other} minimum apart`, value < minimum && s.loss_of_separation ? "bad" : "")
    : tile(name, "–", "", `never less than the ${other} minimum apart`));
  const margin = (name, value) => tile(name, time(value), "", known(value)
    ? `first warning ${value < 0 ? "after" : "before"} TCAS II would have spoken, had nobody reacted` : unwarned, known(value) && value < 0 ? "bad" : "");
  const warnings = [
    tile("Time to first warning", time(s.time_to_first_warning_s), "", known(s.time_to_first_warning_s)
      ? `conflict began at ${seconds(s.t_conflict_s)}, warned at ${seconds(s.t_first_warning_s)}${isEarly ? ", before it began" : ""}` : unwarned),
    tile("Lead before closest approach", time(s.lead_before_closest_approach_s), "", known(s.lead_before_closest_approach_s) ? "from the first warning" : unwarned),
  ];
  const nearest = closest ? tile("Closest approach", `${distance(closest.horizontal_m)}, ${feet(closest.vertical_m / METRE_PER_FT)}`, closeUp ? "" : `${whole(closest.horizontal_m)} m, ${whole(closest.vertical_m)} m`,
    `at ${seconds(closest.t_s)}, nearest in three dimensions${closeUp ? ", between centres" : ""}`) : tile("Closest approach", "–", "", "no pair was followed");
  const nuisance = tile("Nuisance alerts", String(s.nuisance_alerts ?? "–"), "", known(s.nuisance_alerts) ? "of CAUTION or above, about traffic in no conflict" : "not counted: cameras left exposures out", s.nuisance_alerts ? "warn" : "");
  if (closeUp) return [incursionTile(), ...outcomeTiles(), ...warnings, nearest, failuresTile(), nuisance, ...staleTile()];
  return [...warnings, margin("Margin over TCAS TA", s.margin_over_tcas_ta_s), margin("Margin over TCAS RA", s.margin_over_tcas_ra_s),
    least("Least horizontal separation", s.min_horizontal_separation_m, (value) => miles(value / METRE_PER_NM), "vertical", minimumNm * METRE_PER_NM),
    least("Least vertical separation", s.min_vertical_separation_m, (value) => feet(value / METRE_PER_FT), "horizontal", minimumFt * METRE_PER_FT),
    nearest, nuisance, ...staleTile(), ...(failures.length ? [failuresTile()] : [])];
}

function incursionTile() {
  if (!worst) return tile("Runway incursion", "none", "", "nobody was in the way of a takeoff or landing", "good");
  const first = incursions.find((incursion) => incursion.category === worst);
  const near = known(first.closest_m) && worst !== "accident" ? `, ${metres(first.closest_m)} between the outlines` : "";
  const others = incursions.length > 1 ? `; ${incursions.length - 1} more` : "";
  return tile("Runway incursion", CATEGORIES[worst][0], `${first.intruder} on ${first.runway}${first.user ? `, in the way of ${first.user}` : ""}${others}`,
    `${worst === "accident" ? "" : "FAA: "}${CATEGORIES[worst][1]}${near}`, SEVERE.includes(worst) ? "bad" : "warn");
}

function outcomeTiles() {
  const event = conflictPhases.find((candidate) => candidate.phase === "collision");
  return [
    tile("Collision", summary.collision ? "yes" : "no", "", summary.collision ? (event ? `${list(event.actors)}, at ${seconds(event.t)}` : "") : "no outlines touched", summary.collision ? "bad" : "good"),
    tile("Conflict avoided", known(summary.avoided) ? (summary.avoided ? "yes" : "no") : "–", "", known(summary.avoided)
      ? (known(summary.t_window_s) ? `the conflict window opened at ${seconds(summary.t_window_s)}` : "a warning came before the conflict window opened")
      : "the conflict window never opened, and nobody was warned", summary.avoided ? "good" : known(summary.avoided) ? "bad" : ""),
  ];
}

function staleTile() {
  const worst = Object.entries(summary.evidence ?? {}).sort(([, a], [, b]) => b.stale_share - a.stale_share)[0];
  if (!worst || worst[1].stale_share < 0.01) return [];
  const [modality, age] = worst;
  return [tile("Stale evidence", whole(100 * age.stale_share), "% of the time", `newest evidence of ${modality} above 5 s old, up to ${whole(age.max_s)} s`, "warn")];
}

function failuresTile() {
  const unable = run.events.filter((event) => event.kind === "unable").length;
  const why = failures.map((event) => `${event.line ? `${event.who}: ` : `${event.who} `}${event.text}`).join("; ") || "everything went as it should";
  return tile("Failures injected", String(failures.length), unable ? `${unable} instruction${unable > 1 ? "s" : ""} that could not be followed` : "", why);
}

function modalityTile() {
  const items = Object.entries(data.modalities).map(([name, state]) => html("li", { class: state }, `${name}: `, html("b", {}, state === "lost" ? "LOST" : state)));
  return html("article", { class: "tile panel wide" }, html("h3", {}, "Modalities"), html("ul", { class: "chips" }, items));
}

byId("tiles").append(...(summary ? numberTiles() : []), modalityTile());
