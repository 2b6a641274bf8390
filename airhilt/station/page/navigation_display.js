// The navigation display: compass, range rings, runways, and traffic with the symbols of TCAS II,
// own track up.

import { Pane } from "./pane.js";
import { byId, offer } from "./dom.js";
import { runwayNumbers } from "./labels.js";
import { box, circle, label, line, onSize, stamp } from "./pen.js";
import { INK } from "./primary_flight_display.js";
import { METRE_PER_NM, SEVERITIES, whole } from "./words.js";

const RANGES_NM = [1, 2.5, 5, 10, 20, 40, 80];
const NEAR_NM = 6,
  NEAR_FT = 1200; // proximate traffic (RTCA DO-185B, 2.2.6.1)
const VEHICLES_NM = 2.5; // greatest range with which vehicles are shown
const OWN = new Path2D("M0-11 8 9H-8Z"),
  AIRCRAFT = new Path2D("M0-8 6 0 0 8-6 0Z"),
  VEHICLE = new Path2D("M-4-4H4V4H-4Z");
/** Outlines of traffic with an advisory, by severity. */
const SYMBOLS = {
  WARNING: new Path2D("M-7-7H7V7H-7Z"),
  CAUTION: new Path2D("M-7.5 0a7.5 7.5 0 1 0 15 0a7.5 7.5 0 1 0-15 0Z"),
};
const IDENTS_OFF_PX = [12, 26, 40]; // from the end of a runway, where its number is tried
const CLIMBS_FPM = 500; // from which an arrow tells that traffic climbs or descends

export class NavigationDisplay extends Pane {
  #canvas = byId("nd");
  #size = onSize(this.#canvas); // It is drawn with each frame.
  #range = byId("nd-range");

  constructor(run, clock) {
    super(run, clock);
    offer(
      this.#range,
      RANGES_NM.map((nm) => [nm, `${nm} NM`]),
    );
  }

  /** Shows the range that one begins with: short at an airport. */
  reset() {
    this.#range.value = this.run.airport ? 5 : 40;
  }

