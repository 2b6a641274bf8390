// Where each actor was, and how far apart the pair was.

/** Time before and after an instant over which its speed is a mean, in s. */
const SMOOTHED_S = airport ? 1 : 4;

/** The state of an actor at a time. */
function stateAt(track, t) {
  const last = track.t.at(-1);
  const t1 = Math.min(Math.max(t, track.t[0]), last);
  const here = (name, time) => at(track.t, track[name], time);
  const from = Math.max(t1 - SMOOTHED_S, track.t[0]), to = Math.min(t1 + SMOOTHED_S, last), span = Math.max(to - from, 1e-9);
  const east = here("east_nm", to) - here("east_nm", from), north = here("north_nm", to) - here("north_nm", from);
  return {
    east: here("east_nm", t1), north: here("north_nm", t1), altitude: here("altitude_ft", t1),
    speed: Math.hypot(east, north) / span * 3600, heading: track.heading_deg ? headingAt(track, t1) : Math.atan2(east, north),
    onGround: track.on_ground.some(([down, up]) => down <= t1 && t1 <= up), phase: phaseAt(track, t1),
    rate: (here("altitude_ft", to) - here("altitude_ft", from)) / span * 60, ended: t > last + 1 && last < endS - 1,
  };
}

const phaseAt = (track, t) => words(track.phases.findLast((candidate) => candidate.from <= t)?.what ?? "");

const isPair = (track) => pair.includes(track.callsign);
const tracks = [...run.tracks].sort((a, b) => isPair(b) - isPair(a));
const trackOf = (callsign) => tracks.find((track) => track.callsign === callsign);
const few = tracks.length <= MOST_COLOURED;
tracks.forEach((track, index) => {
  track.colour = few || isPair(track) ? `var(--c${index % MOST_COLOURED})` : "var(--other)";
  track.prominent = few || isPair(track);
});

/** True if no separation minimum is set for the pair: on a runway, or with wildlife. */
const closeUp = (() => {
  const both = tracks.filter(isPair), opened = timeOf("opened");
  if (both.length < 2) return Boolean(airport);
  if (both.some((track) => track.category !== "aircraft") || known(timeOf("runway_incursion"))) return true;
  const t = known(opened) ? opened : closest ? closest.t_s : 0;
  return Boolean(airport) && both.some((track) => stateAt(track, t).onGround);
})();
const distance = (value) => (closeUp ? metres(value) : miles(value / METRE_PER_NM));
const apartText = (apart) => [distance(apart.nm * METRE_PER_NM), feet(apart.ft)];
const lowAndHigh = (values) => values.reduce(({ low, high }, value) => ({ low: Math.min(low, value), high: Math.max(high, value) }), { low: Infinity, high: -Infinity });

/** The part of the plane that points `[east, north]` need. */
const boxOf = (points) => ({ east: lowAndHigh(points.map(([east]) => east)), north: lowAndHigh(points.map(([, north]) => north)) });

/** Separation of the pair. Its true closest approach, which lies between two points, is inserted. */
const separations = (() => {
  const series = run.separations;
  if (!series || !series.t.length) return null;
  if (!closest || series.t.includes(closest.t_s)) return series;
  const i = series.t.findIndex((t) => t > closest.t_s), k = i < 0 ? series.t.length : i;
  const inserted = (name, value) => series[name].toSpliced(k, 0, value);
  return { t: inserted("t", closest.t_s), horizontal_nm: inserted("horizontal_nm", closest.horizontal_m / METRE_PER_NM), vertical_ft: inserted("vertical_ft", closest.vertical_m / METRE_PER_FT) };
})();
/** Separation of the pair at a time, or null once it has ended. */
const apartAt = (t) => separations && t <= separations.t.at(-1) + 1
  ? { nm: at(separations.t, separations.horizontal_nm, t), ft: at(separations.t, separations.vertical_ft, t) } : null;

const colourOf = (callsign) => (trackOf(callsign) ?? { colour: "var(--other)" }).colour;
