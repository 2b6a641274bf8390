const section = byId(data.name), drawings = [...section.querySelectorAll("figure.drawing")];
const chosen = {};

/** True if a figure is what is chosen, as far as the choices up to a label go. */
const fits = (figure, labels) => labels.every((label) => figure.choice[label] === chosen[label]);
const labels = data.choices.map((choice) => choice.label);

/** Shows the figure chosen; a value that no figure has any more gives way to one that it has. */
function show() {
  labels.forEach((label, i) => {
    const left = data.figures.filter((figure) => fits(figure, labels.slice(0, i)));
    const values = [...new Set(left.map((figure) => figure.choice[label]))];
    if (!values.includes(chosen[label])) [chosen[label]] = values;
    const select = section.querySelector(`select[data-place="${i}"]`);
    select.replaceChildren(...values.map((value) => html("option", { value }, value)));
    select.value = chosen[label];
    select.parentElement.hidden = values.length < 2 && data.choices[i].values.length < 2;
  });
  data.figures.forEach((figure, i) => { drawings[i].hidden = !fits(figure, labels); });
}

function draw() {
  section.querySelector(".chooser").append(...labels.map((label, i) => {
    const select = html("select", { "data-place": i });
    select.addEventListener("change", () => { chosen[label] = select.value; show(); });
    return html("label", {}, `${label} `, select);
  }));
  show();
}
return { draw };
