const ROW_PX = 30, BEYOND = 12;
const { columns, keys, links } = data;
const filters = columns.map(() => "");
let order = keys.map((_, i) => i), sorted = { column: -1, down: false };
const table = byId("runs-table"), holder = byId("runs-window"), body = html("tbody");

const isNumber = (column) => column.values.some((value) => typeof value === "number");
columns.forEach((column) => { column.number = isNumber(column); });

function written(value) {
  if (!known(value)) return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  return typeof value === "number" ? minus(String(value)) : value;
}

/** Returns a function that says whether a value is what a filter asks for. */
function wanted(text) {
  const asked = text.trim().toLowerCase();
  if (asked === "-") return (value) => !known(value) || value === "";
  const range = asked.match(/^(-?[\d.]+)\s*\.\.\s*(-?[\d.]+)$/), bound = asked.match(/^([<>]=?|=)\s*(-?[\d.]+(?:e-?\d+)?)$/);
  if (range) return (value) => typeof value === "number" && value >= +range[1] && value <= +range[2];
  if (bound) {
    const limit = +bound[2];
    const compare = { "<": (v) => v < limit, "<=": (v) => v <= limit, ">": (v) => v > limit, ">=": (v) => v >= limit, "=": (v) => v === limit }[bound[1]];
    return (value) => typeof value === "number" && compare(value);
  }
  return (value) => written(value).toLowerCase().includes(asked);
}

/** Returns a comparison of two rows; what is empty comes last either way. */
function comparison({ column, down }) {
  if (column < 0) return (a, b) => a - b;
  const { values } = columns[column], sign = down ? -1 : 1;
  return (a, b) => {
    const x = values[a], y = values[b];
    if (!known(x) || !known(y)) return (known(y) - known(x)) || a - b;
    return sign * (typeof x === "string" ? x.localeCompare(y) : x - y) || a - b;
  };
}

function arrange() {
  const tests = filters.map((text, i) => [columns[i].values, text.trim() && wanted(text)]).filter(([, test]) => test);
  order = keys.map((_, i) => i).filter((i) => tests.every(([values, test]) => test(values[i]))).sort(comparison(sorted));
  byId("runs-count").textContent = order.length === keys.length ? counted(keys.length, "run") : `${whole(order.length)} of ${counted(keys.length, "run")}`;
  holder.scrollTop = 0;
  fillWindow();
}

const shown = () => columns.map((column, i) => [column, i]).filter(([column]) => column.shown);

function row(i) {
  const key = links[i] ? html("a", { href: links[i] }, keys[i].slice(0, 8)) : keys[i].slice(0, 8);
  return html("tr", {}, html("td", { title: keys[i] }, key), ...shown().map(([column]) => {
    const text = written(column.values[i]);
    return html("td", { class: column.number ? "number" : null, title: text.length > 24 ? text : null }, text);
  }));
}

/** Draws the rows that are seen, and gaps as high as those before and after them. */
function fillWindow() {
  const from = Math.max(0, Math.floor(holder.scrollTop / ROW_PX) - BEYOND);
  const to = Math.min(order.length, Math.ceil((holder.scrollTop + holder.clientHeight) / ROW_PX) + BEYOND);
  const gap = (n) => html("tr", { class: "gap", "aria-hidden": "true" }, html("td", { style: `height: ${n * ROW_PX}px`, colspan: shown().length + 1 }));
  body.replaceChildren(gap(from), ...order.slice(from, to).map(row), gap(order.length - to));
}

function head([column, i]) {
  const button = html("button", { type: "button", title: column.description }, `${column.name}${sorted.column === i ? (sorted.down ? " ▾" : " ▴") : ""}`);
  button.addEventListener("click", () => {
    sorted = sorted.column !== i ? { column: i, down: false } : sorted.down ? { column: -1, down: false } : { column: i, down: true };
    drawTable();
  });
  const state = sorted.column !== i ? "none" : sorted.down ? "descending" : "ascending";
  return html("th", { scope: "col", class: column.number ? "number" : null, "aria-sort": state }, button);
}

function filter([column, i]) {
  const box = html("input", { type: "text", "aria-label": `Filter ${column.name}`, value: filters[i] });
  box.addEventListener("input", () => { filters[i] = box.value; arrange(); });
  return html("td", {}, box);
}

function drawTable() {
  table.replaceChildren(html("thead", {}, html("tr", {}, html("th", { scope: "col" }, "run"), ...shown().map(head)),
    html("tr", {}, html("td"), ...shown().map(filter))), body);
  arrange();
}

function draw() {
  byId("runs-columns").append(...columns.map((column) => {
    const box = html("input", { type: "checkbox" });
    box.checked = column.shown;
    box.addEventListener("change", () => { column.shown = box.checked; drawTable(); });
    return html("label", { title: column.description }, box, ` ${column.name}`);
  }));
  byId("runs-clear").addEventListener("click", () => { filters.fill(""); drawTable(); });
  holder.addEventListener("scroll", fillWindow);
  drawTable();
}
return { draw, fit() { fillWindow(); } };
