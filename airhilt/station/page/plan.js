// The plan: runways and taxiways, range rings, tracks, and each actor with its data block.

import { BOLD, FONT, byId, colour, html, onSize, write } from "./dom.js";
import { freeBox, level, overlap } from "./labels.js";
import { METRE_PER_NM } from "./model.js";
import { drawPlots, inWords } from "./plan_radar.js";
import { symbolOf } from "./symbols.js";
import { fixed, metres, whole } from "./words.js";

const HISTORY_DOTS = 8;
const FONT_SMALL = FONT.replace("12px", "11px");
const LEADERS_S = [0, 10, 30, 60, 120];
const MOST_POINTS = 1500; // of a track that are drawn
const MOST_NAMED = 30; // actors in words
const RENEWED_MS = 1000; // after which tracks that grow are drawn again
const ROOM = 90; // pixels for the data blocks of who is at the edge
// Of the width, by which more is shown than is needed, so that the view changes seldom.
const SPARE = 0.08;
const LONGEST_SHOWN_M = 900_000;

export class Plan {
  #canvas = byId("plan");
  #run;
  #clock;
  #size = null;
  #centre = [0, 0];
  #scale = 0.01; // pixels a metre
  #fitted = "all";
  #camera = null;
  #dragged = null;
  #names = []; // boxes of the names of the runways, which data blocks are not to cover
  #ringNames = []; // those of the range rings
  #still = null; // picture of what does not move
  #stillSince = 0;
  #described = 0;
  #describing = null; // a timer, after which the plan is told in words

  constructor(run, clock) {
    this.#run = run;
    this.#clock = clock;
    this.#views();
    this.#controls();
    onSize(this.#canvas, (pen, width, height) => {
      const was = this.#size;
      this.#size = { pen, width, height };
      if (!was || this.#fitted) this.fit(this.#fitted ?? "all");
      else this.redraw();
    });
  }

  /**
   * Draws a camera: place in m, heading, field of view, and bearings of what it has detected, in
   * rad; null for none.
   */
  setCamera(cone) {
    this.#camera = cone;
    this.draw();
  }

  /** Takes in that a live run has an airport now. */
  renew() {
    this.#views();
    this.fitFirst();
  }

  /** Shows what one begins with: a driver the airport, all others all traffic. */
  fitFirst() {
    const { airport, ownCategory } = this.#run;
    this.fit(airport && ownCategory === "vehicle" ? "airport" : "all");
  }

  /** Keeps all traffic of a live run in view, unless somebody looks elsewhere. */
  keepFitted() {
    if (this.#fitted !== "all" || !this.#size) return;
    const { width, height } = this.#size,
      { east, north } = this.#run.bounds,
      [left, bottom] = this.#pixel([east[0], north[0]]),
      [right, top] = this.#pixel([east[1], north[1]]);
    const edge = ROOM / 2 - 1,
      sees = left >= edge && right <= width - edge && top >= edge && bottom <= height - edge;
    if (!sees) this.#fitTo("all", SPARE);
  }

  #views() {
    const options = [["all", "all traffic"]];
    if (this.#run.airport) options.push(["airport", "airport"]);
    if (this.#closest()) options.push(["conflict", "conflict"]);
    byId("plan-view").replaceChildren(
      ...options.map(([value, text]) => html("option", { value }, text)),
      html("option", { value: "", hidden: true }, "free"),
    );
    byId("plan-leader").replaceChildren(
      ...LEADERS_S.map((s) =>
        html(
          "option",
          { value: s, selected: s === (this.#run.airport ? 30 : 60) },
          s ? `${s} s ahead` : "no leaders",
        ),
      ),
    );
  }

  #controls() {
    const canvas = this.#canvas;
    byId("plan-view").addEventListener("change", (event) => this.fit(event.target.value));
    for (const id of ["plan-leader", "plan-rings", "plan-tracks"])
      byId(id).addEventListener("change", () => this.redraw());
    byId("plan-in").addEventListener("click", () => this.zoom(1.5));
    byId("plan-out").addEventListener("click", () => this.zoom(1 / 1.5));
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.zoom(Math.exp(-event.deltaY / 400), event.offsetX, event.offsetY);
      },
      { passive: false },
    );
    canvas.addEventListener("pointerdown", (event) => {
      this.#dragged = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!this.#dragged) return;
      this.#move(event.clientX - this.#dragged[0], event.clientY - this.#dragged[1]);
      this.#dragged = [event.clientX, event.clientY];
    });
    for (const end of ["pointerup", "pointercancel"])
      canvas.addEventListener(end, () => {
        this.#dragged = null;
      });
    canvas.addEventListener("keydown", (event) => {
      const steps = {
        ArrowLeft: [60, 0],
        ArrowRight: [-60, 0],
        ArrowUp: [0, 60],
        ArrowDown: [0, -60],
      }[event.key];
      if (!steps) return;
      event.preventDefault();
      event.stopPropagation();
      this.#move(...steps);
    });
  }

  #free() {
    this.#fitted = null;
    byId("plan-view").value = "";
  }

