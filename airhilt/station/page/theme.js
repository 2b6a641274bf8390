// Light or dark: as the system, or as somebody has chosen here.

import { byId, forgetColours } from "./dom.js";

const NAME = "airhilt-theme";

/** Calls a function whenever the page has other colours. */
export function connectTheme(changed) {
  const choice = byId("theme");
  const apply = () => {
    if (choice.value) document.documentElement.dataset.theme = choice.value; else delete document.documentElement.dataset.theme;
    forgetColours();
    changed();
  };
  choice.value = localStorage.getItem(NAME) ?? "";
  choice.addEventListener("change", () => { localStorage.setItem(NAME, choice.value); apply(); });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", apply);
  apply();
}
