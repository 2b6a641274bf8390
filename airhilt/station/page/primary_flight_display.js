// The primary flight display: attitude, speed and altitude tapes, vertical speed, heading, and what
// is selected.

import { byId } from "./dom.js";
import { BOLD, box, label, line, onSize, stamp, within } from "./pen.js";
import { bearing, whole } from "./words.js";

// Colours of the instrument, the same in a light and in a dark page (FAA AC 25-11B, 31.c).
export const INK = {
  sky: "#1d6fb8",
  ground: "#80501f",
  tape: "#20262d",
  text: "#ffffff",
  dim: "#b9c2cb",
  selected: "#ff7df2",
  mode: "#5fe08a",
  black: "#000000",
  caution: "#ffc400",
  warning: "#ff5b52",
  own: "#ffd84d",
  fly: "#12c94a",
  avoid: "#e0261b",
};
const HEAD = 26,
  FOOT = 44,
  SPEED = 66,
  ALTITUDE = 74,
  CLIMB = 40;
const KNOTS_A_TAPE = 80,
  FEET_A_TAPE = 800,
  DEGREES_A_HEIGHT = 44,
  DEGREES_A_WIDTH = 60;

// The outline of a selected value on a tape, at its left edge.
const BUG = new Path2D("M0 0 7-6V-11H0V11H7V6Z");
const POINTER = new Path2D("M0 0 7 12H-7Z"); // of the bank scale
const DRIFT = new Path2D("M0 0-5 7 0 14 5 7Z"); // the track on the heading scale
const GEAR = { 0: ["GEAR UP", INK.text], 1: ["GEAR DOWN", INK.mode] };
const RADIAN = Math.PI / 180;
const BANKS = [-60, -45, -30, -20, -10, 0, 10, 20, 30, 45, 60]; // marks of the bank scale, degrees

/** A place on the vertical speed scale from -1 to 1: 1000 ft/min are half of it, 4000 all. */
const climbScale = (fpm) =>
  Math.sign(fpm) *
  (Math.abs(fpm) <= 1000
    ? Math.abs(fpm) / 2000
    : 0.5 + Math.min(Math.abs(fpm) - 1000, 3000) / 6000);

export class PrimaryFlightDisplay {
  #size = onSize(byId("pfd")); // It is drawn with each frame.

  /**
   * Draws what the instruments show, and what TCAS tells; null: nothing is known, nothing is told.
   */
  draw(shown, tcas) {
    if (!this.#size.pen) return;
    const { pen, width, height } = this.#size;
    box(pen, INK.black, 0, 0, width, height);
    if (!shown) {
      this.#text("NO DATA", width / 2, height / 2, INK.warning, 18);
      return;
    }
    const [left, top, right, bottom] = [SPEED, HEAD, width - ALTITUDE - CLIMB, height - FOOT];
    this.#attitude(shown, [left, top, right, bottom]);
    this.#speed(shown, top, bottom);
    this.#altitude(shown, right, top, bottom);
    this.#climb(shown, tcas, right + ALTITUDE + 3, top, bottom);
    this.#heading(shown, left, right, bottom + 4);
    this.#mode(shown);
    if (tcas) this.#advisory(tcas, (left + right) / 2, top + (bottom - top) * 0.72);
  }

  #text(text, x, y, ink, size = 13, align = "center") {
    label(this.#size.pen, text, x, y, ink, size, align);
  }

  #line(ink, width, ...points) {
    line(this.#size.pen, ink, width, ...points);
  }

  /** Writes a text in the middle of a black box with an edge. */
  #readout(text, x, y, width, size, ink = INK.text, edge = 1.5) {
    const { pen } = this.#size;
    box(pen, INK.black, x - width / 2, y - 15, width, 30);
    pen.strokeStyle = ink;
    pen.lineWidth = edge;
    pen.strokeRect(x - width / 2, y - 15, width, 30);
    this.#text(text, x, y + 1, ink, size);
  }

