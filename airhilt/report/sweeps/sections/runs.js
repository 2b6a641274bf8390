const ROW_PX = 30, BEYOND = 12;
const { columns, keys, links } = data, table = byId("runs-table"), holder = byId("runs-window"), body = html("tbody");
let order = [], sorted = null, isDown = false;

columns.forEach((column) => Object.assign(column, { filter: "", kind: column.values.some((value) => typeof value === "number") ? "number" : null }));
const shown = () => columns.filter((column) => column.shown);

function written(value) {
  if (!known(value)) return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  return typeof value === "number" ? minus(String(value)) : value;
}

/** Comparisons of a number with a limit, as they are written in a filter. */
const COMPARE = { "<": (v, limit) => v < limit, "<=": (v, limit) => v <= limit, ">": (v, limit) => v > limit, ">=": (v, limit) => v >= limit, "=": (v, limit) => v === limit };

/** Returns a function that says whether a value is what a filter asks for. */
function wanted(text) {
  const asked = text.trim().toLowerCase();
  if (asked === "-") return (value) => !known(value) || value === "";
  const [, low, high] = asked.match(/^(-?[\d.]+)\s*\.\.\s*(-?[\d.]+)$/) ?? [], [, sign, limit] = asked.match(/^([<>]=?|=)\s*(-?[\d.]+(?:e-?\d+)?)$/) ?? [];
  if (low) return (value) => typeof value === "number" && value >= +low && value <= +high;
  if (sign) return (value) => typeof value === "number" && COMPARE[sign](value, +limit);
  return (value) => written(value).toLowerCase().includes(asked);
}

/** Compares two rows; what is empty comes last either way. */
function compare(a, b) {
  const x = sorted?.values[a], y = sorted?.values[b];
  if (!known(x) || !known(y)) return (known(y) - known(x)) || a - b;
  return (isDown ? -1 : 1) * (typeof x === "string" ? x.localeCompare(y) : x - y) || a - b;
}

function arrange() {
  const tests = columns.filter(({ filter }) => filter.trim()).map(({ values, filter }) => [values, wanted(filter)]);
  order = [...keys.keys()].filter((i) => tests.every(([values, test]) => test(values[i]))).sort(compare);
  byId("runs-count").textContent = order.length === keys.length ? counted(keys.length, "run") : `${whole(order.length)} of ${counted(keys.length, "run")}`;
  holder.scrollTop = 0;
  fillWindow();
}

function row(i) {
  const key = keys[i].slice(0, 8);
  return html("tr", {}, html("td", { title: keys[i] }, links[i] ? html("a", { href: links[i] }, key) : key), shown().map(({ values, kind }) => {
    const text = written(values[i]);
    return html("td", { class: kind, title: text.length > 24 ? text : null }, text);
  }));
}

/** Draws the rows that are seen, and gaps as high as those before and after them. */
function fillWindow() {
  const from = Math.max(0, Math.floor(holder.scrollTop / ROW_PX) - BEYOND);
  const to = Math.min(order.length, Math.ceil((holder.scrollTop + holder.clientHeight) / ROW_PX) + BEYOND);
  const gap = (n) => html("tr", { class: "gap", "aria-hidden": "true" }, html("td", { style: `height: ${n * ROW_PX}px`, colspan: shown().length + 1 }));
  body.replaceChildren(gap(from), ...order.slice(from, to).map(row), gap(order.length - to));
}

/** Head of a column; clicks sort upwards, downwards, and as the rows came. */
function head(column) {
  const isSorted = sorted === column, button = html("button", { type: "button", title: column.description }, `${column.name}${isSorted ? (isDown ? " ▾" : " ▴") : ""}`);
  button.addEventListener("click", () => {
    [sorted, isDown] = !isSorted ? [column, false] : isDown ? [null, false] : [column, true];
    drawTable();
  });
  return html("th", { scope: "col", class: column.kind, "aria-sort": isSorted ? (isDown ? "descending" : "ascending") : "none" }, button);
}

function filter(column) {
  const box = html("input", { type: "text", "aria-label": `Filter ${column.name}`, value: column.filter });
  box.addEventListener("input", () => { column.filter = box.value; arrange(); });
  return html("td", {}, box);
}

function drawTable() {
  table.replaceChildren(html("thead", {}, html("tr", {}, html("th", { scope: "col" }, "run"), shown().map(head)), html("tr", {}, html("td"), shown().map(filter))), body);
  arrange();
}

document.querySelectorAll("#runs .columns input").forEach((box, i) => box.addEventListener("change", () => { columns[i].shown = box.checked; drawTable(); }));
byId("runs-clear").addEventListener("click", () => { columns.forEach((column) => { column.filter = ""; }); drawTable(); });
holder.addEventListener("scroll", fillWindow);
return { draw: drawTable, fit: fillWindow };
