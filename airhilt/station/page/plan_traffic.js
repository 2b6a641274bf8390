// The traffic on the plan: tracks, and each actor with history, velocity leader and data block.

import { colour } from "./dom.js";
import { freeBox, level } from "./labels.js";
import { BOLD, FONT, line, severityInk, stamp, write } from "./pen.js";
import { whole } from "./words.js";

const HISTORY_DOTS = 8;
const MOST_POINTS = 1500; // of a track that are drawn
// From which an arrow shows that an actor climbs or descends: three steps of the rate that ADS-B
// reports (64 ft/min, RTCA DO-260B, 2.2.3.2.6.1).
const CLIMBS_FPM = 200;
// Outlines about an actor, by the severity of the advisory about it.
const AROUND = {
  WARNING: new Path2D("M14-14V14H-14V-14Z"),
  CAUTION: new Path2D("M0-25 21.7 12.5H-21.7Z"),
};
const CIRCLE = new Path2D("M-20 0a20 20 0 1 0 40 0a20 20 0 1 0-40 0Z");
const ARROW = new Path2D("M0-5 4 4H-4Z");

// Outlines of actors, nose up, in half lengths.
const AIRCRAFT = new Path2D(
  "M0-1 .12-.7V-.25L1 .2V.36L.12 .14 .08 .66 .4 .86V1L0 .9-.4 1V.86L-.08 .66-.12 .14-1 .36V.2L-.12-.25V-.7Z",
);
const OUTLINES = {
  vehicle: new Path2D("M.3-1 .6-.5V1H-.6V-.5L-.3-1Z"),
  wildlife: new Path2D("M0-.9 .9 0 0 .9-.9 0Z"),
};

/** Draws the track of each actor, as far as it is known. */
export function drawTracks(view, tracks) {
  const { pen } = view;
  pen.setLineDash([2, 3]);
  for (const track of tracks) {
    const places = track.thinned(MOST_POINTS).map((i) => [track.east[i], track.north[i]]),
      points = view.pixels(places);
    line(pen, colour(track.colour), 1, ...points);
  }
  pen.setLineDash([]);
}

/** Draws an actor at a time: its history, its symbol, and its leader of some seconds. */
export function drawActor(view, run, { track, state }, t, leaderS) {
  const { pen } = view,
    [x, y] = view.pixel([state.east, state.north]),
    ink = colour(track.colour);
  if (state.ended) {
    for (const side of [-1, 1]) line(pen, ink, 2.2, [x - 5, y - 5 * side], [x + 5, y + 5 * side]);
    return;
  }
  drawHistory(view, run, track, [x, y], t);
  const ahead = leaderS * state.speed * view.scale,
    [sin, cos] = [Math.sin(state.course), Math.cos(state.course)];
  if (ahead >= 6) line(pen, ink, 1.4, [x, y], [x + ahead * sin, y - ahead * cos]);
  const severity = run.severityOf(track.callsign, t);
  if (severity)
    stamp(pen, AROUND[severity] ?? CIRCLE, [x, y], { edge: severityInk(severity), width: 2 });
  drawSymbol(view, track, state.heading, [x, y]);
}

function drawSymbol({ pen, scale }, track, heading, place) {
  const outline = OUTLINES[track.category] ?? AIRCRAFT,
    least = outline === AIRCRAFT ? 10 : 6, // half length in pixels
    size = Math.max(((track.length_m ?? 0) * scale) / 2, least);
  const look = { fill: colour(track.colour), edge: colour("--map"), turn: heading, size };
  stamp(pen, outline, place, look);
}

/** Draws dots behind an actor, where it was some seconds ago. */
function drawHistory(view, run, track, [x, y], t) {
  const { pen } = view,
    every = run.airport ? 3 : 5;
  pen.fillStyle = colour(track.colour);
  for (let i = 1; i <= HISTORY_DOTS && t - i * every >= track.first; i += 1) {
    const [px, py] = view.pixel(track.place(t - i * every));
    if (Math.hypot(px - x, py - y) < 3) continue;
    pen.beginPath();
    pen.arc(px, py, 2.2 - i * 0.12, 0, 2 * Math.PI);
    pen.fill();
  }
}

/** Draws data blocks, each where it covers no other, no symbol, and none of the boxes of names. */
export function drawBlocks(view, run, states, t, names) {
  const { pen, width, height } = view;
  const placed = states.map(({ track, state }) => ({
    track,
    state,
    at: view.pixel([state.east, state.north]),
  }));
  const taken = [...placed.map(({ at: [x, y] }) => [x - 9, y - 9, x + 9, y + 9]), ...names];
  pen.textAlign = "left";
  for (const { track, state, at } of placed) {
    const [x, y] = at;
    if (x < -20 || y < -20 || x > width + 20 || y > height + 20) continue;
    const severity = state.ended ? null : run.severityOf(track.callsign, t),
      lines = linesOf(track, state, severity);
    const wides = lines.map(({ text, font }) => {
      pen.font = font;
      return pen.measureText(text).width;
    });
    const size = [Math.max(...wides) + 14, lines.length * 14 + 2],
      [left, top, right, bottom] = freeBox(view, at, size, taken),
      nearest = [Math.min(Math.max(x, left), right), Math.min(Math.max(y, top), bottom)];
    taken.push([left, top, right, bottom]);
    line(pen, colour("--dim"), 1, at, nearest);
    lines.forEach(({ text, font, ink }, i) => {
      pen.font = font;
      write(pen, text, left + 2, top + 12 + i * 14, ink, colour("--map"));
    });
    if (state.ended || state.onGround || Math.abs(state.rate) < CLIMBS_FPM) continue;
    const place = [left + 8 + pen.measureText(level(state.altitude)).width, top + 22];
    stamp(pen, ARROW, place, { fill: colour("--ink"), turn: state.rate > 0 ? 0 : Math.PI });
  }
}

/** Returns the lines of a data block. */
function linesOf(track, state, severity) {
  const knots = whole(state.knots),
    ink = colour("--ink");
  const second = state.ended
    ? "ended"
    : state.onGround
      ? `${state.phase || "ground"} ${knots} kt`
      : `${level(state.altitude)}     ${knots} kt`;
  const lines = [
    { text: track.callsign, font: BOLD, ink: colour(track.colour) },
    { text: second, font: FONT, ink },
  ];
  if (severity) lines.push({ text: severity, font: FONT, ink: severityInk(severity) });
  return lines;
}
