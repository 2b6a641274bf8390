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
/** A linear scale with its ticks, which are a step apart, and their format. */
function scale(d0, d1, r0, r1, step, format = (value) => (step >= 1 ? whole(value) : fixed(value, digitsOf(step)))) {
  const map = (value) => r0 + (value - d0) / (d1 - d0) * (r1 - r0), invert = (pixel) => d0 + (pixel - r0) / (r1 - r0) * (d1 - d0);
  return Object.assign(map, { invert, ticks: ticks(d0, d1, step), format });
}
const pen = document.createElement("canvas").getContext("2d");
function measure(text, bold = false) {
  pen.font = `${bold ? 650 : 400} 12px system-ui, "DejaVu Sans", sans-serif`;
  return pen.measureText(text).width;
}
const widthOf = (holder) => Math.max(holder.clientWidth, 240);

/** Puts an empty chart into its place. */
function canvas(holder, height, label) {
  const width = widthOf(holder);
  const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
  holder.replaceChildren(root);
  return { root, width, height };
}

const line = (x1, y1, x2, y2, more = {}) => svg("line", { x1, y1, x2, y2, ...more });
const label = (x, y, text, more = {}) => svg("text", { x, y, "text-anchor": "middle", ...more }, text);
const areaRect = ({ left, right, top, bottom }, more = {}) => svg("rect", { x: left, y: top, width: right - left, height: bottom - top, ...more });

/** Draws the lines of a grid across the axis at the bottom; one that has a name has labels too. */
function bottomAxis(root, { left, right, top, bottom }, x, name) {
  for (const value of x.ticks) {
    root.append(line(x(value), top, x(value), bottom, { class: "gridline" }));
    if (name) root.append(label(x(value), bottom + 17, x.format(value), { class: "tick" }));
  }
  if (name) root.append(label((left + right) / 2, bottom + 34, name, { class: "unit" }));
}

/** Draws a grid with labels below and at the left, and the frame around them. */
function axes(root, area, x, y, nameX, nameY) {
  const { left, right, top, bottom } = area, middle = (top + bottom) / 2;
  for (const value of y.ticks) {
    root.append(line(left, y(value), right, y(value), { class: "gridline" }), label(left - 7, y(value) + 4, y.format(value), { class: "tick", "text-anchor": "end" }));
  }
  bottomAxis(root, area, x, nameX);
  root.append(label(13, middle, nameY, { class: "unit", transform: `rotate(-90 13 ${middle})` }), areaRect(area, { class: "frame" }));
}

const timeScale = ({ left, right }) => scale(0, endS, left, right, niceTimeStep(endS, Math.max(3, (right - left) / 70)), (value) => fixed(value, 0));
const valueScale = (low, high, { top, bottom }, most) => scale(low, high, bottom, top, niceStep(high - low, most));
const upFrom0 = (values, area) => valueScale(0, Math.max(...values, 1) * 1.12, area, 5);

/** Scales for a part of the plane in NM, on which a mile to the east is as long as one to the north. */
function planeScales(area, { east, north }, pad, least, inMetres = false) {
  const width = area.right - area.left, height = area.bottom - area.top, span = ({ low, high }) => Math.max((high - low) * pad, least);
  const perNm = Math.min(width / span(east), height / span(north));
  const near = inMetres && width / perNm < 3, unit = near ? 1 / METRE_PER_NM : 1; // so near that metres say more than miles
  const step = niceStep(width / perNm / unit, width / 75) * unit, format = (value) => (near ? whole(value / unit) : fixed(value, digitsOf(step)));
  const along = ({ low, high }, length, from, to) => scale((low + high - length / perNm) / 2, (low + high + length / perNm) / 2, from, to, step, format);
  return { x: along(east, width, area.left, area.right), y: along(north, height, area.bottom, area.top), perNm, step, near };
}
const boxAround = (cx, cy, width, height) => ({ cx, cy, left: cx - width / 2, right: cx + width / 2, top: cy - height / 2, bottom: cy + height / 2 });
const isInside = (box, area) => box.left > area.left && box.right < area.right && box.top > area.top && box.bottom < area.bottom;
const overlap = (one, other) => one.left < other.right && one.right > other.left && one.top < other.bottom && one.bottom > other.top;
/** The first of some boxes that overlaps none of those taken, which it joins; undefined if none is free. */
function firstFree(boxes, taken) {
  const free = boxes.find((box) => !taken.some((other) => overlap(box, other)));
  if (free) taken.push(free);
  return free;
}
function path(xs, ys, x, y) {
  return xs.map((value, i) => `${i ? "L" : "M"}${x(value).toFixed(1)} ${y(ys[i]).toFixed(1)}`).join("");
}
function clip(root, id, area) {
  const group = svg("g", { "clip-path": `url(#${id})` });
  root.append(svg("clipPath", { id }, areaRect(area)), group);
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
  const from = timeOf("opened"), to = timeOf("closed") ?? endS;
  if (known(from)) root.append(areaRect({ ...area, left: x(from), right: Math.max(x(to), x(from) + 1) }, { class: "window" }));
}

/** Events of a time that is under the pointer, as far as a chart over time tells them apart. */
const nearby = (events, t, area) => events.filter((event) => Math.abs(event.t - t) < 4 * endS / (area.right - area.left));

/** Fills the key of a chart; an item that is false is left out. */
const fillKey = (id, ...items) => byId(id).replaceChildren(...items.flat().filter(Boolean));
