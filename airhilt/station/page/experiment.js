// The page of a participant: what is to be done now, and the questions of the plan. Where several
// have seats together, the end of its address says whose page it is, such as #P01.

import { byId, html, on, onSubmit, write } from "./dom.js";
import { addressee, onThisHost } from "./neighbours.js";
import { Questionnaire } from "./questionnaire.js";
import { ask, found, lost, note } from "./server.js";
import { connectTheme } from "./theme.js";

const PERIOD_MS = 1000;
const NOTHING = { step: "nothing" }; // of a participant who is not known, or not yet
const drafts = new Map(); // questionnaires with answers that are not sent, by what they ask whom
let draft = null; // the one that is shown
let shown = ""; // participant, trial, step and questionnaire that are shown
let asked = 0; // number of requests
let answered = 0; // number of the last request whose answer is shown

/**
 * Counts a request. Returns a function that says, when the answer comes, if it is to be shown: not
 * on the page of another participant, nor after the answer to a later request.
 */
function turn() {
  const whose = addressee(),
    number = ++asked;
  return () => {
    if (whose !== addressee() || number < answered) return false;
    answered = number;
    return true;
  };
}

const askFor = (path, wish) =>
  ask(`${path}?participant=${encodeURIComponent(addressee())}`, wish).catch((error) => {
    throw error instanceof TypeError ? new Error("The experiment does not answer.") : error;
  });

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

const ofTrial = ({ trial, trials }) => `Trial ${trial} of ${trials}`;

/** Heading and text of each step. */
const STEPS = {
  nothing: () => ["", ""],
  choose: () => [
    "Who are you?",
    "Choose your identifier. Each participant has a page of their own.",
  ],
  ready: (state) => [
    ofTrial(state),
    state.rest_s > 0
      ? `Take a break. The next trial can begin in ${Math.ceil(state.rest_s / 60)} min.`
      : `${state.said} When you are ready, begin. A link to your seat, ${state.seat}, will appear here.`.trim(),
  ],
  starting: (state) => [ofTrial(state), "The trial is being prepared. That takes some seconds."],
  running: (state) => [
    ofTrial(state),
    `Open the page of your seat, and take the seat ${state.seat}: the trial begins ${state.together ? "when everybody has taken their seat" : "then"}, and not before. ${state.may_pause ? "" : "It cannot be paused. "}When it is over, come back to this page.`,
  ],
  questions: (state) => {
    const [title, text] = QUESTIONNAIRES[state.questions.name];
    return [title(state), text];
  },
  waiting: (state) => [ofTrial(state), "Please wait: somebody else still answers questions."],
  done: () => ["All trials are done", "That was the last trial. Thank you."],
};

function show(state) {
  const { step, participant, trial, seat, seats, url, questions, rest_s: rest } = state;
  const now = JSON.stringify([participant, trial, step, questions?.name]);
  if (now !== shown) note("");
  shown = now;
  write(byId("title"), ["Experiment", participant].filter(Boolean).join(", "));
  const [title, text] = STEPS[step](state);
  write(byId("step"), title);
  write(byId("step-text"), text);
  byId("begin").hidden = step !== "ready";
  byId("begin").disabled = rest > 0;
  byId("open").hidden = step !== "running";
  byId("open").href = url ? onThisHost(url, seat) : "#";
  showChoices(seats ?? {});
  byId("questions").hidden = !questions;
  if (questions) showQuestions(JSON.stringify([participant, trial, questions]), questions);
}

/** Shows questions; `key` is what they ask whom. Answers that are not sent yet stay. */
function showQuestions(key, questions) {
  if (draft?.key === key) return;
  draft = drafts.get(key);
  if (!draft) {
    const place = html("div.items");
    draft = { key, place, questionnaire: new Questionnaire(place, questions) };
    drafts.set(key, draft);
  }
  byId("items").replaceChildren(draft.place);
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

async function act(path, wish, taken = () => {}) {
  const isToBeShown = turn(),
    before = shown;
  try {
    const state = await askFor(path, wish);
    taken();
    if (!isToBeShown()) return;
    show(state);
    note("");
  } catch (error) {
    if (shown === before) note(error.message); // Else it is of a step that is over.
  }
}

function answer() {
  if (!draft) return; // The answers have just been taken.
  const { key, questionnaire } = draft,
    { name, missing, answers } = questionnaire;
  if (missing.length)
    note(`Please answer these as well: ${missing.map((one) => `“${one}”`).join(", ")}.`);
  else
    act("api/answers", { questionnaire: name, answers }, () => {
      drafts.delete(key);
      if (draft?.key === key) draft = null;
    });
}

async function look() {
  const isToBeShown = turn();
  try {
    const state = await askFor("api/experiment");
    if (!isToBeShown()) return;
    show(state);
    found();
  } catch (error) {
    if (!isToBeShown()) return;
    lost(`${error.message.replace(/\.?$/, ".")} Please tell the experimenter.`);
  }
  document.body.dataset.ready = "true";
}

async function follow() {
  await look();
  setTimeout(follow, PERIOD_MS);
}

connectTheme(() => {});
addEventListener("hashchange", () => {
  show(NOTHING);
  look();
});
on("begin", "click", () => act("api/begin", {}));
onSubmit(byId("questions"), answer);
follow();
