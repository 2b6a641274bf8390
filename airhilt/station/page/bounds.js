// Bounds of what a page keeps of a run that any program may flood.

/** Takes the oldest entries out of a map or a set that has more than `most`. */
export function keepNewest(kept, most) {
  for (const name of kept.keys()) {
    if (kept.size <= most) return;
    kept.delete(name);
  }
}
