"use strict";

/** The sections of the page, and what each draws. */
const page = {
  drawn: [],

  /** Adds a section: a function of the section's data that returns `draw`, `fit`, both or nothing. */
  section(name, make) {
    const data = given.sections[name];
    const parts = this.attempt(name, () => make(data === undefined ? null : data)) || {};
    this.drawn.push({ name, ...parts });
  },

  /** Receives the functions that were returned by what was drawn; a page with a clock keeps them. */
  shown() {},

  /** Calls a function; where it fails, the page says of which section, and goes on with the others. */
  attempt(name, call) {
    try {
      return call();
    } catch (error) {
      console.error(`section ${name}:`, error);
      this.note(`The section ${name} cannot be drawn: ${error.message}`);
      return null;
    }
  },

  /** Adds a sentence on what is missing. */
  note(text) {
    (byId("notes") || document.querySelector("main")).append(html("p", { class: "note" }, text));
  },

  /** Draws all sections, and those that fit themselves to the window again whenever its width changes. */
  begin() {
    const call = (method) => this.drawn.filter((section) => section[method])
      .map((section) => this.attempt(section.name, () => section[method]())).filter(Boolean);
    const steady = call("draw");
    let width = 0;
    const redraw = () => {
      if (document.documentElement.clientWidth === width) return;
      width = document.documentElement.clientWidth;
      this.shown([...steady, ...call("fit")]);
    };
    redraw();
    new ResizeObserver(redraw).observe(document.documentElement);
  },
};

/** What `attempt` does not see: the script of a section that cannot be parsed, and errors after the page was drawn. */
window.addEventListener("error", ({ error, message }) => {
  if (!error) return; // no exception, but the notice of a ResizeObserver that goes on in the next frame
  const name = document.currentScript?.dataset.section;
  page.note(name ? `The section ${name} cannot be drawn: ${message}` : `A script of this page failed: ${message}`);
});
