// The time shown, which is one for all charts, and what is read off under the pointer.

const tip = html("div", { class: "tip", hidden: "" });
document.body.append(tip);
function showTip(event, lines) {
  tip.replaceChildren(...lines.map((line) => html("div", {}, line)));
  tip.hidden = false;
  const box = tip.getBoundingClientRect();
  const left = event.clientX + 16 + box.width > innerWidth ? event.clientX - 16 - box.width : event.clientX + 16;
  tip.style.left = `${Math.max(4, left)}px`;
  tip.style.top = `${Math.min(Math.max(4, event.clientY + 14), innerHeight - box.height - 4)}px`;
}
const hideTip = () => { tip.hidden = true; };
function pointer(root, width, event) {
  const box = root.getBoundingClientRect(), factor = width / box.width;
  return { x: (event.clientX - box.left) * factor, y: (event.clientY - box.top) * factor };
}

/**
 * Makes a chart over time show values under the pointer, and a click set the time. Returns a
 * function that moves a line to the time shown.
 */
function followPointer(chart, area, x, read) {
  const { root, width } = chart;
  root.classList.add("timed");
  const upright = (style) => svg("line", { class: style, y1: area.top, y2: area.bottom, visibility: style === "hover" ? "hidden" : null }), cursor = upright("cursor"), hover = upright("hover");
  root.append(cursor, hover);
  const timeAt = (event) => Math.min(Math.max(x.invert(pointer(root, width, event).x), 0), endS);
  root.addEventListener("pointermove", (event) => {
    const t = timeAt(event);
    fill(hover, { x1: x(t), x2: x(t), visibility: "visible" });
    showTip(event, [`t = ${seconds(t)}`, ...read(t)]);
    if (event.buttons & 1) clock.set(t);
  });
  root.addEventListener("pointerdown", (event) => clock.set(timeAt(event)));
  root.addEventListener("pointerleave", () => { hover.setAttribute("visibility", "hidden"); hideTip(); });
  return (t) => fill(cursor, { x1: x(t), x2: x(t) });
}

/** Shows what a part of a chart says while the pointer is on it. */
function sayAt(node, lines) {
  node.addEventListener("pointermove", (event) => showTip(event, lines));
  node.addEventListener("pointerleave", hideTip);
  return node;
}

/** Makes a chart of points `[x, y, what]` show the nearest that is within reach of the pointer. */
function pointOut({ root, width }, points, reach, read) {
  root.addEventListener("pointermove", (event) => {
    const p = pointer(root, width, event), far = ([x, y]) => Math.hypot(x - p.x, y - p.y);
    const best = points.reduce((one, other) => (far(other) < far(one) ? other : one), [Infinity, Infinity]);
    if (far(best) < reach) showTip(event, read(best[2])); else hideTip();
  });
  root.addEventListener("pointerleave", hideTip);
}

/** The time shown; `playing` and `rate` say how it passes. */
const clock = {
  playing: false,
  rate: 1,
  sound: true,
  t: [summary && summary.t_first_warning_s, timeOf("opened"), 0].find(known),
  listeners: [],
  set(t) {
    this.t = Math.min(Math.max(t, 0), endS);
    this.listeners.forEach((listener) => listener(this.t));
  },
};
/** Fastest playing at which sound and video go along, in times real time. */
const FASTEST_MEDIA = 5;
const MOST_OFF_S = 0.25;

/** Lets a sound or video that begins at a time go along with the clock; it is silent where the clock's sound is off. */
function followMedia(media, from, to, t, isWanted = true) {
  const within = from <= t && t < to;
  if (!clock.playing || clock.rate > FASTEST_MEDIA || !within || !isWanted || media.error) {
    if (media.dataset.follows && !media.paused) media.pause();
    delete media.dataset.follows;
    return within && !clock.playing;
  }
  media.playbackRate = clock.rate;
  if (Math.abs(media.currentTime - (t - from)) > MOST_OFF_S * Math.max(clock.rate, 1) && !media.seeking) media.currentTime = t - from;
  media.dataset.follows = "clock";
  if (media.paused) media.play().catch(() => {}); // A browser plays nothing before the first click on the page.
  return false;
}

/** A click on what has a time, other than on a sound or link in it, shows that time. */
document.addEventListener("click", ({ target }) => {
  const timed = target.closest("[data-t]");
  if (timed && !target.closest("audio, a")) clock.set(Number(timed.dataset.t));
});

page.shown = (listeners) => {
  clock.listeners = listeners;
  clock.set(clock.t);
};
