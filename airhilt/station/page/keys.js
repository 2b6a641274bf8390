// Keys of the whole page, and the list of them.

import { byId, html } from "./dom.js";

/** Returns the keys of the time. */
/** Keys that do nothing at a seat: who has one cannot go back in time. */
const watching = (keys) => keys.map(({ act, ...key }) => ({ ...key, act: () => { if (!document.body.dataset.seat) act(); } }));

export const timeKeys = (clock, transport) => watching([
  { names: [" ", "k"], shown: ["Space", "K"], text: "play or pause; at a seat, Space is held to talk", act: () => clock.toggle() },
  { names: ["ArrowLeft"], shown: ["Left"], text: "1 s back", act: () => clock.set(clock.t - 1) },
  { names: ["ArrowRight"], shown: ["Right"], text: "1 s on", act: () => clock.set(clock.t + 1) },
  { names: ["j"], shown: ["J"], text: "10 s back", act: () => clock.set(clock.t - 10) },
  { names: ["l"], shown: ["L"], text: "10 s on", act: () => clock.set(clock.t + 10) },
  { names: [","], shown: [","], text: "previous event", act: () => transport.step(-1) },
  { names: ["."], shown: ["."], text: "next event", act: () => transport.step(1) },
  { names: ["Home"], shown: ["Home"], text: "beginning of the run", act: () => clock.set(0) },
  { names: ["End"], shown: ["End"], text: "end of the run", act: () => clock.set(clock.end) },
  { names: ["<"], shown: ["<"], text: "slower", act: () => clock.stepRate(-1) },
  { names: [">"], shown: [">"], text: "faster", act: () => clock.stepRate(1) },
  { names: ["["], shown: ["["], text: "loop from here", act: () => clock.mark("from") },
  { names: ["]"], shown: ["]"], text: "loop to here", act: () => clock.mark("to") },
  { names: ["o"], shown: ["O"], text: "loop on or off", act: () => clock.toggleLoop() },
]);

/** Connects keys: each has a name, what it does in words, and a function. */
export function connectKeys(keys) {
  const byName = new Map(keys.flatMap(({ names, act }) => names.map((name) => [name, act])));
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || document.querySelector("dialog[open]")) return;
    if (isTaken(event)) return;
    const act = byName.get(event.key);
    if (!act) return;
    event.preventDefault();
    act(event);
  });
  byId("help-keys").replaceChildren(...keys.flatMap(({ shown, text }) => [html("dt", {}, shown.flatMap((key, i) => (i ? [" ", html("kbd", {}, key)] : [html("kbd", {}, key)]))), html("dd", {}, text)]));
  byId("help-button").addEventListener("click", () => byId("help").showModal());
}

/** True if the element with the focus has its own use for a key. */
function isTaken(event) {
  const { tagName, type } = event.target;
  if (tagName === "SELECT" || tagName === "TEXTAREA" || (tagName === "INPUT" && type === "text")) return true;
  const moves = event.key.startsWith("Arrow") || event.key === "Home" || event.key === "End";
  if (tagName === "INPUT" && type === "range") return moves;
  return event.key === " " && ["BUTTON", "INPUT", "SUMMARY"].includes(tagName);
}
