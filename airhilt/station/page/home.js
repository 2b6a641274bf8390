// The first page: choose a scenario, its seats and conditions, start the run, open what is there.

import { button, byId, html, offer, on, onSubmit } from "./dom.js";
import { onThisHost } from "./neighbours.js";
import { Rows } from "./rows.js";
import { ask, found, lost, note } from "./server.js";
import { connectTheme } from "./theme.js";
import { whole } from "./words.js";

const PERIOD_MS = 1000;
const NOTHING_STARTED =
  "Nothing was started yet. A run takes some seconds to get ready; then a link to its page is here.";
const NOTHING_RECORDED = "There is no run here yet. A run is listed here from its beginning on.";
const WHEN = { dateStyle: "short", timeStyle: "short" };
const SEATS_HINT = "Tick a seat to speak and act there yourself. Without one you watch the run.";
const STATES = { starting: "is being started", running: "goes on", ended: "has ended" };

let scenarios = [],
  recorded = [],
  told = "";
const chosen = new Set(),
  started = new Rows(byId("started"));

// --- a new run -----------------------------------------------------------------------------------

function showScenario() {
  const scenario = scenarios.find((one) => one.id === byId("scenario").value);
  if (!scenario) return;
  byId("start").disabled = Boolean(scenario.problem);
  byId("scenario-text").textContent =
    scenario.problem ?? `${scenario.description} ${whole(scenario.duration_s)} s at most.`;
  const seats = (scenario.seats ?? []).map((seat) =>
    html(
      "label",
      html("input", { type: "checkbox", name: "seat", value: seat }),
      seat === scenario.controller ? `${seat} (controller)` : seat,
    ),
  );
  const hint = seats.length
    ? html("p.hint", SEATS_HINT)
    : html("span.dim", "This scenario has no radio: it can be watched.");
  byId("seats").replaceChildren(html("legend", "Seats for people"), ...seats, hint);
  byId("cameras").disabled = !scenario.has_cameras;
  byId("snr").placeholder =
    scenario.snr_db === null ? "no noise" : `${scenario.snr_db}, as in the scenario`;
  byId("visibility").placeholder = `${whole(scenario.visibility_m ?? 0)}, as in the scenario`;
  for (const box of byId("equipment").querySelectorAll("input"))
    box.disabled = box.checked = (scenario.equipment ?? []).includes(box.value);
  showCameras();
  showAsked();
}

/** Questions can be asked, and voices recorded, where somebody sits. */
function showAsked() {
  byId("asked").disabled = !byId("seats").querySelector("input:checked");
}

function showCameras() {
  byId("visibility").disabled = byId("cameras").disabled || !byId("cameras").checked;
}

/** The options of the form that can be filled in; what is not given is undefined. */
function optionsChosen() {
  const form = new FormData(byId("new")),
    given = (name) => form.get(name) || undefined,
    number = (name) => given(name) && Number(given(name)),
    ticked = (name) => (form.has(name) ? form.getAll(name) : undefined),
    // The options of a run have what the boxes begin with.
    unlessCleared = (id) => (byId(id).matches(":enabled:not(:checked)") ? false : undefined);
  return {
    seed: number("seed"),
    assistant: given("assistant"),
    seat: ticked("seat"),
    isa_minutes: number("isa_minutes"),
    nasa_tlx: form.has("nasa_tlx") || undefined,
    voice_recording: unlessCleared("voice-recording"),
    radar: given("radar"),
    crews: given("crews"),
    equipment: ticked("equipment"),
    snr_db: number("snr_db"),
    visibility_m: number("visibility_m"),
    cameras: unlessCleared("cameras"),
    speech: unlessCleared("speech"),
  };
}

async function start() {
  byId("start").disabled = true;
  byId("start-state").textContent = "Starting ...";
  try {
    const { name } = await ask("api/runs", {
      scenario: byId("scenario").value,
      options: optionsChosen(),
    });
    byId("start-state").textContent = `${name} is being started.`;
    note("");
    await showRuns();
  } catch (error) {
    byId("start-state").textContent = "";
    note(`The run was not started: ${error.message}`);
  } finally {
    byId("start").disabled = false;
  }
}

// --- what is there -------------------------------------------------------------------------------

