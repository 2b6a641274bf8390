// Series of rising times and their values, and steps along them.

/** Index of the last of some rising values that is at most the given one, or 0. */
function before(values, value) {
  let low = 0, high = values.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] <= value) low = middle; else high = middle;
  }
  return low;
}

/** Value of a series at a time, linearly between its points; beyond its ends, the end. */
function at(times, values, t) {
  const i = before(times, t);
  if (i + 1 >= times.length || t <= times[i]) return values[i];
  const share = (t - times[i]) / (times[i + 1] - times[i]);
  return values[i] + share * (values[i + 1] - values[i]);
}

/** Heading in radians; between two states it turns the shorter way. */
function headingAt(track, t) {
  const i = before(track.t, t), next = Math.min(i + 1, track.t.length - 1), from = track.heading_deg[i];
  const turn = (track.heading_deg[next] - from + 540) % 360 - 180, span = track.t[next] - track.t[i];
  return (from + (span > 0 ? turn * (t - track.t[i]) / span : 0)) * Math.PI / 180;
}

/** Step of 1, 2 or 5 times a power of ten that divides a span into so many parts at most. */
function niceStep(span, most) {
  const rough = Math.max(span, 1e-9) / Math.max(most, 1), power = 10 ** Math.floor(Math.log10(rough));
  return power * [1, 2, 5, 10].find((step) => step * power >= rough * 0.999);
}
