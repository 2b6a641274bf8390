// Keys of the whole page, and the list of them.

import { byId, html } from "./dom.js";

/** True where nobody has a seat: who has one cannot go back in time. */
const isWatching = () => !document.body.dataset.seat;

/** Returns the keys of the time. */
export const timeKeys = (clock, transport) =>
  [
    { names: [" ", "k"], shown: ["Space", "K"], text: "play or pause", act: () => clock.toggle() },
    {
      names: ["ArrowLeft"],
      shown: ["Left"],
      text: "1 s back",
      repeats: true,
      act: () => clock.set(clock.t - 1),
    },
    {
      names: ["ArrowRight"],
      shown: ["Right"],
      text: "1 s on",
      repeats: true,
      act: () => clock.set(clock.t + 1),
    },
    {
      names: ["j"],
      shown: ["J"],
      text: "10 s back",
      repeats: true,
      act: () => clock.set(clock.t - 10),
    },
    {
      names: ["l"],
      shown: ["L"],
      text: "10 s on",
      repeats: true,
      act: () => clock.set(clock.t + 10),
    },
    {
      names: [","],
      shown: [","],
      text: "previous event",
      repeats: true,
      act: () => transport.step(-1),
    },
    { names: ["."], shown: ["."], text: "next event", repeats: true, act: () => transport.step(1) },
    { names: ["Home"], shown: ["Home"], text: "beginning of the run", act: () => clock.set(0) },
    { names: ["End"], shown: ["End"], text: "end of the run", act: () => clock.set(clock.end) },
    { names: ["<"], shown: ["<"], text: "slower", act: () => clock.stepRate(-1) },
    { names: [">"], shown: [">"], text: "faster", act: () => clock.stepRate(1) },
    { names: ["["], shown: ["["], text: "loop from here", act: () => clock.mark("from") },
    { names: ["]"], shown: ["]"], text: "loop to here", act: () => clock.mark("to") },
    { names: ["o"], shown: ["O"], text: "loop on or off", act: () => clock.toggleLoop() },
  ].map((key) => ({ ...key, isUsed: isWatching }));

/**
 * Connects keys. Each has its names, how it is shown, what it does in words, and a function `act`.
 * It may have `isUsed`, which returns false where it does nothing, and `repeats`: held, it acts again.
 */
export function connectKeys(keys) {
  const help = { names: ["?"], shown: ["?"], text: "this list", act: () => showHelp() },
    all = [...keys, help];
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
  byId("help-button").addEventListener("click", showHelp);
}

/** Returns a key and what it does, for the list. */
function inWords({ shown, text }) {
  const keys = shown.flatMap((key, i) => [i ? " " : "", html("kbd", {}, key)]);
  return html("div", {}, html("dt", {}, keys), html("dd", {}, text));
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
