"use strict";
// Series of rising times and their values.

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
