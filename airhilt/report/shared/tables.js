// Tiles and tables.

function tile(name, value, second, why, tone = "") {
  return html("article", { class: "tile panel" }, html("h3", {}, name), html("div", { class: `value ${tone}` }, value),
    second && html("div", { class: "second" }, second), why && html("div", { class: "why" }, why));
}
const timeButton = (t) => html("button", { type: "button", "data-t": t, "aria-label": `Show ${fixed(t, 1)} seconds` }, fixed(t, 1));
const explained = (name, meaning) => [html("b", {}, name), dim(meaning, "div")];
const swatch = (colour) => html("span", { class: "swatch", style: `background: ${colour}` });
const severityText = (severity) => html("span", { class: `severity-${severity}` }, severity);
const coloured = (callsign, tag = "b") => html(tag, { style: `color: ${colourOf(callsign)}` }, callsign);

/**
 * Fills a table. A head is a name and the class of its column, of which `row` heads rows. A row is its
 * cells, or `{ t, cells }`, of which a click shows the time. Columns from `always` on are left out where
 * no row has a value; a table without rows says why in `empty`.
 */
function fillTable(table, heads, found, { always = heads.length, empty } = {}) {
  const all = found.map((row) => (Array.isArray(row) ? { cells: row } : row)), isEmpty = (cell) => [cell].flat().every((part) => !known(part) || part === "");
  const kept = (cells) => cells.filter((_, i) => i < always || all.some((row) => !isEmpty(row.cells[i])));
  const cell = ([name, kind], children) => html(kind === "row" ? "th" : "td", { "data-label": name, class: kind, scope: kind === "row" ? kind : null }, children);
  table.replaceChildren(html("thead", {}, html("tr", {}, kept(heads).map(([name, kind]) => html("th", { scope: "col", class: kind }, name)))),
    html("tbody", {}, all.map(({ t, cells }) => html("tr", { "data-t": t }, kept(heads.map((head, i) => cell(head, cells[i]))))),
      empty && !all.length && html("tr", {}, html("td", { colspan: heads.length }, empty))));
  return table;
}

/** Fills a table of states, one row for each actor; returns what shows the states of a time. */
function fillStates(table, heads, columns, actors) {
  fillTable(table, [...heads, ...columns], actors.map(({ cells }) => [...cells, ...columns.map(() => "")]));
  return (t) => actors.forEach(({ at }, i) => {
    const state = at(t);
    columns.forEach(([, , read], k) => { table.tBodies[0].rows[i].cells[heads.length + k].textContent = read(state); });
  });
}

/** Marks the latest of the rows that has begun at a time. */
function markCurrent(rows, t) {
  const current = rows.findLast((row) => !row.hidden && Number(row.dataset.t) <= t + 1e-6);
  rows.forEach((row) => row.classList.toggle("current", row === current));
}