  #move(dx, dy) {
    this.#free();
    this.#centre = [this.#centre[0] - dx / this.#scale, this.#centre[1] + dy / this.#scale];
    this.redraw();
  }

  /** Zooms about a point of the canvas, by default its middle. */
  zoom(factor, px = this.#size?.width / 2, py = this.#size?.height / 2) {
    if (!this.#size) return;
    const { width, height } = this.#size,
      scale = Math.min(
        Math.max(this.#scale * factor, Math.min(width, height) / LONGEST_SHOWN_M),
        20,
      );
    const shift = 1 / this.#scale - 1 / scale;
    this.#free();
    this.#centre = [
      this.#centre[0] + (px - width / 2) * shift,
      this.#centre[1] - (py - height / 2) * shift,
    ];
    this.#scale = scale;
    this.redraw();
  }

  /**
   * Shows all traffic of the whole run, the airport, or the surroundings of the closest approach.
   */
  fit(name) {
    this.#fitTo(name);
    this.redraw();
  }

  #fitTo(name, spare = 0) {
    if (!this.#size) return;
    const points =
      name === "airport" ? this.#field() : name === "conflict" ? this.#closest() : this.#field();
    const begin =
      name === "all"
        ? this.#run.bounds
        : { east: [Infinity, -Infinity], north: [Infinity, -Infinity] };
    const range = (i, known) =>
      points.reduce(
        ([low, high], point) => [Math.min(low, point[i]), Math.max(high, point[i])],
        known,
      );
    const found = [range(0, begin.east), range(1, begin.north)],
      [[west, east], [south, north]] =
        found[0][0] <= found[0][1]
          ? found
          : [
              [-1e4, 1e4],
              [-1e4, 1e4],
            ];
    const { width, height } = this.#size;
    this.#centre = [(west + east) / 2, (south + north) / 2];
    this.#scale =
      Math.min(
        Math.max(width - ROOM, 80) / Math.max(east - west, 200),
        Math.max(height - ROOM, 80) / Math.max(north - south, 200),
      ) *
      (1 - spare);
    this.#still = null;
    this.#fitted = name;
    byId("plan-view").value = name;
  }

  #field() {
    return this.#run.airport ? this.#run.airport.runways.flatMap((runway) => runway.pavement) : [];
  }

  #closest() {
    const t = this.#run.summary?.closest_approach?.t_s,
      pair = (this.#run.pair ?? []).map((name) => this.#run.track(name));
    if (t === undefined || t === null || pair.length < 2 || pair.some((track) => !track))
      return null;
    return pair.flatMap((track) =>
      [-20, 0, 20].map((shift) =>
        track.place(Math.min(Math.max(t + shift, track.first), track.last)),
      ),
    );
  }

  #pixel([east, north]) {
    const { width, height } = this.#size;
    return [
      width / 2 + (east - this.#centre[0]) * this.#scale,
      height / 2 - (north - this.#centre[1]) * this.#scale,
    ];
  }

  #path(points, close = false) {
    const { pen } = this.#size;
    pen.beginPath();
    points.forEach((point, i) => {
      const [x, y] = this.#pixel(point);
      if (i) pen.lineTo(x, y);
      else pen.moveTo(x, y);
    });
    if (close) pen.closePath();
  }

  /** Draws everything again, because the view, the size or the colours have changed. */
  redraw() {
    this.#still = null;
    this.draw();
  }

  /** Draws what moves, over the picture of what does not. */
  draw() {
    if (!this.#size || document.body.dataset.seat === "pilot") return;
    const { pen, width, height } = this.#size,
      t = this.#clock.t,
      now = performance.now();
    if (!this.#still || (this.#clock.live && now - this.#stillSince > RENEWED_MS))
      this.#renewStill(now);
    pen.drawImage(this.#still, 0, 0, width, height);
    if (!this.#run.airport && byId("plan-rings").checked) this.#drawRings();
    if (this.#camera) this.#drawCamera();
    const states = this.#run.states(t).filter(({ state }) => state.isThere);
    const plots = this.#run.plots.at(t);
    drawPlots(pen, plots, (place) => this.#pixel(place));
    states.forEach(({ track, state }) => this.#drawActor(track, state, t));
    this.#drawBlocks(states, t);
    this.#drawScale();
    if (this.#clock.playing) return;
    const after = this.#clock.following ? this.#described + RENEWED_MS - now : 0;
    clearTimeout(this.#describing);
    // The last picture before the clock stands is told too.
    if (after > 0) this.#describing = setTimeout(() => this.draw(), after);
    if (after > 0) return;
    this.#described = now;
    this.#describe(states, plots);
  }

  /** Draws the airport, the rings about it, and the tracks, and keeps the picture of them. */
  #renewStill(now) {
    const { pen, width, height } = this.#size,
      copy = document.createElement("canvas");
    pen.fillStyle = colour("--map");
    pen.fillRect(0, 0, width, height);
    if (this.#run.airport) this.#drawAirport(this.#run.airport);
    if (this.#run.airport && byId("plan-rings").checked) this.#drawRings();
    if (byId("plan-tracks").checked) this.#drawTracks();
    copy.width = this.#canvas.width;
    copy.height = this.#canvas.height;
    copy.getContext("2d").drawImage(this.#canvas, 0, 0);
    this.#still = copy;
    this.#stillSince = now;
  }

  #drawAirport(airport) {
    const { pen } = this.#size,
      shape = (points, fill) => {
        this.#path(points, true);
        pen.fillStyle = colour(fill);
        pen.fill();
      };
    airport.water.forEach((water) => shape(water.outline, "--water"));
    pen.lineCap = "round";
    pen.strokeStyle = colour("--taxiway");
    for (const taxiway of airport.taxiways) {
      pen.lineWidth = Math.max(taxiway.width_m * this.#scale, 1);
      for (const [e1, n1, e2, n2] of taxiway.legs) {
        this.#path([
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
      if (runway.width_m * this.#scale < 2) {
        pen.strokeStyle = colour("--runway");
        pen.lineWidth = 2;
        pen.stroke();
      }
    }
    airport.buildings.forEach((building) => shape(building.outline, "--building"));
    if (this.#scale > 0.1) {
      pen.strokeStyle = colour("--warn");
      pen.lineWidth = 2;
      for (const {
        line: [e1, n1, e2, n2],
      } of airport.holds) {
        this.#path([
          [e1, n1],
          [e2, n2],
        ]);
        pen.stroke();
      }
      this.#nameTaxiways(airport);
    }
    this.#nameRunways(airport);
  }

  #nameTaxiways(airport) {
    const { pen } = this.#size,
      taken = [];
    pen.font = FONT_SMALL;
    pen.textAlign = "center";
    for (const taxiway of airport.taxiways.filter((one) => one.name !== "ramp")) {
      const long = ([e1, n1, e2, n2]) => Math.hypot(e2 - e1, n2 - n1),
        leg = [...taxiway.legs].sort((a, b) => long(b) - long(a))[0];
      const [x, y] = this.#pixel([(leg[0] + leg[2]) / 2, (leg[1] + leg[3]) / 2]);
      if (taken.some((other) => Math.hypot(other[0] - x, other[1] - y) < 22)) continue;
      taken.push([x, y]);
      write(pen, taxiway.name.replaceAll("_", " "), x, y + 4, colour("--dim"), colour("--map"));
    }
  }

  #nameRunways(airport) {
    const { pen } = this.#size;
    this.#names = [];
    pen.font = BOLD;
    pen.textAlign = "center";
    for (const runway of airport.runways) {
      const [a, b] = runway.ends.map((end) => this.#pixel(end.start)),
        length = Math.hypot(b[0] - a[0], b[1] - a[1]);
      if (length < 40) continue;
      runway.ends.forEach((end, i) => {
        const [from, to] = i ? [b, a] : [a, b];
        const boxes = [14, 30, 46].map((far) => {
          const x = from[0] - ((to[0] - from[0]) / length) * far,
            y = from[1] - ((to[1] - from[1]) / length) * far;
          return [x - 11, y - 8, x + 11, y + 8];
        });
        const box =
          boxes.find((one) => !this.#names.some((other) => overlap(one, other))) ?? boxes[0];
        this.#names.push(box);
        write(pen, end.ident, box[0] + 11, box[1] + 12, colour("--ink"), colour("--map"));
      });
    }
  }

  /** Range rings about the airport, or about the first of the pair. */
  #drawRings() {
    const { pen, width, height } = this.#size,
      own = this.#run.track(this.#run.pair?.[0]) ?? this.#run.tracks[0];
    if (!this.#run.airport && !own) return;
    const [x, y] = this.#pixel(
      this.#run.airport
        ? [0, 0]
        : own.place(Math.min(Math.max(this.#clock.t, own.first), own.last)),
    );
    const unit = METRE_PER_NM * this.#scale,
      step = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, 100].find((nm) => nm * unit > 70) ?? 200;
    const most = Math.hypot(
      Math.max(Math.abs(x), Math.abs(width - x)),
      Math.max(Math.abs(y), Math.abs(height - y)),
    );
    this.#ringNames = [];
    pen.font = FONT_SMALL;
    pen.textAlign = "left";
    const least = Math.max(
      Math.hypot(Math.max(-x, 0, x - width), Math.max(-y, 0, y - height)) - step * unit,
      0,
    );
    for (
      let i = Math.max(Math.floor(least / unit / step), 1);
      i * step * unit < most && i < least / unit / step + 60;
      i += 1
    ) {
      const nm = i * step;
      pen.beginPath();
      pen.arc(x, y, nm * unit, 0, 2 * Math.PI);
      pen.strokeStyle = colour("--ring");
      pen.lineWidth = 1;
      pen.stroke();
      this.#nameRing(`${Number(nm.toFixed(2))} NM`, this.#onRing(x, y, nm * unit));
    }
  }

  #nameRing(name, place) {
    if (!place) return;
    const [left, bottom] = place;
    this.#ringNames.push([left - 2, bottom - 11, left + 42, bottom + 3]);
    write(this.#size.pen, name, left, bottom, colour("--dim"), colour("--map"));
  }

  /**
   * Where the name of a ring can be read: at its top, or else at another place of it that is seen;
   * null if there is none.
   */
  #onRing(x, y, radius) {
    const { width, height } = this.#size;
    for (const degrees of [0, 45, 315, 90, 270, 135, 225, 180]) {
      const angle = (degrees * Math.PI) / 180,
        left = x + radius * Math.sin(angle) + 4,
        bottom = y - radius * Math.cos(angle) - 3;
      if (left > 4 && left + 46 < width && bottom > 16 && bottom < height - 34)
        return [left, bottom];
    }
    return null;
  }

  #drawCamera() {
    const { pen } = this.#size,
      { place, heading, fov, bearings } = this.#camera,
      [x, y] = this.#pixel(place);
    const reach = Math.max(3000 * this.#scale, 40),
      from = heading - fov / 2 - Math.PI / 2;
    pen.beginPath();
    pen.moveTo(x, y);
    pen.arc(x, y, reach, from, from + fov);
    pen.closePath();
    pen.strokeStyle = colour("--accent");
    pen.setLineDash([5, 4]);
    pen.lineWidth = 1.2;
    pen.stroke();
    pen.setLineDash([]);
    pen.strokeStyle = colour("--warn");
    for (const bearing of bearings) {
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x + 1.5 * reach * Math.sin(bearing), y - 1.5 * reach * Math.cos(bearing));
      pen.stroke();
    }
  }

  #drawTracks() {
    const { pen } = this.#size;
    pen.lineWidth = 1;
    pen.setLineDash([2, 3]);
    for (const track of this.#run.tracks) {
      const step = Math.ceil(track.t.length / MOST_POINTS) || 1,
        points = [];
      for (let i = track.t.length - 1; i >= 0; i -= step)
        points.push([track.east[i], track.north[i]]);
      this.#path(points);
      pen.strokeStyle = colour(track.colour);
      pen.stroke();
    }
    pen.setLineDash([]);
  }

  #drawActor(track, state, t) {
    const { pen } = this.#size,
      [x, y] = this.#pixel([state.east, state.north]),
      ink = colour(track.colour);
    if (!state.ended) this.#drawMotion(track, state, t, x, y, ink);
    if (state.ended) {
      pen.strokeStyle = ink;
      pen.lineWidth = 2.2;
      pen.beginPath();
      for (const side of [-1, 1]) {
        pen.moveTo(x - 5, y - 5 * side);
        pen.lineTo(x + 5, y + 5 * side);
      }
      pen.stroke();
      return;
    }
    const severity = this.#run.severityOf(track.callsign, t);
    if (severity) this.#drawRing(x, y, severity);
    const { shape, least } = symbolOf(track.category);
    const size = Math.max(((track.length_m ?? 0) * this.#scale) / 2, least),
      sin = Math.sin(state.heading),
      cos = Math.cos(state.heading);
    pen.beginPath();
    shape.forEach(([right, back], i) => {
      const px = x + size * (right * cos - back * sin),
        py = y + size * (right * sin + back * cos);
      if (i) pen.lineTo(px, py);
      else pen.moveTo(px, py);
    });
    pen.closePath();
    pen.fillStyle = ink;
    pen.strokeStyle = colour("--map");
    pen.lineWidth = 1;
    pen.fill();
    pen.stroke();
  }

  /** History dots behind an actor, and its velocity leader before it. */
  #drawMotion(track, state, t, x, y, ink) {
    const { pen } = this.#size,
      every = this.#run.airport ? 3 : 5;
    pen.fillStyle = ink;
    for (let i = 1; i <= HISTORY_DOTS; i += 1) {
      const then = t - i * every;
      if (then < track.first) break;
      const [px, py] = this.#pixel(track.place(then));
      if (Math.hypot(px - x, py - y) < 3) continue;
      pen.beginPath();
      pen.arc(px, py, 2.2 - i * 0.12, 0, 2 * Math.PI);
      pen.fill();
    }
    const ahead = Number(byId("plan-leader").value) * state.speed;
    if (ahead * this.#scale < 6) return;
    const [ex, ey] = this.#pixel([
      state.east + ahead * Math.sin(state.course),
      state.north + ahead * Math.cos(state.course),
    ]);
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(ex, ey);
    pen.strokeStyle = ink;
    pen.lineWidth = 1.4;
    pen.stroke();
  }

  #drawRing(x, y, severity) {
    const { pen } = this.#size,
      sides = { WARNING: 4, CAUTION: 3 }[severity] ?? 40,
      turn = severity === "WARNING" ? Math.PI / 4 : -Math.PI / 2;
    pen.beginPath();
    for (let i = 0; i <= sides; i += 1) {
      const angle = turn + (i / sides) * 2 * Math.PI,
        reach = sides === 3 ? 25 : 20;
      if (i) pen.lineTo(x + reach * Math.cos(angle), y + reach * Math.sin(angle));
      else pen.moveTo(x + reach * Math.cos(angle), y + reach * Math.sin(angle));
    }
    pen.strokeStyle = colour(
      { WARNING: "--bad", CAUTION: "--warn", ADVISORY: "--accent" }[severity] ?? "--dim",
    );
    pen.lineWidth = 2;
    pen.stroke();
  }

  /** Data blocks, each where it covers no other. */
  #drawBlocks(states, t) {
    const { pen, width, height } = this.#size;
    const taken = states.map(({ state }) => {
      const [x, y] = this.#pixel([state.east, state.north]);
      return [x - 9, y - 9, x + 9, y + 9];
    });
    taken.push(...this.#names, ...this.#ringNames);
    pen.textAlign = "left";
    for (const { track, state } of states) {
      const [x, y] = this.#pixel([state.east, state.north]);
      if (x < -20 || y < -20 || x > width + 20 || y > height + 20) continue;
      const severity = state.ended ? null : this.#run.severityOf(track.callsign, t),
        lines = this.#block(track, state, severity);
      const wide =
          Math.max(
            ...lines.map((line, i) => {
              pen.font = i ? FONT : BOLD;
              return pen.measureText(line).width;
            }),
          ) + 14,
        high = lines.length * 14 + 2;
      const box = freeBox(this.#size, [x, y], [wide, high], taken);
      taken.push(box);
      pen.strokeStyle = colour("--dim");
      pen.lineWidth = 1;
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(Math.min(Math.max(x, box[0]), box[2]), Math.min(Math.max(y, box[1]), box[3]));
      pen.stroke();
      lines.forEach((line, i) => {
        pen.font = i ? FONT : BOLD;
        const ink =
          severity && i === lines.length - 1
            ? colour(
                severity === "WARNING" ? "--bad" : severity === "CAUTION" ? "--warn" : "--accent",
              )
            : colour(i ? "--ink" : track.colour);
        write(pen, line, box[0] + 2, box[1] + 12 + i * 14, ink, colour("--map"));
      });
      if (!state.ended && !state.onGround && Math.abs(state.rate) > 150)
        this.#arrow(
          box[0] + 2 + pen.measureText(level(state.altitude)).width + 6,
          box[1] + 22,
          state.rate > 0,
        );
    }
  }

  #block(track, state, severity) {
    if (state.ended) return [track.callsign, "ended"];
    const knots = whole((state.speed * 3600) / METRE_PER_NM);
    const second = state.onGround
      ? `${state.phase || "ground"} ${knots} kt`
      : `${level(state.altitude)}     ${knots} kt`;
    return severity ? [track.callsign, second, severity] : [track.callsign, second];
  }

  #arrow(x, y, up) {
    const { pen } = this.#size,
      side = up ? 1 : -1;
    pen.beginPath();
    pen.moveTo(x, y - 5 * side);
    pen.lineTo(x + 4, y + 4 * side);
    pen.lineTo(x - 4, y + 4 * side);
    pen.closePath();
    pen.fillStyle = colour("--ink");
    pen.fill();
  }

  #drawScale() {
    const { pen, height } = this.#size,
      near = this.#scale * METRE_PER_NM > 600,
      unit = near ? 1 : METRE_PER_NM;
    const value =
        [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].findLast(
          (one) => one * unit * this.#scale < 130,
        ) ?? 0.1,
      long = value * unit * this.#scale;
    pen.strokeStyle = colour("--ink");
    pen.lineWidth = 1.4;
    pen.beginPath();
    pen.moveTo(12, height - 16);
    pen.lineTo(12, height - 11);
    pen.lineTo(12 + long, height - 11);
    pen.lineTo(12 + long, height - 16);
    pen.stroke();
    pen.font = FONT_SMALL;
    pen.textAlign = "left";
    write(
      pen,
      near ? metres(value) : `${fixed(value, value < 1 ? 1 : 0)} NM`,
      16,
      height - 17,
      colour("--ink"),
      colour("--map"),
    );
  }

  #describe(states, plots) {
    const actors = states.map(
      ({ track, state }) =>
        `${track.callsign} ${state.ended ? "ended" : state.onGround ? state.phase || "on the ground" : `${whole(state.altitude)} feet`}`,
    );
    const parts = [...actors, ...inWords(plots)];
    const more = parts.length > MOST_NAMED ? [`and ${parts.length - MOST_NAMED} more`] : [];
    this.#canvas.setAttribute(
      "aria-label",
      `Plan view: ${[...parts.slice(0, MOST_NAMED), ...more].join(", ") || "no traffic"}`,
    );
  }
}