  /** The words of TCAS, below the horizon. */
  #advisory({ words, severity }, x, y) {
    const { pen } = this.#size,
      ink = { WARNING: INK.warning, CAUTION: INK.caution }[severity] ?? INK.mode;
    pen.font = BOLD.replace("12px", "17px");
    this.#readout(words, x, y, pen.measureText(words).width + 20, 17, ink, 2);
  }

  #attitude({ roll_deg: roll, pitch_deg: pitch, radio_height_ft: height }, area) {
    const { pen } = this.#size,
      [left, top, right, bottom] = area,
      [x, y, half] = [(left + right) / 2, (top + bottom) / 2, (bottom - top) / 2],
      degree = (2 * half) / DEGREES_A_HEIGHT,
      horizon = pitch * degree,
      far = 2000;
    within(pen, area, () => {
      pen.translate(x, y);
      pen.rotate(-roll * RADIAN);
      box(pen, INK.sky, -far, horizon - far, 2 * far, far);
      box(pen, INK.ground, -far, horizon, 2 * far, far);
      this.#line(INK.text, 2, [-far, horizon], [far, horizon]);
      const lowest = Math.max(-80, Math.round(pitch / 5) * 5 - 15);
      for (let mark = lowest; mark <= pitch + 15; mark += 2.5) {
        const at = horizon - mark * degree,
          wide = mark % 10 === 0 ? 38 : mark % 5 === 0 ? 22 : 9;
        if (mark === 0 || Math.abs(at) > half - 34) continue;
        this.#line(INK.text, 1.5, [-wide, at], [wide, at]);
        if (mark % 10 === 0)
          for (const side of [-1, 1])
            this.#text(String(Math.abs(mark)), side * (wide + 12), at, INK.text, 11);
      }
      pen.rotate(roll * RADIAN);
      this.#bank(roll, half - 6);
    });
    const wing = Math.min(56, (right - left) / 4);
    const own = new Path2D(`M${-wing} 0H-22V9M${wing} 0H22V9M-2.5 0H2.5`);
    stamp(pen, own, [x, y], { edge: INK.black, width: 7 });
    stamp(pen, own, [x, y], { edge: INK.own, width: 3.5 });
    if (typeof height !== "number") return;
    box(pen, INK.black, x - 34, bottom - 27, 68, 22);
    this.#text(`${whole(height)} RA`, x, bottom - 16, height < 500 ? INK.caution : INK.mode, 14);
  }

  #bank(roll, reach) {
    const { pen } = this.#size,
      at = (degrees, r) => [r * Math.sin(degrees * RADIAN), -r * Math.cos(degrees * RADIAN)];
    for (const degrees of BANKS) {
      const inner = reach - (degrees % 30 === 0 ? 11 : 7);
      this.#line(INK.text, 1.5, at(degrees, reach), at(degrees, inner));
    }
    const place = [(12 - reach) * Math.sin(roll * RADIAN), (12 - reach) * Math.cos(roll * RADIAN)];
    stamp(pen, POINTER, place, { fill: INK.own, turn: -roll * RADIAN });
  }

  /**
   * A tape: marks and numbers that move past the value, and the selected value as a bug. The marks
   * are at an edge of the tape and reach inward, to the right (1) or the left (-1).
   */
  #tape([left, top, right, bottom], inward, value, selected, span, step, every) {
    const { pen } = this.#size,
      edge = inward > 0 ? left : right,
      unit = (bottom - top) / span,
      place = (other) => (top + bottom) / 2 - (other - value) * unit,
      lowest = Math.ceil((value - span / 2) / step) * step;
    within(pen, [left, top, right, bottom], () => {
      box(pen, INK.tape, left, top, right - left, bottom - top);
      for (let mark = Math.max(lowest, 0); mark <= value + span / 2; mark += step) {
        const at = place(mark),
          isNamed = mark % every === 0;
        this.#line(INK.dim, 1.5, [edge, at], [edge + inward * (isNamed ? 10 : 6), at]);
        if (isNamed)
          this.#text(
            String(mark),
            edge + inward * 14,
            at,
            INK.text,
            13,
            inward > 0 ? "left" : "right",
          );
      }
      const at = Math.min(Math.max(place(selected), top), bottom);
      const look = { edge: INK.selected, width: 3, mirrored: inward < 0 };
      stamp(pen, BUG, [edge, at], look);
    });
  }

  #speed(shown, top, bottom) {
    const { airspeed_kt: value, selected_airspeed_kt: selected, mach } = shown,
      x = SPEED / 2;
    this.#tape([0, top + 22, SPEED, bottom - 22], -1, value, selected, KNOTS_A_TAPE, 10, 20);
    this.#readout(whole(value), 2 + (SPEED - 14) / 2, (top + bottom) / 2, SPEED - 14, 17);
    this.#text(String(Math.round(selected)), x, top + 11, INK.selected, 15);
    const other =
      mach >= 0.4 ? `M ${mach.toFixed(2).slice(1)}` : `GS ${whole(shown.ground_speed_kt)}`;
    this.#text(other, x, bottom - 10, INK.text);
  }

  #altitude(shown, left, top, bottom) {
    const { altitude_ft: value, selected_altitude_ft: selected } = shown,
      area = [left, top + 22, left + ALTITUDE, bottom - 22],
      tens = String(Math.round(value / 10) * 10);
    this.#tape(area, 1, value, selected, FEET_A_TAPE, 100, 200);
    this.#readout(tens, left + 4 + ALTITUDE / 2, (top + bottom) / 2, ALTITUDE - 12, 16);
    this.#text(String(selected), left + ALTITUDE / 2, top + 11, INK.selected, 15);
    this.#text("1013", left + ALTITUDE / 2, bottom - 10, INK.mode);
  }

  #climb({ vertical_speed_fpm: rate }, tcas, left, top, bottom) {
    const { pen } = this.#size,
      middle = (top + bottom) / 2,
      half = (bottom - top) / 2 - 40,
      place = (fpm) => middle - climbScale(fpm) * half;
    box(pen, INK.tape, left, middle - half - 14, CLIMB - 6, 2 * half + 28);
    for (const [band, ink] of [
      [tcas?.red, INK.avoid],
      [tcas?.green, INK.fly],
    ]) {
      const [low, high] = (band ?? [0, 0]).map(place);
      box(pen, ink, left, high, 7, low - high);
    }
    for (const fpm of [500, 1000, 2000, 4000])
      for (const y of [place(fpm), place(-fpm)]) {
        this.#line(INK.dim, 1.5, [left, y], [left + 6, y]);
        if (fpm > 500 && (fpm !== 2000 || half > 90))
          this.#text(String(fpm / 1000), left + 10, y, INK.text, 11, "left");
      }
    this.#line(INK.dim, 1.5, [left, middle], [left + 10, middle]);
    this.#line(INK.own, 3, [left + CLIMB - 6, middle], [left + 4, place(rate)]);
    const fpm = Math.round(rate / 50) * 50,
      y = middle - Math.sign(fpm) * (half + 24);
    if (Math.abs(fpm) >= 200)
      this.#text(String(Math.abs(fpm)), left + (CLIMB - 6) / 2, y, INK.text, 12);
  }

  #heading(shown, left, right, top) {
    const { pen, height } = this.#size,
      { heading_deg: heading } = shown,
      x = (left + right) / 2,
      unit = (right - left) / DEGREES_A_WIDTH;
    within(pen, [left, top, right, height], () => {
      box(pen, INK.tape, left, top, right - left, height - top);
      for (let mark = Math.ceil((heading - 32) / 5) * 5; mark <= heading + 32; mark += 5) {
        const at = x + (mark - heading) * unit,
          isNamed = mark % 10 === 0;
        this.#line(INK.dim, 1.5, [at, top], [at, top + (isNamed ? 8 : 5)]);
        if (isNamed && Math.abs(at - x) > 38)
          this.#text(
            String(((mark + 360) % 360) / 10).padStart(2, "0"),
            at,
            top + 18,
            INK.text,
            12,
          );
      }
      const drift = ((shown.track_deg - heading + 540) % 360) - 180,
        at = x + drift * unit;
      if (shown.ground_speed_kt > 10) stamp(pen, DRIFT, [at, top], { edge: INK.mode, width: 2 });
    });
    const digits = bearing((Math.round(heading) + 360) % 360).replace("°", "");
    this.#readout(digits, x, top + 20, 48, 16);
    const north = shown.north === "magnetic" ? "MAG" : "TRUE";
    this.#text(north, left - 8, top + 20, INK.mode, 12, "right");
  }

  #mode({ mode, gear, flaps }) {
    const { width } = this.#size,
      percent = Math.round(flaps * 100),
      [text, ink] = GEAR[gear] ?? ["GEAR IN TRANSIT", INK.caution];
    this.#text(mode.replaceAll("_", " ").toUpperCase(), 8, 13, INK.mode, 13, "left");
    this.#text(text, width / 2 + 20, 13, ink, 12);
    this.#text(percent ? `FLAPS ${percent} %` : "FLAPS UP", width - 8, 13, INK.text, 12, "right");
  }
}
