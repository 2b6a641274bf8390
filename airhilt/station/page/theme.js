// Light or dark: as the system, or as somebody has chosen here.

import { byId, forgetColours } from "./dom.js";

const NAME = "airhilt-theme";

/** Calls a function whenever the page has other colours. */
export function connectTheme(changed) {
  const choice = byId("theme");
  const apply = () => {
    document.documentElement.style.colorScheme = choice.value; // As the system, if it is empty.
    forgetColours();
    changed();
  };
  const show = () => {
    choice.value = localStorage.getItem(NAME) ?? "";
    apply();
  };
  choice.addEventListener("change", () => {
    localStorage.setItem(NAME, choice.value);
    apply();
  });
  window.addEventListener("storage", ({ key }) => {
    if (key === NAME) show();
  }); // another page, or the one around this
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", apply);
  show();
}
