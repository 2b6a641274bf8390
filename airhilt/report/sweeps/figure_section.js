const section = byId(data.name), drawings = [...section.querySelectorAll("figure.drawing")], selects = [...section.querySelectorAll("select")];

/** Shows the figure chosen; a value that no figure has any more gives way to one that it has. */
function show() {
  let left = data.figures;
  data.choices.forEach(({ label, values: all }, i) => {
    const values = [...new Set(left.map((figure) => figure.choice[label]))], chosen = values.includes(selects[i].value) ? selects[i].value : values[0];
    selects[i].replaceChildren(...values.map((value) => html("option", { value }, value)));
    selects[i].value = chosen;
    selects[i].parentElement.hidden = values.length < 2 && all.length < 2;
    left = left.filter((figure) => figure.choice[label] === chosen);
  });
  data.figures.forEach((figure, i) => { drawings[i].hidden = !left.includes(figure); });
}

selects.forEach((select) => select.addEventListener("change", show));
show();
