// The airport on the plan: water, runways, taxiways, buildings, and their names.

import { BOLD, FONT_SMALL, colour, write } from "./dom.js";
import { overlap } from "./labels.js";

/** Draws an airport, and returns the boxes of the names of its runways. */
export function drawAirport(view, airport) {
  const { pen } = view,
    shape = (points, fill) => {
      view.path(points, true);
      pen.fillStyle = colour(fill);
      pen.fill();
    };
  airport.water.forEach((water) => shape(water.outline, "--water"));
  pen.lineCap = "round";
  pen.strokeStyle = colour("--taxiway");
  for (const taxiway of airport.taxiways) {
    pen.lineWidth = Math.max(taxiway.width_m * view.scale, 1);
    for (const [e1, n1, e2, n2] of taxiway.legs) {
      view.path([
        [e1, n1],
        [e2, n2],
      ]);
      pen.stroke();
    }
  }
  pen.lineCap = "butt";
  airport.runways.forEach((runway) => shape(runway.protected, "--protected"));
  for (const runway of airport.runways) {
    shape(runway.pavement, "--runway");
    if (runway.width_m * view.scale < 2) {
      pen.strokeStyle = colour("--runway");
      pen.lineWidth = 2;
      pen.stroke();
    }
  }
  airport.buildings.forEach((building) => shape(building.outline, "--building"));
  if (view.scale > 0.1) {
    pen.strokeStyle = colour("--warn");
    pen.lineWidth = 2;
    for (const {
      line: [e1, n1, e2, n2],
    } of airport.holds) {
      view.path([
        [e1, n1],
        [e2, n2],
      ]);
      pen.stroke();
    }
    nameTaxiways(view, airport);
  }
  return nameRunways(view, airport);
}

function nameTaxiways(view, airport) {
  const { pen } = view,
    taken = [];
  pen.font = FONT_SMALL;
  pen.textAlign = "center";
  for (const taxiway of airport.taxiways.filter((one) => one.name !== "ramp")) {
    const long = ([e1, n1, e2, n2]) => Math.hypot(e2 - e1, n2 - n1),
      leg = [...taxiway.legs].sort((a, b) => long(b) - long(a))[0];
    const [x, y] = view.pixel([(leg[0] + leg[2]) / 2, (leg[1] + leg[3]) / 2]);
    if (taken.some((other) => Math.hypot(other[0] - x, other[1] - y) < 22)) continue;
    taken.push([x, y]);
    write(pen, taxiway.name.replaceAll("_", " "), x, y + 4, colour("--dim"), colour("--map"));
  }
}

function nameRunways(view, airport) {
  const { pen } = view,
    names = [];
  pen.font = BOLD;
  pen.textAlign = "center";
  for (const runway of airport.runways) {
    const [a, b] = runway.ends.map((end) => view.pixel(end.start)),
      length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length < 40) continue;
    runway.ends.forEach((end, i) => {
      const [from, to] = i ? [b, a] : [a, b];
      const boxes = [14, 30, 46].map((far) => {
        const x = from[0] - ((to[0] - from[0]) / length) * far,
          y = from[1] - ((to[1] - from[1]) / length) * far;
        return [x - 11, y - 8, x + 11, y + 8];
      });
      const box = boxes.find((one) => !names.some((other) => overlap(one, other))) ?? boxes[0];
      names.push(box);
      write(pen, end.ident, box[0] + 11, box[1] + 12, colour("--ink"), colour("--map"));
    });
  }
  return names;
}
