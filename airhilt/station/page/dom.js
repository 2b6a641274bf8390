// Elements of the page. Text is only ever set as text.

const SVG = "http://www.w3.org/2000/svg";

export const byId = (id) => document.getElementById(id);

/** Calls a function when something happens to an element. */
export const on = (id, event, act) => byId(id).addEventListener(event, act);

/** Calls a function instead of sending a form. */
export const onSubmit = (form, act) =>
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    act();
  });

/** Writes a text, unless it is there: what is written may be read aloud. */
export function write(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Fills an element that `make` makes of a name such as "div" or "div.row-head", with its classes. */
function filled(make, name, given) {
  const [tag, ...classes] = name.split("."),
    hasAttributes = given[0]?.constructor === Object,
    attributes = hasAttributes ? given.shift() : {},
    node = make(tag);
  if (classes.length) node.setAttribute("class", classes.join(" "));
  for (const [attribute, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined && value !== false)
      node.setAttribute(attribute, value === true ? "" : value);
  }
  node.append(...given.flat().filter((child) => child !== null && child !== undefined));
  return node;
}

/** Returns an HTML element of a tag with classes; attributes may come before its children. */
export const html = (name, ...given) => filled((tag) => document.createElement(tag), name, given);

/** Returns an SVG element likewise. */
export const svg = (name, ...given) =>
  filled((tag) => document.createElementNS(SVG, tag), name, given);

/** Returns a button that does something when it is pressed. */
export function button(text, act, attributes = {}) {
  const made = html("button", { type: "button", ...attributes }, text);
  made.addEventListener("click", act);
  return made;
}

/**
 * Offers values in a choice, each with its text where that is another one. What is chosen stays
 * chosen, and an open list stays open, if they can. The empty value is not offered.
 */
export function offer(select, options, first = "") {
  const pairs = options.map((option) => (Array.isArray(option) ? option : [option, option])),
    values = pairs.map(([value]) => String(value));
  const chosen = select.value;
  if (chosen && [...select.options].map(({ value }) => value).join() === values.join()) return;
  select.replaceChildren(
    ...pairs.map(([value, text]) => html("option", { value, hidden: value === "" }, text)),
  );
  select.value = values.includes(chosen) ? chosen : first || values[0];
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
