"use strict";
// Scales, axes and labels of charts.

function niceTimeStep(span, most) {
  const steps = [1, 2, 5, 10, 15, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600];
  return steps.find((step) => step >= span / most) || niceStep(span, most);
}
function ticks(low, high, step) {
  const found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; i += 1) found.push(i * step);
  return found;
}
const digitsOf = (step) => Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
const scale = (d0, d1, r0, r1) => {
  const map = (value) => r0 + (value - d0) / (d1 - d0) * (r1 - r0);
  map.invert = (pixel) => d0 + (pixel - r0) / (r1 - r0) * (d1 - d0);
  return map;
};
const measure = (() => {
  const context = document.createElement("canvas").getContext("2d");
  return (text, bold = false) => {
    context.font = `${bold ? 650 : 400} 12px system-ui, "DejaVu Sans", sans-serif`;
    return context.measureText(text).width;
  };
})();

/** Puts an empty chart into its place. */
function canvas(holder, height, label) {
  const width = Math.max(holder.clientWidth, 240);
  const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
  holder.replaceChildren(root);
  return { root, width, height };
}

/** Draws the lines of a grid across the axis at the bottom, with their labels. */
function bottomAxis(root, area, x, noX = false) {
  for (const value of x.ticks) {
    const px = x(value);
    root.append(svg("line", { class: "gridline", x1: px, x2: px, y1: area.top, y2: area.bottom }));
    if (!noX) root.append(svg("text", { class: "tick", x: px, y: area.bottom + 17, "text-anchor": "middle" }, x.format(value)));
  }
}
const nameBelow = (area, name, below = 34) => svg("text", { class: "unit", x: (area.left + area.right) / 2, y: area.bottom + below, "text-anchor": "middle" }, name);
const frameOf = ({ left, right, top, bottom }) => svg("rect", { class: "frame", x: left, y: top, width: right - left, height: bottom - top });

/** Draws a grid with labels below and at the left, and the frame around them. */
function axes(root, area, x, y, names, noX = false) {
  const { left, right, top, bottom } = area;
  for (const value of y.ticks) {
    const py = y(value);
    root.append(svg("line", { class: "gridline", x1: left, x2: right, y1: py, y2: py }),
      svg("text", { class: "tick", x: left - 7, y: py + 4, "text-anchor": "end" }, y.format(value)));
  }
  bottomAxis(root, area, x, noX);
  if (!noX) root.append(nameBelow(area, names.x));
  const middle = (top + bottom) / 2;
  root.append(svg("text", { class: "unit", x: 13, y: middle, "text-anchor": "middle", transform: `rotate(-90 13 ${middle})` }, names.y), frameOf(area));
}

function timeScale(area) {
  const x = scale(0, endS, area.left, area.right);
  x.ticks = ticks(0, endS, niceTimeStep(endS, Math.max(3, (area.right - area.left) / 70)));
  x.format = (value) => fixed(value, 0);
  return x;
}
function valueScale(low, high, from, to, most) {
  const step = niceStep(high - low, most), y = scale(low, high, from, to);
  y.ticks = ticks(low, high, step);
  y.format = (value) => (Math.abs(step) >= 1 ? whole(value) : fixed(value, digitsOf(step)));
  return y;
}

/** Scales for a part of the plane in NM, on which a mile to the east is as long as one to the north. */
function planeScales(area, { east, north }, pad, least, inMetres = false) {
  const width = area.right - area.left, height = area.bottom - area.top, span = ({ low, high }) => Math.max((high - low) * pad, least);
  const perNm = Math.min(width / span(east), height / span(north));
  const along = ({ low, high }, length, from, to) => scale((low + high - length / perNm) / 2, (low + high + length / perNm) / 2, from, to);
  const x = along(east, width, area.left, area.right), y = along(north, height, area.bottom, area.top);
  const near = inMetres && width / perNm < 3, unit = near ? 1 / METRE_PER_NM : 1; // so near that metres say more than miles
  const step = niceStep(width / perNm / unit, width / 75) * unit;
  x.ticks = ticks(x.invert(area.left), x.invert(area.right), step);
  y.ticks = ticks(y.invert(area.bottom), y.invert(area.top), step);
  x.format = y.format = (value) => (near ? whole(value / unit) : fixed(value, digitsOf(step)));
  return { x, y, perNm, step, near };
}
const overlap = (one, other) => one.left < other.right && one.right > other.left && one.top < other.bottom && one.bottom > other.top;
function path(xs, ys, x, y) {
  return xs.map((value, i) => `${i ? "L" : "M"}${x(value).toFixed(1)} ${y(ys[i]).toFixed(1)}`).join("");
}
function clip(root, id, area) {
  root.append(svg("clipPath", { id }, svg("rect", { x: area.left, y: area.top, width: area.right - area.left, height: area.bottom - area.top })));
  const group = svg("g", { "clip-path": `url(#${id})` });
  root.append(group);
  return group;
}

/** Returns label positions with at least a gap between each two. */
function spread(wanted, gap, low, high) {
  const order = wanted.map((_, i) => i).sort((a, b) => wanted[a] - wanted[b]);
  const placed = [...wanted];
  order.forEach((i, k) => { placed[i] = Math.max(placed[i], k ? placed[order[k - 1]] + gap : low); });
  [...order].reverse().forEach((i, k, all) => { placed[i] = Math.min(placed[i], k ? placed[all[k - 1]] - gap : high); });
  return placed;
}

/** Puts labels of marks into rows so that none touches another; returns the number of rows. */
function rows(found, x, area) {
  const ends = [];
  for (const mark of found) {
    const width = measure(mark.label), px = x(mark.t);
    mark.flip = px + width + 6 > area.right && px - width - 6 > area.left - 40;
    const from = mark.flip ? px - width - 6 : Math.min(px, area.right - width - 6), to = from + width + 6;
    let row = ends.findIndex((taken) => taken.every(([a, b]) => to + 6 < a || from > b + 6));
    if (row < 0) { row = ends.length; ends.push([]); }
    ends[row].push([from, to]);
    Object.assign(mark, { row, px, labelX: mark.flip ? px - 4 : from + 4 });
  }
  return ends.length;
}

/** Draws the conflict window. */
function drawWindow(root, x, area) {
  const from = timeOf("opened");
  if (!known(from)) return;
  const closed = timeOf("closed"), to = known(closed) ? closed : endS;
  root.append(svg("rect", { class: "window", x: x(from), y: area.top, width: Math.max(x(to) - x(from), 1), height: area.bottom - area.top }));
}

const upFrom0 = (values, area) => valueScale(0, Math.max(...values, 1) * 1.12, area.bottom, area.top, 5);
