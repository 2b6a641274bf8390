// Keys of the whole page, and the list of them.

import { byId, html, on } from "./dom.js";

/** True where nobody has a seat: who has one cannot go back in time. */
const isWatching = () => !document.body.dataset.seat;

/** Names of keys as they are shown, where these are not the same. */
const SHOWN = { " ": "Space", ArrowLeft: "Left", ArrowRight: "Right" };

/** Returns the keys of the time. */
export const timeKeys = (clock, transport) =>
  [
    [[" ", "k"], "play or pause", () => clock.toggle()],
    [["ArrowLeft"], "1 s back", () => clock.set(clock.t - 1), true],
    [["ArrowRight"], "1 s on", () => clock.set(clock.t + 1), true],
    [["j"], "10 s back", () => clock.set(clock.t - 10), true],
    [["l"], "10 s on", () => clock.set(clock.t + 10), true],
    [[","], "previous event", () => transport.step(-1), true],
    [["."], "next event", () => transport.step(1), true],
    [["Home"], "beginning of the run", () => clock.set(0)],
    [["End"], "end of the run", () => clock.set(clock.end)],
    [["<"], "slower", () => clock.stepRate(-1)],
    [[">"], "faster", () => clock.stepRate(1)],
    [["["], "loop from here", () => clock.mark("from")],
    [["]"], "loop to here", () => clock.mark("to")],
    [["o"], "loop on or off", () => clock.toggleLoop()],
  ].map(([names, text, act, repeats]) => ({ names, text, act, repeats, isUsed: isWatching }));

/** The field of the words for the radio, wherever one is on the page. */
const callField = {
  names: ["c"],
  text: "to the field for a call",
  isUsed: () => byId("words")?.checkVisibility(),
  act: () => byId("words").focus(),
};

/**
 * Connects keys. Each has its names, what it does in words, and a function `act`.
 * It may have `isUsed`, which returns false where it does nothing, and `repeats`: held, it acts again.
 */
export function connectKeys(keys) {
  const help = { names: ["?"], text: "this list", act: () => showHelp() },
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
function inWords({ names, text }) {
  const shown = names.map((name) => SHOWN[name] ?? (name.length > 1 ? name : name.toUpperCase())),
    keys = shown.flatMap((key, i) => [i ? " " : "", html("kbd", key)]);
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