  /** Shows a longer range, or a shorter one with a step of -1. */
  step(step) {
    const next = RANGES_NM[RANGES_NM.indexOf(Number(this.#range.value)) + step];
    if (next) this.#range.value = next;
  }

  /**
   * Draws the surroundings of the own aircraft; `shown` is what its instruments show, `tcas` what
   * TCAS tells, or null.
   */
  draw(callsign, shown, tcas) {
    if (!this.#size.pen) return;
    const { pen, width, height } = this.#size,
      track = this.run.track(callsign);
    box(pen, INK.black, 0, 0, width, height);
    if (!shown || !track) {
      this.#text("NO POSITION", width / 2, height / 2, INK.caution, 16, "center");
      this.#canvas.ariaLabel = "Navigation display, no position";
      return;
    }
    const t = this.clock.t,
      own = track.state(t, this.run.span),
      reach = Math.min(height - 98, width * 0.62),
      x = width / 2,
      y = Math.min(height - 46, reach + 110);
    const view = {
      x,
      y,
      own,
      up: own.speed > 3 ? own.course : own.heading,
      scale: reach / Number(this.#range.value) / METRE_PER_NM,
      reach,
    };
    this.#runways(view);
    this.#compass(view, shown);
    const others = this.run
      .states(t)
      .filter(
        (one) =>
          one.track !== track && one.state.isThere && !one.state.ended && this.#isShown(one.track),
      );
    const seen = others.map((one) => this.#traffic(view, one, shown, t)).filter(Boolean);
    stamp(pen, OWN, [x, y], { fill: INK.black, edge: INK.text, width: 2 });
    this.#text(`GS ${whole(shown.ground_speed_kt)}`, 8, 14, INK.text);
    this.#text(`ALT ${whole(shown.altitude_ft)}`, 8, 32, INK.text);
    if (tcas?.severity === "CAUTION") this.#text("TRAFFIC", 8, 52, INK.caution, 15);
    if (tcas?.severity === "WARNING") this.#text("RESOLUTION ADVISORY", 8, 52, INK.warning, 13);
    this.#canvas.ariaLabel = `Navigation display, traffic: ${seen.join(", ") || "none within range"}`;
  }

  #isShown({ category }) {
    return (
      category === "aircraft" ||
      (category === "vehicle" && Number(this.#range.value) <= VEHICLES_NM)
    );
  }

  #text(text, x, y, ink, size, align) {
    label(this.#size.pen, text, x, y, ink, size, align, INK.black);
  }

  /** The pixel of a place in metres, own track up. */
  #pixel({ x, y, own, up, scale }, east, north) {
    const e = (east - own.east) * scale,
      n = (north - own.north) * scale,
      sin = Math.sin(up),
      cos = Math.cos(up);
    return [x + e * cos - n * sin, y - e * sin - n * cos];
  }

  /** Draws the runways, and their numbers off their ends. */
  #runways(view) {
    const runways = this.run.airport?.runways ?? [],
      pixel = ([east, north]) => this.#pixel(view, east, north);
    for (const { pavement } of runways) {
      const corners = pavement.map(pixel);
      line(this.#size.pen, INK.text, 2, ...corners, corners[0]);
    }
    for (const { ident, box } of runwayNumbers(runways, pixel, IDENTS_OFF_PX, [10, 7], 30))
      this.#text(ident, box[0] + 10, box[1] + 7, INK.dim, 11, "center");
  }

  #compass({ x, y, reach }, shown) {
    const { pen, width } = this.#size,
      up = shown.ground_speed_kt > 6 ? shown.track_deg : shown.heading_deg,
      range = Number(this.#range.value);
    circle(pen, INK.dim, 1.5, [x, y], reach);
    pen.setLineDash([3, 6]);
    circle(pen, INK.dim, 1.5, [x, y], reach / 2);
    pen.setLineDash([]);
    for (let mark = 0; mark < 360; mark += 5) {
      const angle = ((mark - up) * Math.PI) / 180,
        at = (r) => [x + r * Math.sin(angle), y - r * Math.cos(angle)];
      if (Math.cos(angle) < 0.1) continue;
      line(pen, INK.dim, 1.5, at(reach), at(reach - (mark % 10 === 0 ? 9 : 5)));
      const off = Math.abs(((mark - shown.heading_deg + 540) % 360) - 180);
      if (mark % 30 === 0 && off > 8)
        this.#text(String(mark / 10), ...at(reach + 12), INK.text, 12, "center");
    }
    line(pen, INK.dim, 1.5, [x, y - reach], [x, y - 14]);
    const drift = ((shown.heading_deg - up) * Math.PI) / 180,
      [hx, hy] = [x + reach * Math.sin(drift), y - reach * Math.cos(drift)];
    line(pen, INK.text, 1.5, [hx, hy], [hx - 7, hy - 11], [hx + 7, hy - 11], [hx, hy]);
    const track = String(Math.round(up) % 360).padStart(3, "0"),
      north = shown.north === "magnetic" ? "MAG" : "TRUE";
    this.#text(`TRK ${track} ${north}`, width / 2, 14, INK.mode, 14, "center");
    this.#text(`${range / 2}`, x - reach / 2 - 4, y - 8, INK.dim, 11, "right");
  }

  /** Draws one aircraft or vehicle, and returns it in words; nothing if it is out of range. */
  #traffic(view, { track, state }, shown, t) {
    const [px, py] = this.#pixel(view, state.east, state.north),
      { width, height } = this.#size;
    if (px < 4 || py < 40 || px > width - 4 || py > height - 4) return "";
    const feet = state.altitude - shown.altitude_ft,
      nm = Math.hypot(state.east - view.own.east, state.north - view.own.north) / METRE_PER_NM;
    const severity = SEVERITIES.indexOf(this.run.severityOf(track.callsign, t)),
      isNear = nm < NEAR_NM && Math.abs(feet) < NEAR_FT;
    const ink = severity === 3 ? INK.warning : severity === 2 ? INK.caution : INK.text;
    this.#symbol(px, py, severity, isNear, ink, track.category);
    const hundreds = Math.round(Math.abs(feet) / 100),
      tag = `${hundreds ? (feet < 0 ? "-" : "+") : ""}${String(Math.min(hundreds, 99)).padStart(2, "0")}`;
    const below = feet < 0 ? 1 : -1,
      arrow =
        state.onGround || Math.abs(state.rate) < CLIMBS_FPM
          ? ""
          : state.rate > 0
            ? " \u2191"
            : " \u2193";
    if (!state.onGround) this.#text(`${tag}${arrow}`, px, py + below * 16, ink, 12, "center");
    this.#text(
      track.callsign,
      px + 11,
      py + (state.onGround ? 0 : -below * 3),
      ink === INK.text ? INK.dim : ink,
      11,
    );
    return `${track.callsign} ${nm.toFixed(1)} NM, ${hundreds * 100} feet ${feet < 0 ? "below" : "above"}${severity >= 2 ? `, ${SEVERITIES[severity]}` : ""}`;
  }

  #symbol(x, y, severity, isNear, ink, category) {
    const fill = severity >= 2 || isNear ? ink : INK.black,
      isVehicle = severity < 2 && category === "vehicle",
      outline = isVehicle ? VEHICLE : (SYMBOLS[SEVERITIES[severity]] ?? AIRCRAFT);
    stamp(this.#size.pen, outline, [x, y], { fill, edge: ink, width: 1.8 });
  }
}
