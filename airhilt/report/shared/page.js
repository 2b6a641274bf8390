// The data of the page, its elements and its sections. Text is only ever set as text.

const given = JSON.parse(document.querySelector('script[type="application/json"]').textContent);

const byId = (id) => document.getElementById(id);
const SVG = byId("namespace").namespaceURI;

/** Sets the attributes of a node, and appends children; what is null or undefined is left out, and a child that is false. */
function fill(node, attributes, children = []) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return node;
}
const html = (tag, attributes = {}, ...children) => fill(document.createElement(tag), attributes, children);
const svg = (tag, attributes = {}, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);
const dim = (text, tag = "p") => html(tag, { class: "dim" }, text);

/** The sections of the page, and what each draws. */
const page = {
  drawn: [],

  /** Adds a section: a function of the section's data that returns `draw`, `fit`, both or nothing. */
  section(name, make) {
    this.drawn.push({ name, ...this.attempt(name, () => make(given.sections[name] ?? null)) });
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
