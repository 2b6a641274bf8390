// Elements of the page. Text is only ever set as text.

const SVG = "http://www.w3.org/2000/svg";

export const byId = (id) => document.getElementById(id);

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined && value !== false)
      node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return node;
}

/** Returns an HTML element. */
export const html = (tag, attributes = {}, ...children) =>
  filled(document.createElement(tag), attributes, children);

/** Returns an SVG element. */
export const svg = (tag, attributes = {}, ...children) =>
  filled(document.createElementNS(SVG, tag), attributes, children);

/** Returns a button that does something when it is pressed. */
export function button(text, act, attributes = {}) {
  const made = html("button", { type: "button", ...attributes }, text);
  made.addEventListener("click", act);
  return made;
}

/** Returns a button that sets the clock to a time. */
export const timeButton = (clock, t, text) =>
  button(text, () => clock.set(t), { class: "time", "aria-label": `Go to ${text}` });

const known = new Map();
const probe = document.createElement("span");
probe.hidden = true;
document.body.append(probe);

/** Returns the colour that a custom property such as `--ink` has now, for a canvas. */
export function colour(name) {
  if (!known.has(name)) {
    probe.style.color = `var(${name})`;
    known.set(name, getComputedStyle(probe).color);
  }
  return known.get(name);
}

/** Lets `colour` look again, because the page has other colours now. */
export const forgetColours = () => known.clear();
