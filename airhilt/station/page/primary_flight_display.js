// The primary flight display: attitude, speed and altitude tapes, vertical speed, heading, and what
// is selected.

import { byId, onSize } from "./dom.js";
import { bearing, whole } from "./words.js";

const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
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

/** A place on the vertical speed scale from -1 to 1: 1000 ft/min are half of it, 4000 all. */
const climbScale = (fpm) =>
  Math.sign(fpm) *
  (Math.abs(fpm) <= 1000
    ? Math.abs(fpm) / 2000
    : 0.5 + Math.min(Math.abs(fpm) - 1000, 3000) / 6000);

export class PrimaryFlightDisplay {
  #canvas = byId("pfd");
  #size = null;
  #shown = null;
  #tcas = null;

  constructor() {
    onSize(this.#canvas, (pen, width, height) => {
      this.#size = { pen, width, height };
      this.draw(this.#shown, this.#tcas);
    });
  }

  /**
   * Draws what the instruments show, and what TCAS tells; null: nothing is known, nothing is told.
   */
  draw(shown, tcas) {
    this.#shown = shown;
    this.#tcas = tcas;
    if (!this.#size) return;
    const { pen, width, height } = this.#size;
    pen.fillStyle = INK.black;
    pen.fillRect(0, 0, width, height);
    if (!shown) {
      this.#text("NO DATA", width / 2, height / 2, INK.warning, 18, "center");
      return;
    }
    const box = { left: SPEED, right: width - ALTITUDE - CLIMB, top: HEAD, bottom: height - FOOT };
    this.#attitude(shown, box);
    this.#speed(shown, box);
    this.#altitude(shown, box);
    this.#climb(shown, box);
    this.#heading(shown, box);
    this.#mode(shown);
    if (tcas) this.#advisory(tcas, box);
  }

  /** The words of TCAS, below the horizon. */
  #advisory({ words, severity }, { left, right, top, bottom }) {
    const { pen } = this.#size,
      x = (left + right) / 2,
      y = top + (bottom - top) * 0.72,
      ink = { WARNING: INK.warning, CAUTION: INK.caution }[severity] ?? INK.mode;
    pen.font = `600 17px ${FONT}`;
    const wide = pen.measureText(words).width + 20;
    pen.fillStyle = INK.black;
    pen.strokeStyle = ink;
    pen.lineWidth = 2;
    pen.fillRect(x - wide / 2, y - 15, wide, 30);
    pen.strokeRect(x - wide / 2, y - 15, wide, 30);
    this.#text(words, x, y + 1, ink, 17, "center");
  }

