// The navigation display: compass, range rings, runways, and traffic with the symbols of TCAS II,
// own track up.

import { byId, onSize } from "./dom.js";
import { overlap } from "./labels.js";
import { METRE_PER_NM, SEVERITIES } from "./model.js";
import { INK } from "./primary_flight_display.js";
import { whole } from "./words.js";

const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
const RANGES_NM = [1, 2.5, 5, 10, 20, 40, 80];
const NEAR_NM = 6,
  NEAR_FT = 1200; // proximate traffic (RTCA DO-185B, 2.2.6.1)
const VEHICLES_NM = 2.5; // greatest range with which vehicles are shown
const CLIMBS_FPM = 500; // from which an arrow tells that traffic climbs or descends

export class NavigationDisplay {
  #canvas = byId("nd");
  #range = byId("nd-range");
  #run;
  #clock;
  #size = null;

  constructor(run, clock) {
    this.#run = run;
    this.#clock = clock;
    this.#range.replaceChildren(
      ...RANGES_NM.map((nm) => {
        const option = document.createElement("option");
        option.value = nm;
        option.textContent = `${nm} NM`;
        return option;
      }),
    );
    onSize(this.#canvas, (pen, width, height) => {
      this.#size = { pen, width, height };
    });
  }

  /** Shows the range that one begins with: short at an airport. */
  reset() {
    this.#range.value = this.#run.airport ? 5 : 40;
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
    if (!this.#size) return;
    const { pen, width, height } = this.#size,
      track = this.#run.track(callsign);
    pen.fillStyle = INK.black;
    pen.fillRect(0, 0, width, height);
    if (!shown || !track) {
      this.#text("NO POSITION", width / 2, height / 2, INK.caution, 16, "center");
      this.#canvas.setAttribute("aria-label", "Navigation display, no position");
      return;
    }
    const t = this.#clock.t,
      own = track.state(t, this.#run.span),
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
    const others = this.#run
      .states(t)
      .filter(
        (one) =>
          one.track !== track && one.state.isThere && !one.state.ended && this.#isShown(one.track),
      );
    const seen = others.map((one) => this.#traffic(view, one, shown, t)).filter((text) => text);
    this.#ownship(x, y);
    this.#text(`GS ${whole(shown.ground_speed_kt)}`, 8, 14, INK.text);
    this.#text(`ALT ${whole(shown.altitude_ft)}`, 8, 32, INK.text);
    if (tcas?.severity === "CAUTION") this.#text("TRAFFIC", 8, 52, INK.caution, 15);
    if (tcas?.severity === "WARNING") this.#text("RESOLUTION ADVISORY", 8, 52, INK.warning, 13);
    this.#canvas.setAttribute(
      "aria-label",
      `Navigation display, traffic: ${seen.join(", ") || "none within range"}`,
    );
  }

  #isShown({ category }) {
    return (
      category === "aircraft" ||
      (category === "vehicle" && Number(this.#range.value) <= VEHICLES_NM)
    );
  }

  #text(text, x, y, ink, size = 13, align = "left") {
    const { pen } = this.#size;
    pen.font = `600 ${size}px ${FONT}`;
    pen.textAlign = align;
    pen.textBaseline = "middle";
    pen.lineJoin = "round";
    pen.lineWidth = 3;
    pen.strokeStyle = INK.black;
    pen.strokeText(text, x, y);
    pen.fillStyle = ink;
    pen.fillText(text, x, y);
    pen.textBaseline = "alphabetic";
  }

  /** The pixel of a place in metres, own track up. */
  #pixel({ x, y, own, up, scale }, east, north) {
    const e = (east - own.east) * scale,
      n = (north - own.north) * scale,
      sin = Math.sin(up),
      cos = Math.cos(up);
    return [x + e * cos - n * sin, y - e * sin - n * cos];
  }

  #runways(view) {
    const { pen } = this.#size,
      taken = [];
    for (const runway of this.#run.airport?.runways ?? []) {
      pen.beginPath();
      runway.pavement.forEach(([east, north], i) => {
        const [px, py] = this.#pixel(view, east, north);
        if (i) pen.lineTo(px, py);
        else pen.moveTo(px, py);
      });
      pen.closePath();
      pen.strokeStyle = INK.text;
      pen.lineWidth = 2;
      pen.stroke();
      for (const end of runway.ends) {
        const [px, py] = this.#pixel(view, ...end.start),
          [ox, oy] = this.#pixel(view, ...runway.ends.find((one) => one !== end).start),
          long = Math.hypot(px - ox, py - oy);
        if (long > 30)
          this.#ident(end.ident, px, py, (px - ox) / long, (py - oy) / long, taken);
      }
    }
  }

  /**
   * Writes the number of a runway off its end, which is at a pixel, in a direction: farther off
   * where those of others are.
   */
  #ident(ident, x, y, dx, dy, taken) {
    const boxes = [12, 26, 40].map((far) => [
      x + dx * far - 10,
      y + dy * far - 7,
      x + dx * far + 10,
      y + dy * far + 7,
    ]);
    const box = boxes.find((one) => !taken.some((other) => overlap(one, other)));
    if (!box) return;
    taken.push(box);
    this.#text(ident, (box[0] + box[2]) / 2, (box[1] + box[3]) / 2, INK.dim, 11, "center");
  }

  #compass({ x, y, reach }, shown) {
    const { pen, width } = this.#size,
      up = shown.ground_speed_kt > 6 ? shown.track_deg : shown.heading_deg;
    pen.strokeStyle = INK.dim;
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.arc(x, y, reach, 0, 2 * Math.PI);
    pen.stroke();
    pen.setLineDash([3, 6]);
    pen.beginPath();
    pen.arc(x, y, reach / 2, 0, 2 * Math.PI);
    pen.stroke();
    pen.setLineDash([]);
    for (let mark = 0; mark < 360; mark += 5) {
      const angle = ((mark - up) * Math.PI) / 180,
        long = mark % 10 === 0 ? 9 : 5,
        sin = Math.sin(angle),
        cos = Math.cos(angle);
      if (cos < 0.1) continue;
      pen.strokeStyle = INK.dim;
      pen.lineWidth = 1.5;
      pen.beginPath();
      pen.moveTo(x + reach * sin, y - reach * cos);
      pen.lineTo(x + (reach - long) * sin, y - (reach - long) * cos);
      pen.stroke();
      const off = Math.abs(((mark - shown.heading_deg + 540) % 360) - 180);
      if (mark % 30 === 0 && off > 8)
        this.#text(
          String(mark / 10),
          x + (reach + 12) * sin,
          y - (reach + 12) * cos,
          INK.text,
          12,
          "center",
        );
    }
    pen.strokeStyle = INK.dim;
    pen.beginPath();
    pen.moveTo(x, y - reach);
    pen.lineTo(x, y - 14);
    pen.stroke();
    const drift = ((shown.heading_deg - up) * Math.PI) / 180;
    pen.beginPath();
    for (const [dx, dy] of [
      [0, 0],
      [-7, -11],
      [7, -11],
    ])
      pen.lineTo(x + reach * Math.sin(drift) + dx, y - reach * Math.cos(drift) + dy);
    pen.closePath();
    pen.strokeStyle = INK.text;
    pen.stroke();
    this.#text(
      `TRK ${String(Math.round(up) % 360).padStart(3, "0")} ${shown.north === "magnetic" ? "MAG" : "TRUE"}`,
      width / 2,
      14,
      INK.mode,
      14,
      "center",
    );
    this.#text(`${Number(this.#range.value) / 2}`, x - reach / 2 - 4, y - 8, INK.dim, 11, "right");
  }

  #ownship(x, y) {
    const { pen } = this.#size;
    pen.beginPath();
    pen.moveTo(x, y - 11);
    pen.lineTo(x + 8, y + 9);
    pen.lineTo(x - 8, y + 9);
    pen.closePath();
    pen.strokeStyle = INK.text;
    pen.lineWidth = 2;
    pen.fillStyle = INK.black;
    pen.fill();
    pen.stroke();
  }

  /** Draws one aircraft or vehicle, and returns it in words; nothing if it is out of range. */
  #traffic(view, { track, state }, shown, t) {
    const [px, py] = this.#pixel(view, state.east, state.north),
      { width, height } = this.#size;
    if (px < 4 || py < 40 || px > width - 4 || py > height - 4) return "";
    const feet = state.altitude - shown.altitude_ft,
      nm = Math.hypot(state.east - view.own.east, state.north - view.own.north) / METRE_PER_NM;
    const severity = SEVERITIES.indexOf(this.#run.severityOf(track.callsign, t)),
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
    const { pen } = this.#size;
    pen.beginPath();
    if (severity === 3) pen.rect(x - 7, y - 7, 14, 14);
    else if (severity === 2) pen.arc(x, y, 7.5, 0, 2 * Math.PI);
    else if (category === "vehicle") pen.rect(x - 4, y - 4, 8, 8);
    else
      for (const [dx, dy] of [
        [0, -8],
        [6, 0],
        [0, 8],
        [-6, 0],
        [0, -8],
      ])
        pen.lineTo(x + dx, y + dy);
    pen.strokeStyle = ink;
    pen.fillStyle = severity >= 2 || isNear ? ink : INK.black;
    pen.lineWidth = 1.8;
    pen.fill();
    pen.stroke();
  }
}
