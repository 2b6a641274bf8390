/** The outcome of the run: its tone, a word and a sentence. */
function outcome() {
  const until = run.phase === "finished" ? "" : ` Up to ${seconds(run.end_s)}, where the run ${run.phase === "stopped" ? "was stopped" : "breaks off"}.`;
  const is = (name, phase) => (summary ? summary[name] : happened(phase));
  const say = (tone, word, text) => ({ tone, word, text: text + until });
  const collided = conflictPhases.find((event) => event.phase === "collision");
  if (is("collision", "collision")) return say("bad", "Collision", `${collided ? list(collided.actors) : "Two actors"} touched.`);
  if (is("nmac", "nmac")) return say("bad", "Near mid-air collision", "Two aircraft came closer than 500 ft horizontally and 100 ft vertically.");
  if (SEVERE.includes(worst)) return say("bad", `Runway incursion, ${CATEGORIES[worst][0]}`, `${capital(CATEGORIES[worst][1])}.`);
  if (is("loss_of_separation", "loss_of_separation")) return say("bad", "Separation lost", `Less than ${minimumNm} NM and ${feet(minimumFt)} apart at once, tolerance deducted.`);
  if (incursions.length && !worst) return say("warn", "Runway incursion", "How severe it was is not known.");
  if (incursions.length && !happened("opened")) return say("warn", `Runway incursion, ${CATEGORIES[worst][0]}`, `${capital(CATEGORIES[worst][1])}.`);
  if (!run.has_conflict) return say("good", "Nominal", closeUp ? "The scenario has no conflict, and there was no runway incursion." : "The scenario has no conflict, and separation was kept.");
  if (!happened("opened")) return say("dim", "No conflict", "The conflict window never opened.");
  if (run.phase !== "finished") return say("warn", "Separation kept so far", "The conflict window opened.");
  if (incursions.length) return say("good", "Avoided", `The conflict window opened. The runway incursion stayed at ${CATEGORIES[worst][0]}: ${CATEGORIES[worst][1]}.`);
  return say("good", "Avoided", closeUp ? "The conflict window opened, and nobody got in the other’s way on a runway." : "The conflict window opened, and separation was kept.");
}

/** The latency source that was asked for; without one, that of each stage. */
const latencySource = (() => {
  const sources = Object.entries(summary?.latency_sources ?? {}), isOne = new Set(sources.map(([, source]) => source)).size === 1;
  return run.options.latency || (isOne ? sources[0][1] : sources.map((stage) => stage.join(" ")).join(", ") || "default");
})();

const { scenario, options } = run, { tone, word, text } = outcome(), note = (...texts) => html("p", { class: "note" }, texts.join(""));
document.title = `${scenario.name || run.run}, seed ${options.seed}: AIRHILT`;
const facts = [["Scenario", scenario.name], ["Family", scenario.family], airport && ["Airport", airport.icao], ["Seed", options.seed], ["Assistant", options.assistant], ["Latency", latencySource], ["Simulated", seconds(run.end_s)]].filter(Boolean);
byId("facts").append(...facts.map(([name, value]) => html("li", {}, `${name} `, html("b", {}, String(value)))));
fill(byId("outcome"), { class: `outcome ${tone}` }, [html("b", {}, word), html("span", {}, text)]);
const statesOf = (state) => run.events.filter((event) => event.kind === "status" && event.state === state), because = ({ text: why }) => (why ? `: ${why}` : "");
byId("notes").append(
  ...statesOf("lost").map((event) => html("p", { class: "note loud", role: "alert" }, `${event.who} was lost at ${seconds(event.t)}${because(event)}`)),
  ...statesOf("not evaluated").map((event) => note(event.who, " is not evaluated", because(event))),
  ...(summary?.unassisted_as_declared === false ? [note("Nobody was warned, and yet the outcome that the scenario declares did not come about: this run is no baseline.")] : []),
  ...run.notes.map((text) => note(text)));

// What it takes to run it again.
const reproducible = run.unregistered ? "by `airhilt replay` only: a program took part that takes no time grants"
  : latencySource.includes("measured") ? "by `airhilt replay` only: latencies were measured on this machine" : "yes: scenario, seed and latency source give the same bytes again";
const workers = data.workers.map((worker) => `${worker.name} (${worker.modality}, ${worker.where})`).join("; ") || "none";
const about = [["run", run.run], ["phase", run.cause ? `${run.phase}: ${run.cause}` : run.phase], ["latency source", latencySource], ["reproducible", reproducible], ["pace", options.pace], ["workers", workers],
  ...(summary ? [["real-time factor", `${fixed(summary.real_time_factor, 1)}, ${seconds(summary.cpu_s, 2)} of CPU`]] : []), ...data.about];
byId("about").append(...about.flatMap(([name, value]) => [html("dt", {}, name), html("dd", {}, value)]));
