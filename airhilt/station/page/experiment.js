// The page of a participant: what is to be done now, and the questions after a trial.

import { byId, html } from "./dom.js";
import { connectTheme } from "./theme.js";

const PERIOD_MS = 1000;
/** Scales of NASA-TLX: name in the answers, name on the page, question, and both ends (Hart & Staveland 1988). */
const SCALES = [
  ["mental_demand", "Mental demand", "How mentally demanding was the task?", "Very low", "Very high"],
  ["physical_demand", "Physical demand", "How physically demanding was the task?", "Very low", "Very high"],
  ["temporal_demand", "Temporal demand", "How hurried or rushed was the pace of the task?", "Very low", "Very high"],
  ["performance", "Performance", "How successful were you in doing what you were asked to do?", "Perfect", "Failure"],
  ["effort", "Effort", "How hard did you have to work to reach your level of performance?", "Very low", "Very high"],
  ["frustration", "Frustration", "How insecure, discouraged, irritated, stressed and annoyed were you?", "Very low", "Very high"],
];
const touched = new Set();

async function ask(path, wish) {
  const how = wish === undefined ? {} : { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(wish) };
  const answer = await fetch(path, how), content = await answer.json();
  if (!answer.ok) throw new Error(content.error ?? `the server answers ${answer.status}`);
  return content;
}

const note = (text) => byId("notes").replaceChildren(...(text ? [html("p", {}, text)] : []));

function textOf({ step, seat, said, rest_s: rest }) {
  switch (step) {
    case "ready": return rest > 0 ? `Take a break. The next trial can begin in ${Math.ceil(rest / 60)} min.` : `${said} When you are ready, begin. A link to your seat, ${seat}, will appear here.`.trim();
    case "starting": return "The trial is being prepared. That takes some seconds.";
    case "running": return `Open the page of your seat, and take the seat ${seat}. When the trial is over, come back to this page.`;
    case "questions": return "";
    default: return "That was the last trial. Thank you.";
  }
}

function show(state) {
  const { step, trial, trials, url, rest_s: rest } = state;
  byId("title").textContent = `Experiment, ${state.participant}`;
  byId("step").textContent = step === "done" ? "All trials are done" : step === "questions" ? `Questions after trial ${trial} of ${trials}` : `Trial ${trial} of ${trials}`;
  byId("step-text").textContent = textOf(state);
  byId("begin").hidden = step !== "ready";
  byId("begin").disabled = rest > 0;
  byId("open").hidden = step !== "running";
  byId("open").href = url || "#";
  if (byId("tlx").hidden && step === "questions") byId("scales").replaceChildren(...SCALES.map(scale));
  byId("tlx").hidden = step !== "questions";
}

function scale([id, name, question, low, high]) {
  touched.delete(id);
  const input = html("input", { type: "range", min: 0, max: 100, step: 5, value: 50, id: `tlx-${id}`, "aria-label": `${name}. ${question}` });
  for (const event of ["input", "click"]) input.addEventListener(event, () => touched.add(id));
  return html("label", { class: "scale" }, html("span", { class: "name" }, html("strong", {}, name), ` ${question}`), html("span", { class: "end" }, low), input, html("span", { class: "end" }, high));
}

async function act(path, wish) {
  try {
    show(await ask(path, wish));
    note("");
  } catch (error) {
    note(error.message);
  }
}

function answer() {
  const missing = SCALES.filter(([id]) => !touched.has(id));
  if (missing.length) { note(`Please move or click every slider: ${missing.map(([, name]) => name).join(", ")}.`); return; }
  act("api/answers", Object.fromEntries(SCALES.map(([id]) => [id, Number(byId(`tlx-${id}`).value)])));
}

async function follow() {
  try {
    show(await ask("api/experiment"));
    if (byId("notes").dataset.lost) { delete byId("notes").dataset.lost; note(""); }
  } catch {
    byId("notes").dataset.lost = "true";
    note("The experiment does not answer. Please tell the experimenter.");
  }
  document.body.dataset.ready = "true";
  setTimeout(follow, PERIOD_MS);
}

connectTheme(() => {});
byId("begin").addEventListener("click", () => act("api/begin", {}));
byId("tlx").addEventListener("submit", (event) => { event.preventDefault(); answer(); });
follow();
