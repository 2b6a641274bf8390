/** What is marked on the chart, by time. */
function marks() {
  const found = [];
  const add = (t, label, colour, would = false) => { if (known(t)) found.push({ t, label, colour, would }); };
  add(timeOf("opened"), "conflict opens", "var(--warn)");
  for (const event of failures) add(event.t, "failure", "var(--warn)");
  add(timeOf("runway_incursion"), "runway incursion", "var(--bad)");
  add(timeOf("loss_of_separation"), "separation lost", "var(--bad)");
  add(timeOf("nmac"), "NMAC", "var(--bad)");
  add(timeOf("collision"), "collision", "var(--bad)");
  for (const [phase, margin, label] of [["tcas_ta", "margin_over_tcas_ta_s", "TCAS TA"], ["tcas_ra", "margin_over_tcas_ra_s", "TCAS RA"]]) {
    const t = timeOf(phase);
    if (known(t)) add(t, label, "var(--c3)");
    else if (summary && known(summary[margin])) add(summary.t_first_warning_s + summary[margin], `${label} if unwarned`, "var(--c3)", true);
  }
  if (summary) add(summary.t_first_warning_s, "first warning", "var(--accent)");
  if (closest) add(closest.t_s, "closest approach", "var(--ink)");
  return found.filter((mark) => mark.t <= endS).sort((a, b) => a.t - b.t);
}

function drawSeparation() {
  const holder = byId("separation");
  if (!separations) return holder.replaceChildren(dim("There is no pair whose separation could be drawn."));
  const found = marks(), area = { left: 70, right: widthOf(holder) - 62 }, x = timeScale(area);
  const head = rows(found, x, area) * 16 + 8, panelHeight = 165, gap = 20;
  const upper = { ...area, top: head, bottom: head + panelHeight }, lower = { ...area, top: head + panelHeight + gap, bottom: head + 2 * panelHeight + gap };
  const chart = canvas(holder, lower.bottom + 44, "Horizontal and vertical separation against time"), { root } = chart;
  if (closeUp) {
    const apart = separations.horizontal_nm.map((value) => Math.max(value * METRE_PER_NM, 1));
    drawPanel(root, upper, x, decades(apart, upper), apart, "Horizontal (m)");
    drawPanel(root, lower, x, upFrom0(separations.vertical_ft, lower), separations.vertical_ft, "Vertical (ft)", "Time (s)");
  } else {
    drawPanel(root, upper, x, upFrom0([...separations.horizontal_nm, minimumNm], upper), separations.horizontal_nm, "Horizontal (NM)", "", minimumNm, `${minimumNm} NM`);
    drawPanel(root, lower, x, upFrom0([...separations.vertical_ft, minimumFt], lower), separations.vertical_ft, "Vertical (ft)", "Time (s)", minimumFt, feet(minimumFt));
  }
  const both = { ...area, top: upper.top, bottom: lower.bottom };
  root.append(...found.map((mark) => line(mark.px, mark.row * 16 + 4, mark.px, both.bottom, { class: mark.would ? "mark would" : "mark", stroke: mark.colour })),
    ...found.map((mark) => label(mark.labelX, mark.row * 16 + 14, mark.label, { class: "halo", "text-anchor": mark.flip ? "end" : "start", style: `fill: ${mark.colour}` })));
  return followPointer(chart, both, x, (t) => {
    const apart = apartAt(t);
    return [...(apart ? apartText(apart).map((text, i) => `${text} ${["horizontally", "vertically"][i]}`) : []), ...nearby(found, t, area).map((mark) => `${mark.label}, ${seconds(mark.t)}`)];
  });
}

/** A logarithmic scale over whole decades. */
function decades(values, area) {
  const { low, high } = lowAndHigh(values), from = Math.floor(Math.log10(low)), to = Math.max(Math.ceil(Math.log10(high)), from + 1);
  const linear = scale(from, to, area.bottom, area.top, 1);
  return Object.assign((value) => linear(Math.log10(value)), { ticks: linear.ticks.map((power) => 10 ** power), format: whole });
}

function drawPanel(root, area, x, y, values, name, nameX, minimum, minimumText) {
  drawWindow(root, x, area);
  axes(root, area, x, y, nameX, name);
  if (minimum) root.append(line(area.left, y(minimum), area.right, y(minimum), { class: "minimum" }), label(area.right + 6, y(minimum) + 4, minimumText, { "text-anchor": "start", style: "fill: var(--bad)" }));
  root.append(svg("path", { class: "line", stroke: "var(--ink)", d: path(separations.t, values, x, y) }));
}

byId("separation-caption").textContent = pair.length ? `${pair.join(" and ")}${run.pair_is_annotated ? "" : ", the nearest pair"}${closeUp ? ", between centres" : ""}` : "";
fillKey("separation-key", windowKey(), separations && !closeUp && keyItem(keyLine({ class: "minimum" }), "separation minimum"),
  marks().some((mark) => mark.would) && keyItem(keyLine({ class: "mark would", stroke: "var(--c3)" }), "had nobody reacted"));
return { fit: drawSeparation };
