const number = (value) => (typeof value === "number" ? minus(String(Number(value.toPrecision(7)))) : String(value));
const heads = [["Perturbed", "text"], ["Nominal", "number"], ["Realised", "number"], ["Difference", "number"]];
fillTable(byId("draws"), heads, data.map(({ path, nominal, realised }) => [path, ...[nominal, realised, realised - nominal].map(number)]), { empty: "The scenario has no perturbations." });
const ended = new Map(run.events.filter((event) => event.kind === "actor_ended").map((event) => [event.who, `${event.text}, at ${seconds(event.t)}`]));
fillTable(byId("ended"), [["Actor ended"], ["Why", "text"]], [...ended], { empty: "None: all went on to the end of the run." });
