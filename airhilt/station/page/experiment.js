// The page of a participant: what is to be done now, and the questions of the plan. Where several
// have seats together, the end of its address says whose page it is, such as #P01.

import { byId, html } from "./dom.js";
import { addressee, onThisHost } from "./neighbours.js";
import { Questionnaire } from "./questionnaire.js";
import { connectTheme } from "./theme.js";

const PERIOD_MS = 1000;
const questionnaire = new Questionnaire(byId("items"));
let shown = ""; // participant, trial and name of the questionnaire that is shown

async function ask(path, wish) {
  const how =
    wish === undefined
      ? {}
      : {
          method: "POST",
          headers: { "Content-Type": "application/json" },
          body: JSON.stringify(wish),
        };
  const of = `${path}?participant=${encodeURIComponent(addressee())}`;
  const answer = await fetch(of, how).catch(() => {
    throw new Error("The experiment does not answer.");
  });
  const content = await answer.json();
  if (!answer.ok) throw new Error(content.error ?? `the server answers ${answer.status}`);
  return content;
}

const note = (text) => byId("notes").replaceChildren(...(text ? [html("p", {}, text)] : []));

const afterTrial = ({ trial, trials }) => `Questions after trial ${trial} of ${trials}`;

/** Heading of each questionnaire, and what is said of it, by its name. */
const QUESTIONNAIRES = {
  before: [() => "Questions before the first trial", "Please answer each question."],
  nasa_tlx: [
    afterTrial,
    "How was the trial that you have just done? Click on each line where it fits.",
  ],
  after_trial: [afterTrial, "Please answer each question about the trial that you have just done."],
  end: [() => "Questions at the end", "Please answer each question."],
};

function titleOf(state) {
  switch (state.step) {
    case "questions":
      return QUESTIONNAIRES[state.questions.name][0](state);
    case "choose":
      return "Who are you?";
    case "done":
      return "All trials are done";
    default:
      return `Trial ${state.trial} of ${state.trials}`;
  }
}

function textOf({ step, seat, together, said, questions, rest_s: rest, may_pause: mayPause }) {
  switch (step) {
    case "ready":
      return rest > 0
        ? `Take a break. The next trial can begin in ${Math.ceil(rest / 60)} min.`
        : `${said} When you are ready, begin. A link to your seat, ${seat}, will appear here.`.trim();
    case "starting":
      return "The trial is being prepared. That takes some seconds.";
    case "running":
      return `Open the page of your seat, and take the seat ${seat}: the trial begins ${together ? "when everybody has taken their seat" : "then"}, and not before. ${mayPause ? "" : "It cannot be paused. "}When it is over, come back to this page.`;
    case "questions":
      return QUESTIONNAIRES[questions.name][1];
    case "choose":
      return "Choose your identifier. Each participant has a page of their own.";
    case "waiting":
      return "Please wait: somebody else still answers questions.";
    default:
      return "That was the last trial. Thank you.";
  }
}

function show(state) {
  const { step, participant, trial, seat, seats, url, questions, rest_s: rest } = state;
  byId("title").textContent = ["Experiment", participant].filter(Boolean).join(", ");
  byId("step").textContent = titleOf(state);
  byId("step-text").textContent = textOf(state);
  byId("begin").hidden = step !== "ready";
  byId("begin").disabled = rest > 0;
  byId("open").hidden = step !== "running";
  byId("open").href = url ? onThisHost(url, seat) : "#";
  showChoices(seats ?? {});
  const asked = questions ? `${participant} ${trial} ${questions.name}` : "";
  if (questions && asked !== shown) questionnaire.begin(questions);
  shown = asked;
  byId("questions").hidden = !asked;
}

function showChoices(seats) {
  const names = Object.keys(seats);
  if (names.join() === byId("choices").dataset.names) return;
  byId("choices").dataset.names = names.join();
  byId("choices").replaceChildren(
    ...names.map((name) =>
      html("a", { class: "open", href: `#${name}` }, `${name}, at the seat ${seats[name]}`),
    ),
  );
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
  const { missing, answers } = questionnaire;
  if (missing.length)
    note(`Please answer these as well: ${missing.map((name) => `“${name}”`).join(", ")}.`);
  else act("api/answers", { questionnaire: questionnaire.name, answers });
}

async function look() {
  try {
    show(await ask("api/experiment"));
    if (byId("notes").dataset.lost) {
      delete byId("notes").dataset.lost;
      note("");
    }
  } catch (error) {
    byId("notes").dataset.lost = "true";
    note(`${error.message.replace(/\.?$/, ".")} Please tell the experimenter.`);
  }
  document.body.dataset.ready = "true";
}

async function follow() {
  await look();
  setTimeout(follow, PERIOD_MS);
}

connectTheme(() => {});
addEventListener("hashchange", look);
byId("begin").addEventListener("click", () => act("api/begin", {}));
byId("questions").addEventListener("submit", (event) => {
  event.preventDefault();
  answer();
});
follow();
