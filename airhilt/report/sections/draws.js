function drawTables() {
  const number = (value) => (typeof value === "number" ? minus(String(Number(value.toPrecision(7)))) : String(value));
  const draws = data.map((draw) => html("tr", {}, html("td", { class: "text" }, draw.path), ...[draw.nominal, draw.realised, draw.realised - draw.nominal].map((value) => html("td", { class: "number" }, number(value)))));
  byId("draws").append(...(draws.length ? draws : [html("tr", {}, html("td", { colspan: 4 }, "The scenario has no perturbations."))]));
  const ended = new Map(run.events.filter((event) => event.kind === "actor_ended").map((event) => [event.who, `${event.text}, at ${seconds(event.t)}`]));
  const rowsOf = [...ended].map(([actor, why]) => html("tr", {}, html("td", {}, actor), html("td", { class: "text" }, why)));
  byId("ended").append(...(rowsOf.length ? rowsOf : [html("tr", {}, html("td", { colspan: 2 }, "None: all went on to the end of the run."))]));
}

return { draw: drawTables };
