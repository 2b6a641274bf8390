// The plan: what is drawn on it, in which order, and how one moves on it.

import { Pane } from "./pane.js";
import { byId, colour, offer, on } from "./dom.js";
import { NOWHERE, widened } from "./model.js";
import { box, copyOf, line, onSize } from "./pen.js";
import { drawAirport } from "./plan_map.js";
import { drawPlots, inWords } from "./plan_radar.js";
import { drawRings, drawScale } from "./plan_ranges.js";
import { drawActor, drawBlocks, drawTracks } from "./plan_traffic.js";
import { PlanView, ROOM } from "./plan_view.js";
import { known, whole } from "./words.js";

const MOST_NAMED = 30; // actors in words
const RENEWED_MS = 1000; // after which tracks that grow are drawn again
// Of the width, by which more is shown than is needed, so that the view changes seldom.
const SPARE = 0.08;
const STEPS_PX = {
  ArrowLeft: [60, 0],
  ArrowRight: [-60, 0],
  ArrowUp: [0, 60],
  ArrowDown: [0, -60],
};

export class Plan extends Pane {
  #canvas = byId("plan");
  #view = new PlanView();
  #fitted = "all";
  #camera = null;
  #dragged = null;
  #names = []; // boxes of the names of the runways, which data blocks are not to cover
  #ringNames = []; // those of the range rings
  #still = null; // picture of what does not move
  #stillSince = 0;
  #describing = null; // a timer, after which the plan is told in words