  #text(text, x, y, ink, size = 13, align = "left") {
    const { pen } = this.#size;
    pen.font = `600 ${size}px ${FONT}`;
    pen.textAlign = align;
    pen.textBaseline = "middle";
    pen.fillStyle = ink;
    pen.fillText(text, x, y);
    pen.textBaseline = "alphabetic";
  }

  #line(ink, width, ...points) {
    const { pen } = this.#size;
    pen.strokeStyle = ink;
    pen.lineWidth = width;
    pen.beginPath();
    points.forEach(([x, y], i) => {
      if (i) pen.lineTo(x, y);
      else pen.moveTo(x, y);
    });
    pen.stroke();
  }

  #within({ left, right, top, bottom }, draw) {
    const { pen } = this.#size;
    pen.save();
    pen.beginPath();
    pen.rect(left, top, right - left, bottom - top);
    pen.clip();
    draw();
    pen.restore();
  }

  #attitude(shown, box) {
    const { pen } = this.#size,
      x = (box.left + box.right) / 2,
      y = (box.top + box.bottom) / 2,
      degree = (box.bottom - box.top) / DEGREES_A_HEIGHT,
      far = 2000;
    this.#within(box, () => {
      pen.translate(x, y);
      pen.rotate((-shown.roll_deg * Math.PI) / 180);
      const horizon = shown.pitch_deg * degree;
      pen.fillStyle = INK.sky;
      pen.fillRect(-far, horizon - far, 2 * far, far);
      pen.fillStyle = INK.ground;
      pen.fillRect(-far, horizon, 2 * far, far);
      this.#line(INK.text, 2, [-far, horizon], [far, horizon]);
      for (
        let pitch = Math.max(-80, Math.round(shown.pitch_deg / 5) * 5 - 15);
        pitch <= shown.pitch_deg + 15;
        pitch += 2.5
      ) {
        const at = horizon - pitch * degree,
          half = pitch % 10 === 0 ? 38 : pitch % 5 === 0 ? 22 : 9;
        if (pitch === 0 || Math.abs(at) > (box.bottom - box.top) / 2 - 34) continue;
        this.#line(INK.text, 1.5, [-half, at], [half, at]);
        if (pitch % 10 === 0)
          for (const side of [-1, 1])
            this.#text(String(Math.abs(pitch)), side * (half + 12), at, INK.text, 11, "center");
      }
      pen.rotate((shown.roll_deg * Math.PI) / 180);
      this.#bank(shown, (box.bottom - box.top) / 2 - 6);
    });
    const wing = Math.min(56, (box.right - box.left) / 4);
    for (const [ink, wide] of [
      [INK.black, 7],
      [INK.own, 3.5],
    ]) {
      for (const side of [-1, 1])
        this.#line(ink, wide, [x + side * wing, y], [x + side * 22, y], [x + side * 22, y + 9]);
      this.#line(ink, wide, [x - 2.5, y], [x + 2.5, y]);
    }
    if (typeof shown.radio_height_ft === "number") {
      pen.fillStyle = INK.black;
      pen.fillRect(x - 34, box.bottom - 27, 68, 22);
      this.#text(
        `${whole(shown.radio_height_ft)} RA`,
        x,
        box.bottom - 16,
        shown.radio_height_ft < 500 ? INK.caution : INK.mode,
        14,
        "center",
      );
    }
  }

  #bank(shown, reach) {
    const { pen } = this.#size,
      at = (degrees, r) => [
        r * Math.sin((degrees * Math.PI) / 180),
        -r * Math.cos((degrees * Math.PI) / 180),
      ];
    for (const degrees of [-60, -45, -30, -20, -10, 0, 10, 20, 30, 45, 60])
      this.#line(
        INK.text,
        1.5,
        at(degrees, reach),
        at(degrees, reach - (degrees % 30 === 0 ? 11 : 7)),
      );
    pen.save();
    pen.rotate((-shown.roll_deg * Math.PI) / 180);
    pen.beginPath();
    pen.moveTo(0, 12 - reach);
    pen.lineTo(7, 24 - reach);
    pen.lineTo(-7, 24 - reach);
    pen.closePath();
    pen.fillStyle = INK.own;
    pen.fill();
    pen.restore();
  }

  /** A tape: marks and numbers that move past the value, and the selected value as a bug. */
  #tape(box, value, span, step, every, isRight) {
    const { pen } = this.#size,
      y = (box.top + box.bottom) / 2,
      unit = (box.bottom - box.top) / span;
    pen.fillStyle = INK.tape;
    pen.fillRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
    const edge = isRight ? box.left : box.right,
      inward = isRight ? 1 : -1;
    for (
      let mark = Math.ceil((value - span / 2) / step) * step;
      mark <= value + span / 2;
      mark += step
    ) {
      if (mark < 0) continue;
      const at = y - (mark - value) * unit;
      this.#line(INK.dim, 1.5, [edge, at], [edge + inward * (mark % every === 0 ? 10 : 6), at]);
      if (mark % every === 0)
        this.#text(String(mark), edge + inward * 14, at, INK.text, 13, isRight ? "left" : "right");
    }
  }

  #bug(box, value, selected, span, isRight) {
    const y = (box.top + box.bottom) / 2,
      unit = (box.bottom - box.top) / span,
      at = Math.min(Math.max(y - (selected - value) * unit, box.top), box.bottom);
    const edge = isRight ? box.left : box.right,
      inward = isRight ? 1 : -1;
    this.#line(
      INK.selected,
      3,
      [edge, at],
      [edge + inward * 7, at - 6],
      [edge + inward * 7, at - 11],
      [edge, at - 11],
      [edge, at + 11],
      [edge + inward * 7, at + 11],
      [edge + inward * 7, at + 6],
      [edge, at],
    );
  }

  #readout(left, width, y, text, size = 17) {
    const { pen } = this.#size;
    pen.fillStyle = INK.black;
    pen.strokeStyle = INK.text;
    pen.lineWidth = 1.5;
    pen.fillRect(left, y - 15, width, 30);
    pen.strokeRect(left, y - 15, width, 30);
    this.#text(text, left + width / 2, y + 1, INK.text, size, "center");
  }

  #speed(shown, { top, bottom }) {
    const box = { left: 0, right: SPEED, top: top + 22, bottom: bottom - 22 },
      middle = (box.top + box.bottom) / 2;
    this.#within(box, () => {
      this.#tape(box, shown.airspeed_kt, KNOTS_A_TAPE, 10, 20, false);
      this.#bug(box, shown.airspeed_kt, shown.selected_airspeed_kt, KNOTS_A_TAPE, false);
    });
    this.#readout(2, SPEED - 14, middle, whole(shown.airspeed_kt));
    this.#text(
      String(Math.round(shown.selected_airspeed_kt)),
      SPEED / 2,
      top + 11,
      INK.selected,
      15,
      "center",
    );
    this.#text(
      shown.mach >= 0.4
        ? `M ${shown.mach.toFixed(2).slice(1)}`
        : `GS ${whole(shown.ground_speed_kt)}`,
      SPEED / 2,
      bottom - 10,
      INK.text,
      13,
      "center",
    );
  }

  #altitude(shown, { right, top, bottom }) {
    const box = { left: right, right: right + ALTITUDE, top: top + 22, bottom: bottom - 22 },
      middle = (box.top + box.bottom) / 2;
    this.#within(box, () => {
      this.#tape(box, shown.altitude_ft, FEET_A_TAPE, 100, 200, true);
      this.#bug(box, shown.altitude_ft, shown.selected_altitude_ft, FEET_A_TAPE, true);
    });
    this.#readout(
      right + 10,
      ALTITUDE - 12,
      middle,
      String(Math.round(shown.altitude_ft / 10) * 10),
      16,
    );
    this.#text(
      String(shown.selected_altitude_ft),
      right + ALTITUDE / 2,
      top + 11,
      INK.selected,
      15,
      "center",
    );
    this.#text("1013", right + ALTITUDE / 2, bottom - 10, INK.mode, 13, "center");
  }

  #climb(shown, { right, top, bottom }) {
    const left = right + ALTITUDE + 3,
      middle = (top + bottom) / 2,
      half = (bottom - top) / 2 - 40,
      { pen } = this.#size;
    pen.fillStyle = INK.tape;
    pen.fillRect(left, middle - half - 14, CLIMB - 6, 2 * half + 28);
    for (const [band, ink] of [
      [this.#tcas?.red, INK.avoid],
      [this.#tcas?.green, INK.fly],
    ]) {
      if (!band) continue;
      const [low, high] = band.map((fpm) => middle - climbScale(fpm) * half);
      pen.fillStyle = ink;
      pen.fillRect(left, high, 7, low - high);
    }
    for (const fpm of [500, 1000, 2000, 4000]) {
      for (const side of [-1, 1]) {
        const y = middle - side * climbScale(fpm) * half;
        this.#line(INK.dim, 1.5, [left, y], [left + 6, y]);
        if (fpm > 500 && (fpm !== 2000 || half > 90))
          this.#text(String(fpm / 1000), left + 10, y, INK.text, 11);
      }
    }
    this.#line(INK.dim, 1.5, [left, middle], [left + 10, middle]);
    this.#line(
      INK.own,
      3,
      [left + CLIMB - 6, middle],
      [left + 4, middle - climbScale(shown.vertical_speed_fpm) * half],
    );
    const fpm = Math.round(shown.vertical_speed_fpm / 50) * 50;
    if (Math.abs(fpm) >= 200)
      this.#text(
        String(Math.abs(fpm)),
        left + (CLIMB - 6) / 2,
        fpm > 0 ? middle - half - 24 : middle + half + 24,
        INK.text,
        12,
        "center",
      );
  }

  #heading(shown, { left, right, bottom }) {
    const { height } = this.#size,
      box = { left, right, top: bottom + 4, bottom: height },
      x = (left + right) / 2,
      unit = (right - left) / DEGREES_A_WIDTH;
    this.#within(box, () => {
      const { pen } = this.#size;
      pen.fillStyle = INK.tape;
      pen.fillRect(left, box.top, right - left, box.bottom - box.top);
      for (
        let mark = Math.ceil((shown.heading_deg - 32) / 5) * 5;
        mark <= shown.heading_deg + 32;
        mark += 5
      ) {
        const at = x + (mark - shown.heading_deg) * unit,
          number = (mark + 360) % 360;
        this.#line(INK.dim, 1.5, [at, box.top], [at, box.top + (mark % 10 === 0 ? 8 : 5)]);
        if (mark % 10 === 0 && Math.abs(at - x) > 38)
          this.#text(
            String(number / 10).padStart(2, "0"),
            at,
            box.top + 18,
            INK.text,
            12,
            "center",
          );
      }
      const drift = ((shown.track_deg - shown.heading_deg + 540) % 360) - 180,
        at = x + drift * unit;
      if (shown.ground_speed_kt > 10)
        this.#line(
          INK.mode,
          2,
          [at, box.top],
          [at - 5, box.top + 7],
          [at, box.top + 14],
          [at + 5, box.top + 7],
          [at, box.top],
        );
    });
    this.#readout(
      x - 24,
      48,
      box.top + 20,
      bearing((Math.round(shown.heading_deg) + 360) % 360).replace("°", ""),
      16,
    );
    this.#text(
      shown.north === "magnetic" ? "MAG" : "TRUE",
      left - 8,
      box.top + 20,
      INK.mode,
      12,
      "right",
    );
  }

  #mode(shown) {
    const { width } = this.#size,
      flaps = Math.round(shown.flaps * 100);
    const gear = shown.gear === 1 ? "GEAR DOWN" : shown.gear === 0 ? "GEAR UP" : "GEAR IN TRANSIT";
    this.#text(shown.mode.replaceAll("_", " ").toUpperCase(), 8, 13, INK.mode, 13);
    this.#text(
      gear,
      width / 2 + 20,
      13,
      shown.gear === 1 ? INK.mode : shown.gear === 0 ? INK.text : INK.caution,
      12,
      "center",
    );
    this.#text(flaps ? `FLAPS ${flaps} %` : "FLAPS UP", width - 8, 13, INK.text, 12, "right");
  }
}