function startedRow(run) {
  const parts = [html("span.who", run.name), html("span", STATES[run.state])],
    link = { class: "open", href: run.url && onThisHost(run.url) };
  if (run.url) parts.push(html("a", link, run.seats.length ? "Open and take a seat" : "Watch"));
  if (run.state !== "ended")
    parts.push(button("Stop", () => stop(run.name), { "aria-label": `Stop ${run.name}` }));
  const said =
    run.state === "running" ? run.seats.map((seat) => `seat ${seat}`).join(", ") : run.said;
  return html("li", html("div.row-head", ...parts), html("div.heard", said));
}

const stop = (name) =>
  ask(`api/runs/${encodeURIComponent(name)}/stop`, {}).catch((error) => note(error.message));

async function open(pressed, runs) {
  pressed.disabled = true;
  byId("compare-state").textContent = "Reading ...";
  try {
    location.href = (await ask("api/debriefs", { runs })).url;
  } catch (error) {
    note(`The debrief was not opened: ${error.message}`);
  } finally {
    pressed.disabled = false;
    byId("compare-state").textContent = "";
  }
}

function recordedRow(run) {
  const box = html("input", {
    type: "checkbox",
    "aria-label": `Choose ${run.name} to compare`,
    checked: chosen.has(run.name),
  });
  box.addEventListener("change", () => {
    if (box.checked) chosen.add(run.name);
    else chosen.delete(run.name);
    showChosen();
  });
  const name = html("th", { scope: "row" }, run.name),
    cell = (content, attributes = {}) => html("td", attributes, content),
    begun = run.started_at && new Date(run.started_at).toLocaleString([], WHEN),
    act = ({ target }) => open(target, [run.name]);
  return html(
    "tr",
    cell(box),
    name,
    cell(begun, { class: "when" }),
    [run.assistant, run.seats.join(", "), run.phase].map((text) => cell(text)),
    cell(button("Debrief", act, { "aria-label": `Debrief of ${run.name}` })),
  );
}

function showRecorded() {
  const wanted = byId("find").value.trim().toLowerCase(),
    listed = recorded.filter((run) => run.name.toLowerCase().includes(wanted)),
    empty = recorded.length ? "No run has this in its name." : NOTHING_RECORDED,
    nothing = html("tr", html("td", { colspan: 7, class: "dim" }, empty));
  const rows = listed.length ? listed.map(recordedRow) : [nothing];
  byId("recorded").tBodies[0].replaceChildren(...rows);
}

function showChosen() {
  byId("compare").disabled = chosen.size !== 2;
  byId("compare").textContent =
    chosen.size === 2 ? "Compare the two chosen" : `Compare two (${chosen.size} chosen)`;
}

async function showRuns() {
  const runs = await ask("api/runs"),
    text = JSON.stringify(runs);
  if (text === told) return;
  started.show(runs.started, (run) => run.name, startedRow, NOTHING_STARTED);
  if (byId("recorded").contains(document.activeElement)) return; // The list is renewed when the focus has left it.
  told = text;
  recorded = runs.recorded;
  for (const name of chosen) if (!recorded.some((run) => run.name === name)) chosen.delete(name);
  showRecorded();
  showChosen();
}

async function follow() {
  try {
    await showRuns();
    found();
  } catch {
    lost(
      "The station does not answer. Runs that were started go on. Start `airhilt station` again.",
    );
  }
  setTimeout(follow, PERIOD_MS);
}

async function begin() {
  connectTheme(() => {});
  const station = await ask("api/station");
  scenarios = station.scenarios;
  byId("subtitle").textContent = `Runs are in ${station.folder}`;
  byId("subtitle").title = station.folder;
  offer(
    byId("scenario"),
    scenarios.map(({ id, title }) => [id, `${id}: ${title}`]),
  );
  offer(byId("assistant"), station.assistants, "reference");
  on("scenario", "change", showScenario);
  on("cameras", "change", showCameras);
  on("seats", "change", showAsked);
  on("find", "input", showRecorded);
  on("compare", "click", () =>
    open(
      byId("compare"),
      recorded.map((run) => run.name).filter((name) => chosen.has(name)),
    ),
  );
  onSubmit(byId("new"), start);
  showScenario();
  await follow();
  document.body.dataset.ready = "true";
}

begin().catch((error) => note(`The page cannot be shown: ${error.message}`));
