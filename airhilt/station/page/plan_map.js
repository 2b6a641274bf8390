// The airport on the plan: water, runways, taxiways, buildings, and their names.

import { colour } from "./dom.js";
import { runwayNumbers } from "./labels.js";
import { BOLD, FONT_SMALL, line, shape, write } from "./pen.js";

const NAMES_OFF_PX = [14, 30, 46]; // from the end of a runway, where its number is tried

/** Draws an airport, and returns the boxes of the names of its runways. */
export function drawAirport(view, airport) {
  const { pen, scale } = view,
    fill = (outline, ink) => shape(pen, colour(ink), view.pixels(outline)),
    leg = ([e1, n1, e2, n2], ink, width) =>
      line(pen, colour(ink), width, view.pixel([e1, n1]), view.pixel([e2, n2]));
  airport.water.forEach(({ outline }) => fill(outline, "--water"));
  pen.lineCap = "round";
  for (const { legs, width_m } of airport.taxiways)
    for (const one of legs) leg(one, "--taxiway", Math.max(width_m * scale, 1));
  pen.lineCap = "butt";
  airport.runways.forEach((runway) => fill(runway.protected, "--protected"));
  for (const { pavement, width_m } of airport.runways) {
    fill(pavement, "--runway");
    if (width_m * scale < 2)
      line(pen, colour("--runway"), 2, ...view.pixels([...pavement, pavement[0]]));
  }
  airport.buildings.forEach(({ outline }) => fill(outline, "--building"));
  if (scale > 0.1) {
    for (const hold of airport.holds) leg(hold.line, "--warn", 2);
    nameTaxiways(view, airport);
  }
  return nameRunways(view, airport);
}

function nameTaxiways(view, airport) {
  const { pen } = view,
    taken = [],
    long = ([e1, n1, e2, n2]) => Math.hypot(e2 - e1, n2 - n1);
  pen.font = FONT_SMALL;
  pen.textAlign = "center";
  for (const { name, legs } of airport.taxiways.filter((one) => one.name !== "ramp")) {
    const [e1, n1, e2, n2] = legs.reduce((a, b) => (long(b) > long(a) ? b : a)),
      [x, y] = view.pixel([(e1 + e2) / 2, (n1 + n2) / 2]);
    if (taken.some((other) => Math.hypot(other[0] - x, other[1] - y) < 22)) continue;
    taken.push([x, y]);
    write(pen, name.replaceAll("_", " "), x, y + 4, colour("--dim"), colour("--map"));
  }
}

function nameRunways(view, { runways }) {
  const { pen } = view,
    numbers = runwayNumbers(runways, (place) => view.pixel(place), NAMES_OFF_PX, [11, 8], 40);
  pen.font = BOLD;
  pen.textAlign = "center";
  for (const { ident, box } of numbers)
    write(pen, ident, box[0] + 11, box[1] + 12, colour("--ink"), colour("--map"));
  return numbers.map(({ box }) => box);
}
