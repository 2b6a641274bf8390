// Keys of the whole page, and the list of them.

import { byId, html, on } from "./dom.js";

/** True where nobody has a seat: who has one cannot go back in time. */
const isWatching = () => !document.body.dataset.seat;

/** Returns the keys of the time. */
export const timeKeys = (clock, transport) =>
  [
    [[" ", "k"], ["Space", "K"], "play or pause", () => clock.toggle()],
    [["ArrowLeft"], ["Left"], "1 s back", () => clock.set(clock.t - 1), true],
    [["ArrowRight"], ["Right"], "1 s on", () => clock.set(clock.t + 1), true],
    [["j"], ["J"], "10 s back", () => clock.set(clock.t - 10), true],
    [["l"], ["L"], "10 s on", () => clock.set(clock.t + 10), true],
    [[","], [","], "previous event", () => transport.step(-1), true],
    [["."], ["."], "next event", () => transport.step(1), true],
    [["Home"], ["Home"], "beginning of the run", () => clock.set(0)],
    [["End"], ["End"], "end of the run", () => clock.set(clock.end)],
    [["<"], ["<"], "slower", () => clock.stepRate(-1)],
    [[">"], [">"], "faster", () => clock.stepRate(1)],
    [["["], ["["], "loop from here", () => clock.mark("from")],
    [["]"], ["]"], "loop to here", () => clock.mark("to")],
    [["o"], ["O"], "loop on or off", () => clock.toggleLoop()],
  ].map(([names, shown, text, act, repeats]) => {
    return { names, shown, text, act, repeats, isUsed: isWatching };
  });

/** The field of the words for the radio, wherever one is on the page. */
const callField = {
  names: ["c"],
  shown: ["C"],
  text: "to the field for a call",
  isUsed: () => byId("words")?.checkVisibility(),
  act: () => byId("words").focus(),
};

/**
 * Connects keys. Each has its names, how it is shown, what it does in words, and a function `act`.
 * It may have `isUsed`, which returns false where it does nothing, and `repeats`: held, it acts again.
 */
export function connectKeys(keys) {
  const help = { names: ["?"], shown: ["?"], text: "this list", act: () => showHelp() },
    all = [...keys, callField, help];
  const used = () => all.filter(({ isUsed }) => !isUsed || isUsed());
  const showHelp = () => {
    byId("help-keys").replaceChildren(...used().map(inWords));
    byId("help").showModal();
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || document.querySelector("dialog[open]"))
      return;
    if (isTaken(event)) return;
    const key = used().find(({ names }) => names.includes(event.key));
    if (!key) return;
    event.preventDefault();
    if (!event.repeat || key.repeats) key.act(event);
  });
  on("help-button", "click", showHelp);
}

/** Returns a key and what it does, for the list. */
function inWords({ shown, text }) {
  const keys = shown.flatMap((key, i) => [i ? " " : "", html("kbd", key)]);
  return html("div", html("dt", keys), html("dd", text));
}

/** True if the element with the focus has its own use for a key. */
function isTaken(event) {
  const { tagName, type } = event.target;
  if (tagName === "SELECT" || tagName === "TEXTAREA" || (tagName === "INPUT" && type === "text"))
    return true;
  if (event.key === "Enter") return type !== "checkbox";
  const moves = event.key.startsWith("Arrow") || event.key === "Home" || event.key === "End";
  if (tagName === "INPUT" && ["range", "radio"].includes(type)) return moves;
  return event.key === " " && ["BUTTON", "INPUT", "SUMMARY"].includes(tagName);
}
