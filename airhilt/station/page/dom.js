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

/** Returns a button that sets the clock to a time. */
export function timeButton(clock, t, text) {
  const button = html(
    "button",
    { type: "button", class: "time", "aria-label": `Go to ${text}` },
    text,
  );
  button.addEventListener("click", () => clock.set(t));
  return button;
}

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

/**
 * Calls a function with the drawing context, width and height of a canvas whenever its size
 * changes.
 */
export function onSize(canvas, call) {
  const resized = () => {
    const factor = devicePixelRatio || 1,
      { width, height } = canvas.getBoundingClientRect();
    if (!width || !height) return;
    canvas.width = Math.round(width * factor);
    canvas.height = Math.round(height * factor);
    const pen = canvas.getContext("2d");
    pen.setTransform(factor, 0, 0, factor, 0, 0);
    call(pen, width, height);
  };
  new ResizeObserver(resized).observe(canvas);
}

export const FONT = '12px system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif';
export const BOLD = `600 ${FONT}`;
export const FONT_SMALL = FONT.replace("12px", "11px");

/** Writes a text with an edge in the colour of what is behind it. */
export function write(pen, text, x, y, ink, behind) {
  pen.lineJoin = "round";
  pen.lineWidth = 3;
  pen.strokeStyle = behind;
  pen.strokeText(text, x, y);
  pen.fillStyle = ink;
  pen.fillText(text, x, y);
}
