// Lines, shapes and texts on a canvas. Points and boxes are in pixels.

import { colour } from "./dom.js";

export const FONT = '12px system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif';
export const BOLD = `600 ${FONT}`;
export const FONT_SMALL = FONT.replace("12px", "11px");
/** Severities whose symbols are filled. */
export const FILLED = ["CAUTION", "WARNING"];
const SEVERITY_INKS = { WARNING: "--bad", CAUTION: "--warn", ADVISORY: "--accent" };

/** Returns the colour of a severity on the page. */
export const severityInk = (severity) => colour(SEVERITY_INKS[severity] ?? "--dim");

/**
 * Keeps the drawing context, width and height of a canvas in an object, which it returns, and calls
 * a function whenever they change, with true for the first time. Until then the pen is null.
 */
export function onSize(canvas, changed = () => {}, size = { pen: null, width: 0, height: 0 }) {
  const resized = () => {
    const factor = devicePixelRatio || 1,
      { width, height } = canvas.getBoundingClientRect();
    if (!width || !height) return;
    canvas.width = Math.round(width * factor);
    canvas.height = Math.round(height * factor);
    const pen = canvas.getContext("2d");
    const isFirst = !size.pen;
    pen.setTransform(factor, 0, 0, factor, 0, 0);
    Object.assign(size, { pen, width, height });
    changed(isFirst);
  };
  new ResizeObserver(resized).observe(canvas);
  return size;
}

/** Returns a copy of what a canvas shows. */
export function copyOf(canvas) {
  const copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height;
  copy.getContext("2d").drawImage(canvas, 0, 0);
  return copy;
}

/** Begins a path through points. */
function path(pen, points) {
  pen.beginPath();
  for (const [x, y] of points) pen.lineTo(x, y);
}

/** Draws a line through points. */
export function line(pen, ink, width, ...points) {
  path(pen, points);
  pen.strokeStyle = ink;
  pen.lineWidth = width;
  pen.stroke();
}

/** Draws an outline at a place, turned in rad, scaled, or mirrored left and right. */
export function stamp(pen, outline, [x, y], look) {
  const { fill, edge, width = 1, turn = 0, size = 1, mirrored = false } = look;
  pen.save();
  pen.translate(x, y);
  pen.rotate(turn);
  pen.scale(mirrored ? -size : size, size);
  pen.fillStyle = fill;
  if (fill) pen.fill(outline);
  pen.strokeStyle = edge;
  pen.lineWidth = width / size;
  if (edge) pen.stroke(outline);
  pen.restore();
}

/** Draws a circle. */
export function circle(pen, ink, width, [x, y], radius) {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  pen.strokeStyle = ink;
  pen.lineWidth = width;
  pen.stroke();
}

/** Fills the shape between points. */
export function shape(pen, fill, points) {
  path(pen, points);
  pen.fillStyle = fill;
  pen.fill();
}

/** Fills a box, given by its left and top edges, its width and its height. */
export function box(pen, fill, ...edges) {
  pen.fillStyle = fill;
  pen.fillRect(...edges);
}

/** Draws within a box alone, given by its left, top, right and bottom edges. */
export function within(pen, [left, top, right, bottom], draw) {
  pen.save();
  pen.beginPath();
  pen.rect(left, top, right - left, bottom - top);
  pen.clip();
  draw();
  pen.restore();
}

/** Writes a text with an edge in the colour of what is behind it. */
export function write(pen, text, x, y, ink, behind) {
  pen.lineJoin = "round";
  pen.lineWidth = 3;
  pen.strokeStyle = behind;
  pen.strokeText(text, x, y);
  pen.fillStyle = ink;
  pen.fillText(text, x, y);
}

/** Writes a text of an instrument, whose middle is at a height. */
export function label(pen, text, x, y, ink, size = 13, align = "left", behind = "transparent") {
  pen.font = BOLD.replace("12px", `${size}px`);
  pen.textAlign = align;
  pen.textBaseline = "middle";
  write(pen, text, x, y, ink, behind);
  pen.textBaseline = "alphabetic";
}
