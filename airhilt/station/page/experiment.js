// The page of a participant: what is to be done now, and the questions after a trial.

import { byId, html } from "./dom.js";
import { connectTheme } from "./theme.js";
import { Tlx } from "./tlx.js";

const PERIOD_MS = 1000;
const tlx = new Tlx();

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

function textOf({ step, seat, said, rest_s: rest, may_pause: mayPause }) {
  switch (step) {
    case "ready":
      return rest > 0
        ? `Take a break. The next trial can begin in ${Math.ceil(rest / 60)} min.`
        : `${said} When you are ready, begin. A link to your seat, ${seat}, will appear here.`.trim();
    case "starting":
      return "The trial is being prepared. That takes some seconds.";
    case "running":
      return `Open the page of your seat, and take the seat ${seat}: the trial begins then, and not before. ${mayPause ? "" : "It cannot be paused. "}When it is over, come back to this page.`;
    case "questions":
      return "";
    default:
      return "That was the last trial. Thank you.";
  }
}

function show(state) {
  const { step, trial, trials, url, rest_s: rest } = state;
  byId("title").textContent = `Experiment, ${state.participant}`;
  byId("step").textContent =
    step === "done"
      ? "All trials are done"
      : step === "questions"
        ? `Questions after trial ${trial} of ${trials}`
        : `Trial ${trial} of ${trials}`;
  byId("step-text").textContent = textOf(state);
  byId("begin").hidden = step !== "ready";
  byId("begin").disabled = rest > 0;
  byId("open").hidden = step !== "running";
  byId("open").href = url || "#";
  if (byId("tlx").hidden && step === "questions") tlx.begin();
  byId("tlx").hidden = step !== "questions";
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
  const { missing } = tlx;
  if (missing.length) note(`Please move or click every slider: ${missing.join(", ")}.`);
  else act("api/answers", tlx.answers);
}

async function follow() {
  try {
    show(await ask("api/experiment"));
    if (byId("notes").dataset.lost) {
      delete byId("notes").dataset.lost;
      note("");
    }
  } catch {
    byId("notes").dataset.lost = "true";
    note("The experiment does not answer. Please tell the experimenter.");
  }
  document.body.dataset.ready = "true";
  setTimeout(follow, PERIOD_MS);
}

connectTheme(() => {});
byId("begin").addEventListener("click", () => act("api/begin", {}));
byId("tlx").addEventListener("submit", (event) => {
  event.preventDefault();
  answer();
});
follow();
