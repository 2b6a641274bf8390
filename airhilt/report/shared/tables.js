"use strict";
// Tiles and tables.

function tile(name, value, second, why, tone = "") {
  return html("article", { class: "tile panel" }, html("h3", {}, name), html("div", { class: `value ${tone}` }, value),
    second ? html("div", { class: "second" }, second) : null, why ? html("div", { class: "why" }, why) : null);
}

/** Fills a table; each cell has its column's name for narrow windows, where the heads are not seen. */
function fillTable(table, heads, found) {
  const cell = (children, i) => html("td", { "data-label": heads[i][0], class: heads[i][1] }, ...[children].flat());
  table.replaceChildren(html("thead", {}, html("tr", {}, ...heads.map(([name, kind]) => html("th", { scope: "col", class: kind }, name)))),
    html("tbody", {}, ...found.map(({ t, cells }) => {
      const row = html("tr", { "data-t": t }, ...cells.map(cell));
      row.addEventListener("click", (event) => { if (!event.target.closest("audio, a")) clock.set(t); });
      return row;
    })));
  return [...table.tBodies[0].rows];
}

const timeButton = (t) => html("button", { type: "button", "aria-label": `Show ${fixed(t, 1)} seconds` }, fixed(t, 1));

function plainTable(heads, found, caption) {
  const cell = (tag) => (text, i) => html(tag, { class: heads[i][1], ...(tag === "th" ? { scope: "col" } : {}) }, text);
  return html("table", {}, caption ? html("caption", {}, caption) : null, html("thead", {}, html("tr", {}, ...heads.map(([name]) => name).map(cell("th")))), html("tbody", {}, ...found.map((row) => html("tr", {}, ...row.map(cell("td"))))));
}