  constructor(run, clock) {
    super(run, clock);
    this.#views();
    this.#controls();
    const resized = (isFirst) => {
      if (isFirst || this.#fitted) this.fit(this.#fitted ?? "all");
      else this.redraw();
    };
    onSize(this.#canvas, resized, this.#view);
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
    const { airport, ownCategory } = this.run;
    this.fit(airport && ownCategory === "vehicle" ? "airport" : "all");
  }

  /** Keeps all traffic of a live run in view, unless somebody looks elsewhere. */
  keepFitted() {
    if (this.#fitted !== "all" || !this.#view.pen) return;
    const { width, height } = this.#view,
      { east, north } = this.run.bounds,
      [left, bottom] = this.#view.pixel([east[0], north[0]]),
      [right, top] = this.#view.pixel([east[1], north[1]]);
    const edge = ROOM / 2 - 1,
      sees = left >= edge && right <= width - edge && top >= edge && bottom <= height - edge;
    if (!sees) this.#fitTo("all", SPARE);
  }

  #views() {
    offer(byId("plan-view"), [
      ["all", "all traffic"],
      ...(this.run.airport ? ["airport"] : []),
      ...(this.#closest() ? ["conflict"] : []),
      ["", "free"],
    ]);
    byId("plan-leader").value = this.run.airport ? 30 : 60;
  }

  #controls() {
    const canvas = this.#canvas;
    on("plan-view", "change", (event) => this.fit(event.target.value));
    for (const id of ["plan-leader", "plan-rings", "plan-tracks"])
      on(id, "change", () => this.redraw());
    on("plan-in", "click", () => this.zoom(1.5));
    on("plan-out", "click", () => this.zoom(1 / 1.5));
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
      canvas.addEventListener(end, () => (this.#dragged = null));
    canvas.addEventListener("keydown", (event) => {
      const steps = STEPS_PX[event.key];
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
    this.#view.move(dx, dy);
    this.redraw();
  }

  /** Zooms about a point of the canvas, by default its middle. */
  zoom(factor, px = this.#view.width / 2, py = this.#view.height / 2) {
    if (!this.#view.pen) return;
    this.#free();
    this.#view.zoom(factor, px, py);
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
    if (!this.#view.pen) return;
    this.#view.show(this.#boundsOf(name), spare);
    this.#still = null;
    this.#fitted = name;
    byId("plan-view").value = name;
  }

  #boundsOf(name) {
    const { airport, bounds } = this.run,
      field = (airport?.runways ?? []).flatMap((runway) => runway.pavement),
      points = name === "conflict" ? this.#closest() : field,
      found = points.reduce(widened, name === "all" ? bounds : NOWHERE);
    return found.east[0] <= found.east[1] ? found : { east: [-1e4, 1e4], north: [-1e4, 1e4] };
  }

  #closest() {
    const t = this.run.summary?.closest_approach?.t_s,
      pair = (this.run.pair ?? []).map((name) => this.run.track(name));
    if (!known(t) || pair.length < 2 || pair.some((track) => !track)) return null;
    return pair.flatMap((track) =>
      [-20, 0, 20].map((shift) =>
        track.place(Math.min(Math.max(t + shift, track.first), track.last)),
      ),
    );
  }

  /** Draws everything again, because the view, the size or the colours have changed. */
  redraw() {
    this.#still = null;
    this.draw();
  }

  /** Draws what moves, over the picture of what does not. */
  draw() {
    const view = this.#view;
    if (!view.pen || document.body.dataset.seat === "pilot") return;
    const { t } = this.clock,
      now = performance.now();
    if (!this.#still || (this.clock.live && now - this.#stillSince > RENEWED_MS))
      this.#renewStill(now);
    view.pen.drawImage(this.#still, 0, 0, view.width, view.height);
    if (!this.run.airport) this.#drawRings();
    if (this.#camera) drawCamera(view, this.#camera);
    const states = this.#statesThere(),
      leaderS = Number(byId("plan-leader").value);
    drawPlots(view, this.run.plots.at(t));
    for (const one of states) drawActor(view, this.run, one, t, leaderS);
    drawBlocks(view, this.run, states, t, [...this.#names, ...this.#ringNames]);
    drawScale(view);
    // The last picture before the clock stands is told too.
    if (this.clock.following) this.#describing ??= setTimeout(() => this.#describe(), RENEWED_MS);
    else this.#describe();
  }

  /** Draws the airport, the rings about it, and the tracks, and keeps the picture of them. */
  #renewStill(now) {
    const { pen, width, height } = this.#view,
      { airport, tracks } = this.run;
    box(pen, colour("--map"), 0, 0, width, height);
    this.#names = airport ? drawAirport(this.#view, airport) : [];
    if (airport) this.#drawRings();
    if (byId("plan-tracks").checked) drawTracks(this.#view, tracks);
    this.#still = copyOf(this.#canvas);
    this.#stillSince = now;
  }

  /** Draws range rings about the airport, or about the first of the pair, if they are wished. */
  #drawRings() {
    const { airport, pair, tracks } = this.run,
      own = this.run.track(pair?.[0]) ?? tracks[0],
      isDrawn = byId("plan-rings").checked && (airport || own);
    const middle = () =>
      airport ? [0, 0] : own.place(Math.min(Math.max(this.clock.t, own.first), own.last));
    this.#ringNames = isDrawn ? drawRings(this.#view, middle()) : [];
  }

  #statesThere() {
    return this.run.states(this.clock.t).filter(({ state }) => state.isThere);
  }

  #describe() {
    this.#describing = null;
    if (this.clock.playing) return;
    const actors = this.#statesThere().map(
      ({ track, state }) =>
        `${track.callsign} ${state.ended ? "ended" : state.onGround ? state.phase || "on the ground" : `${whole(state.altitude)} feet`}`,
    );
    const parts = [...actors, ...inWords(this.run.plots.at(this.clock.t))],
      rest = parts.length - MOST_NAMED;
    if (rest > 0) parts.splice(MOST_NAMED, rest, `and ${rest} more`);
    this.#canvas.ariaLabel = `Plan view: ${parts.join(", ") || "no traffic"}`;
  }
}

/** Draws the field of view of a camera, and the bearings of what it has detected. */
function drawCamera(view, { place, heading, fov, bearings }) {
  const { pen } = view,
    [x, y] = view.pixel(place),
    reach = Math.max(3000 * view.scale, 40),
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
  for (const bearing of bearings) {
    const end = [x + 1.5 * reach * Math.sin(bearing), y - 1.5 * reach * Math.cos(bearing)];
    line(pen, colour("--warn"), 1.2, [x, y], end);
  }
}
