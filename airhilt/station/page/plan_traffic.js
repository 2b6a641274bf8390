// The traffic on the plan: tracks, and each actor with history, velocity leader and data block.

import { BOLD, FONT, colour, write } from "./dom.js";
import { freeBox, level } from "./labels.js";
import { METRE_PER_NM } from "./model.js";
import { symbolOf } from "./symbols.js";
import { whole } from "./words.js";

const HISTORY_DOTS = 8;
const MOST_POINTS = 1500; // of a track that are drawn

/** Draws the track of each actor, as far as it is known. */
export function drawTracks(view, tracks) {
  const { pen } = view;
  pen.lineWidth = 1;
  pen.setLineDash([2, 3]);
  for (const track of tracks) {
    const step = Math.ceil(track.t.length / MOST_POINTS) || 1,
      points = [];
    for (let i = track.t.length - 1; i >= 0; i -= step)
      points.push([track.east[i], track.north[i]]);
    view.path(points);
    pen.strokeStyle = colour(track.colour);
    pen.stroke();
  }
  pen.setLineDash([]);
}

/** Draws an actor at a time: its history, its symbol, and its leader of some seconds. */
export function drawActor(view, run, { track, state }, t, leaderS) {
  const { pen } = view,
    [x, y] = view.pixel([state.east, state.north]),
    ink = colour(track.colour);
  if (state.ended) {
    drawEnd(pen, x, y, ink);
    return;
  }
  drawHistory(view, run, track, state, t);
  drawLeader(view, state, leaderS, ink);
  const severity = run.severityOf(track.callsign, t);
  if (severity) drawSeverity(pen, x, y, severity);
  const { shape, least } = symbolOf(track.category);
  const size = Math.max(((track.length_m ?? 0) * view.scale) / 2, least),
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

/** Draws a cross where an actor has ended. */
function drawEnd(pen, x, y, ink) {
  pen.strokeStyle = ink;
  pen.lineWidth = 2.2;
  pen.beginPath();
  for (const side of [-1, 1]) {
    pen.moveTo(x - 5, y - 5 * side);
    pen.lineTo(x + 5, y + 5 * side);
  }
  pen.stroke();
}

/** Draws dots behind an actor, where it was some seconds ago. */
function drawHistory(view, run, track, state, t) {
  const { pen } = view,
    every = run.airport ? 3 : 5,
    [x, y] = view.pixel([state.east, state.north]);
  pen.fillStyle = colour(track.colour);
  for (let i = 1; i <= HISTORY_DOTS; i += 1) {
    const then = t - i * every;
    if (then < track.first) break;
    const [px, py] = view.pixel(track.place(then));
    if (Math.hypot(px - x, py - y) < 3) continue;
    pen.beginPath();
    pen.arc(px, py, 2.2 - i * 0.12, 0, 2 * Math.PI);
    pen.fill();
  }
}

/** Draws the velocity leader before an actor, if it is long enough to be seen. */
function drawLeader(view, state, leaderS, ink) {
  const { pen } = view,
    ahead = leaderS * state.speed;
  if (ahead * view.scale < 6) return;
  pen.beginPath();
  pen.moveTo(...view.pixel([state.east, state.north]));
  pen.lineTo(
    ...view.pixel([
      state.east + ahead * Math.sin(state.course),
      state.north + ahead * Math.cos(state.course),
    ]),
  );
  pen.strokeStyle = ink;
  pen.lineWidth = 1.4;
  pen.stroke();
}

/** Draws the shape around an actor that an advisory is about. */
function drawSeverity(pen, x, y, severity) {
  const sides = { WARNING: 4, CAUTION: 3 }[severity] ?? 40,
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

/** Draws data blocks, each where it covers no other, no symbol, and none of the boxes of names. */
export function drawBlocks(view, run, states, t, names) {
  const { pen, width, height } = view;
  const taken = states.map(({ state }) => {
    const [x, y] = view.pixel([state.east, state.north]);
    return [x - 9, y - 9, x + 9, y + 9];
  });
  taken.push(...names);
  pen.textAlign = "left";
  for (const { track, state } of states) {
    const [x, y] = view.pixel([state.east, state.north]);
    if (x < -20 || y < -20 || x > width + 20 || y > height + 20) continue;
    const severity = state.ended ? null : run.severityOf(track.callsign, t),
      lines = linesOf(track, state, severity);
    const wide =
        Math.max(
          ...lines.map((line, i) => {
            pen.font = i ? FONT : BOLD;
            return pen.measureText(line).width;
          }),
        ) + 14,
      high = lines.length * 14 + 2;
    const box = freeBox(view, [x, y], [wide, high], taken);
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
      drawArrow(
        pen,
        box[0] + 2 + pen.measureText(level(state.altitude)).width + 6,
        box[1] + 22,
        state.rate > 0,
      );
  }
}

/** Returns the lines of a data block. */
function linesOf(track, state, severity) {
  if (state.ended) return [track.callsign, "ended"];
  const knots = whole((state.speed * 3600) / METRE_PER_NM);
  const second = state.onGround
    ? `${state.phase || "ground"} ${knots} kt`
    : `${level(state.altitude)}     ${knots} kt`;
  return severity ? [track.callsign, second, severity] : [track.callsign, second];
}

/** Draws an arrow, up or down, in a data block. */
function drawArrow(pen, x, y, up) {
  const side = up ? 1 : -1;
  pen.beginPath();
  pen.moveTo(x, y - 5 * side);
  pen.lineTo(x + 4, y + 4 * side);
  pen.lineTo(x - 4, y + 4 * side);
  pen.closePath();
  pen.fillStyle = colour("--ink");
  pen.fill();
}
