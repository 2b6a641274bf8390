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
  if (!separations) { holder.replaceChildren(html("p", { class: "dim" }, "There is no pair whose separation could be drawn.")); return () => {}; }
  const width = Math.max(holder.clientWidth, 240), found = marks();
  const area = { left: 70, right: width - 62 }, x = timeScale(area);
  const head = rows(found, x, area) * 16 + 8, panelHeight = 165, gap = 20;
  const upper = { ...area, top: head, bottom: head + panelHeight }, lower = { ...area, top: head + panelHeight + gap, bottom: head + 2 * panelHeight + gap };
  const chart = canvas(holder, lower.bottom + 44, "Horizontal and vertical separation against time"), { root } = chart;
  if (closeUp) {
    const apart = separations.horizontal_nm.map((value) => Math.max(value * METRE_PER_NM, 1));
    drawPanel(root, upper, x, decades(apart, upper), apart, null, "Horizontal (m)", true);
    drawPanel(root, lower, x, upFrom0(separations.vertical_ft, lower), separations.vertical_ft, null, "Vertical (ft)", false);
  } else {
    drawPanel(root, upper, x, upFrom0([...separations.horizontal_nm, minimumNm], upper), separations.horizontal_nm, [minimumNm, `${minimumNm} NM`], "Horizontal (NM)", true);
    drawPanel(root, lower, x, upFrom0([...separations.vertical_ft, minimumFt], lower), separations.vertical_ft, [minimumFt, feet(minimumFt)], "Vertical (ft)", false);
  }
  const both = { ...area, top: upper.top, bottom: lower.bottom };
  for (const mark of found) {
    root.append(svg("line", { class: mark.would ? "mark would" : "mark", stroke: mark.colour, x1: mark.px, x2: mark.px, y1: mark.row * 16 + 4, y2: both.bottom }));
  }
  for (const mark of found) {
    root.append(svg("text", { class: "halo", x: mark.labelX, y: mark.row * 16 + 14, "text-anchor": mark.flip ? "end" : "start", style: `fill: ${mark.colour}` }, mark.label));
  }
  return followPointer(chart, both, x, (t) => {
    const apart = apartAt(t), near = found.filter((mark) => Math.abs(mark.t - t) < 4 * endS / (area.right - area.left));
    return [...(apart ? apartText(apart).map((text, i) => `${text} ${["horizontally", "vertically"][i]}`) : []), ...near.map((mark) => `${mark.label}, ${seconds(mark.t)}`)];
  });
}

/** A logarithmic scale over whole decades. */
function decades(values, area) {
  const { low, high } = lowAndHigh(values), from = Math.floor(Math.log10(low)), to = Math.max(Math.ceil(Math.log10(high)), from + 1);
  const linear = scale(from, to, area.bottom, area.top), y = (value) => linear(Math.log10(value));
  y.ticks = Array.from({ length: to - from + 1 }, (_, i) => 10 ** (from + i));
  y.format = whole;
  return y;
}

function drawPanel(root, area, x, y, values, minimum, name, noX) {
  drawWindow(root, x, area);
  axes(root, area, x, y, { x: "Time (s)", y: name }, noX);
  if (minimum) root.append(svg("line", { class: "minimum", x1: area.left, x2: area.right, y1: y(minimum[0]), y2: y(minimum[0]) }),
    svg("text", { x: area.right + 6, y: y(minimum[0]) + 4, style: "fill: var(--bad)" }, minimum[1]));
  root.append(svg("path", { class: "line", stroke: "var(--ink)", d: path(separations.t, values, x, y) }));
}

function drawKey() {
  byId("separation-caption").textContent = pair.length ? `${pair.join(" and ")}${run.pair_is_annotated ? "" : ", the nearest pair"}${closeUp ? ", between centres" : ""}` : "";
  byId("separation-key").append(...windowKey());
  if (separations && !closeUp) byId("separation-key").append(keyItem(keyLine({ class: "minimum" }), "separation minimum"));
  if (marks().some((mark) => mark.would)) byId("separation-key").append(keyItem(keyLine({ class: "mark would", stroke: "var(--c3)" }), "had nobody reacted"));
}

return { draw: drawKey, fit: drawSeparation };
