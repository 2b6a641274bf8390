// What a page asks the server, and what it tells of that.

import { byId, html } from "./dom.js";

/** Asks the server, with a wish if there is one, and throws what it refuses in its words. */
export async function ask(path, wish) {
  const headers = { "Content-Type": "application/json" },
    answer = await fetch(path, wish && { method: "POST", headers, body: JSON.stringify(wish) }),
    content = await answer.json();
  if (!answer.ok) throw new Error(content.error ?? `the server answers ${answer.status}`);
  return content;
}

/** Shows a note, or none. What is written is read aloud, so that only another one is written. */
export function note(text) {
  if (byId("notes").textContent !== text)
    byId("notes").replaceChildren(...(text ? [html("p", text)] : []));
}

/** Shows that the server is lost. */
export function lost(text) {
  byId("notes").dataset.lost = "true";
  note(text);
}

/** Takes that note away, because the server is there again. */
export function found() {
  if (!byId("notes").dataset.lost) return;
  delete byId("notes").dataset.lost;
  note("");
}
