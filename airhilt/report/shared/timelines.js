"use strict";
// Timelines: one row for each actor or camera, over time.

const ROW = 24;
/** Largest number of rows in one chart. */
const MOST_ROWS = 24;
const goingOn = (intervals, t) => intervals.filter((interval) => interval.from <= t && t < interval.to);

/** Draws the frame of timelines with names at the left, and returns what is needed to fill them. */
function timelines(holder, names, label, gaps = []) {
  const width = Math.max(holder.clientWidth, 240), left = Math.max(...names.map(({ text, head }) => measure(text, true) + (head ? measure(head, true) + 14 : 0)), 30) + 14;
  let top = 6;
  const middles = names.map((_, i) => { if (gaps.includes(i)) top += 10; top += ROW; return top - ROW / 2; });
  const area = { left, right: width - 14, top: 4, bottom: top + 4 }, chart = canvas(holder, area.bottom + 40, label), x = timeScale(area);
  drawWindow(chart.root, x, area);
  bottomAxis(chart.root, area, x);
  chart.root.append(nameBelow(area, "Time (s)"), frameOf(area));
  gaps.forEach((i) => chart.root.append(svg("line", { class: "frame", x1: 0, x2: area.right, y1: middles[i] - ROW / 2 - 5, y2: middles[i] - ROW / 2 - 5, style: "stroke: var(--line)" })));
  names.forEach(({ text, head, colour }, i) => {
    if (head) chart.root.append(svg("text", { class: "bold", x: 2, y: middles[i] + 4 }, head));
    chart.root.append(svg("text", { class: "bold", x: left - 8, y: middles[i] + 4, "text-anchor": "end", style: `fill: ${colour}` }, text));
  });
  return { chart, area, x, middles };
}
