// The first page: choose a scenario, its seats and conditions, start the run, open what is there.

import { byId, html } from "./dom.js";
import { onThisHost } from "./neighbours.js";
import { Rows } from "./rows.js";
import { connectTheme } from "./theme.js";
import { whole } from "./words.js";

const PERIOD_MS = 1000;
const NOTHING_STARTED =
  "Nothing was started yet. A run takes some seconds to get ready; then a link to its page is here.";
const STATES = { starting: "is being started", running: "goes on", ended: "has ended" };

let scenarios = [],
  recorded = [],
  told = "";
const chosen = new Set(),
  started = new Rows(byId("started"));

/** Asks the server, and throws what it refuses in its words. */
async function ask(path, wish) {
  const how =
    wish === undefined
      ? {}
      : {
          method: "POST",
          headers: { "Content-Type": "application/json" },
          body: JSON.stringify(wish),
        };
  const answer = await fetch(path, how),
    content = await answer.json();
  if (!answer.ok) throw new Error(content.error ?? `the server answers ${answer.status}`);
  return content;
}

const note = (text) => byId("notes").replaceChildren(...(text ? [html("p", {}, text)] : []));

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
      {},
      html("input", { type: "checkbox", value: seat }),
      seat === scenario.controller ? `${seat} (controller)` : seat,
    ),
  );
  byId("seats").replaceChildren(
    html("legend", {}, "Seats for people"),
    ...(seats.length
      ? [
          ...seats,
          html(
            "p",
            { class: "hint" },
            "Tick a seat to speak and act there yourself. Without one you watch the run.",
          ),
        ]
      : [html("span", { class: "dim" }, "This scenario has no radio: it can be watched.")]),
  );
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

/** Values that are ticked in a group; those of the scenario itself cannot be. */
const ticked = (group) =>
  [...byId(group).querySelectorAll("input:checked:enabled")].map((one) => one.value);

function optionsChosen() {
  const options = { seed: Number(byId("seed").value), assistant: byId("assistant").value };
  const seats = ticked("seats"),
    equipment = ticked("equipment");
  if (seats.length) options.seat = seats;
  if (seats.length && byId("isa-minutes").value !== "")
    options.isa_minutes = Number(byId("isa-minutes").value);
  if (seats.length && byId("nasa-tlx").checked) options.nasa_tlx = true;
  if (seats.length && !byId("voice-recording").checked) options.voice_recording = false;
  if (byId("radar").value !== "") options.radar = byId("radar").value;
  if (equipment.length) options.equipment = equipment;
  if (byId("snr").value !== "") options.snr_db = Number(byId("snr").value);
  if (byId("visibility").value !== "" && !byId("visibility").disabled)
    options.visibility_m = Number(byId("visibility").value);
  if (!byId("cameras").checked) options.cameras = false;
  if (!byId("speech").checked) options.speech = false;
  return options;
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
  const parts = [html("span", { class: "who" }, run.name), html("span", {}, STATES[run.state])];
  if (run.url)
    parts.push(
      html(
        "a",
        { class: "open", href: onThisHost(run.url) },
        run.seats.length ? "Open and take a seat" : "Watch",
      ),
    );
  if (run.state !== "ended") {
    const stop = html("button", { type: "button", "aria-label": `Stop ${run.name}` }, "Stop");
    stop.addEventListener("click", async () => {
      try {
        await ask(`api/runs/${encodeURIComponent(run.name)}/stop`, {});
      } catch (error) {
        note(error.message);
      }
    });
    parts.push(stop);
  }
  const said =
    run.state === "running" ? run.seats.map((seat) => `seat ${seat}`).join(", ") : run.said;
  return html(
    "li",
    {},
    html("div", { class: "started-head" }, ...parts),
    html("div", { class: "heard" }, said),
  );
}

async function open(button, runs) {
  button.disabled = true;
  byId("compare-state").textContent = "Reading ...";
  try {
    location.href = onThisHost((await ask("api/debriefs", { runs })).url);
  } catch (error) {
    note(`The debrief was not opened: ${error.message}`);
  } finally {
    button.disabled = false;
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
  const button = html(
    "button",
    { type: "button", "aria-label": `Debrief of ${run.name}` },
    "Debrief",
  );
  button.addEventListener("click", () => open(button, [run.name]));
  return html(
    "tr",
    {},
    html("td", {}, box),
    html("th", { scope: "row" }, run.name),
    html(
      "td",
      { class: "when" },
      run.started_at
        ? new Date(run.started_at).toLocaleString([], { dateStyle: "short", timeStyle: "short" })
        : "",
    ),
    html("td", {}, run.assistant),
    html("td", {}, run.seats.join(", ")),
    html("td", {}, run.phase),
    html("td", {}, button),
  );
}

function showRecorded() {
  const wanted = byId("find").value.trim().toLowerCase(),
    found = recorded.filter((run) => run.name.toLowerCase().includes(wanted));
  const rows = found.length
    ? found.map(recordedRow)
    : [
        html(
          "tr",
          {},
          html(
            "td",
            { colspan: 7, class: "dim" },
            recorded.length
              ? "No run has this in its name."
              : "There is no run here yet. A run is listed here from its beginning on.",
          ),
        ),
      ];
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
    if (byId("notes").dataset.lost) {
      delete byId("notes").dataset.lost;
      note("");
    }
  } catch {
    byId("notes").dataset.lost = "true";
    note(
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
  byId("scenario").replaceChildren(
    ...scenarios.map((one) => html("option", { value: one.id }, `${one.id}: ${one.title}`)),
  );
  byId("assistant").replaceChildren(
    ...station.assistants.map((name) =>
      html("option", { value: name, selected: name === "reference" }, name),
    ),
  );
  byId("scenario").addEventListener("change", showScenario);
  byId("cameras").addEventListener("change", showCameras);
  byId("seats").addEventListener("change", showAsked);
  byId("find").addEventListener("input", showRecorded);
  byId("compare").addEventListener("click", () =>
    open(
      byId("compare"),
      recorded.map((run) => run.name).filter((name) => chosen.has(name)),
    ),
  );
  byId("new").addEventListener("submit", (event) => {
    event.preventDefault();
    start();
  });
  showScenario();
  await follow();
  document.body.dataset.ready = "true";
}

begin().catch((error) => note(`The page cannot be shown: ${error.message}`));
