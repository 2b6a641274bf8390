// Timelines: one row for each actor or camera, over time.

const ROW = 24;
/** Largest number of rows in one chart. */
const MOST_ROWS = 24;
const goingOn = (intervals, t) => intervals.filter((interval) => interval.from <= t && t < interval.to);
const intervalRect = (x, { from, to }, y, height, more) => svg("rect", { x: x(from), y, width: Math.max(x(to) - x(from), 2), height, ...more });

/**
 * Draws timelines; each row has its `text`, `colour` and marks, a function of the scale of time and the
 * row's height. A row with a `head` at the left begins a group. `read` says what is at a time.
 */
function timelines(id, rows, name, marks, read) {
  byId(`${id}-figure`).hidden = false;
  const left = Math.max(...rows.map(({ text, head }) => measure(text, true) + (head ? measure(head, true) + 14 : 0)), 30) + 14;
  const starts = rows.map(({ head }, i) => known(head) && i > 0), middles = rows.map((_, i) => 6 + ROW * (i + 0.5) + 10 * starts.slice(0, i + 1).filter(Boolean).length);
  const area = { left, right: widthOf(byId(id)) - 14, top: 4, bottom: middles.at(-1) + ROW / 2 + 4 }, chart = canvas(byId(id), area.bottom + 40, name), { root } = chart, x = timeScale(area);
  drawWindow(root, x, area);
  bottomAxis(root, area, x, "Time (s)");
  root.append(areaRect(area, { class: "frame" }));
  rows.forEach(({ text, head, colour }, i) => {
    if (starts[i]) root.append(line(0, middles[i] - ROW / 2 - 5, area.right, middles[i] - ROW / 2 - 5, { class: "frame" }));
    if (head) root.append(label(2, middles[i] + 4, head, { class: "bold", "text-anchor": "start" }));
    root.append(label(left - 8, middles[i] + 4, text, { class: "bold", "text-anchor": "end", style: `fill: ${colour}` }));
  });
  rows.forEach((row, i) => fill(root, {}, marks(row, x, middles[i])));
  return { root, x, middles, follow: followPointer(chart, area, x, (t) => read(t, (events) => nearby(events, t, area))) };
}
