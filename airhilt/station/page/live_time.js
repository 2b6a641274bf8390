// The time of a live run between two messages: it passes evenly, at the pace of the run.

const WINDOW_MS = 2000; // of wall time over which the pace is measured
const LEAST_MS = 400; // of wall time without which there is no pace yet
const MOST_AHEAD_MS = 500; // of wall time after a message for which the time passes without another
const EVENING_MS = 300; // in which a difference from the run is evened out
const MOST_OFF_S = 1; // of the run: by more than this the time jumps

export class LiveTime {
  #told = []; // [wall time in ms, time of the run in s] of the last messages
  #t = 0;
  #shown = null;

  /** Takes in that a message came which has brought the run to a time. */
  arrived(t, now) {
    if (this.#told.at(-1)?.[1] === t) return;
    this.#told.push([now, t]);
    while (this.#told.length > 2 && now - this.#told[1][0] > WINDOW_MS) this.#told.shift();
  }

  /** Forgets the pace, because the run has another one now, and takes the time shown from there. */
  paced() {
    this.#told.splice(0, this.#told.length - 1);
  }

  /** Shows a time at once. */
  jump(t) {
    this.#t = t;
  }

  /** Seconds of the run in a millisecond. */
  get #rate() {
    if (this.#told.length < 2) return 0;
    const [[begun, from], [ended, to]] = [this.#told[0], this.#told.at(-1)];
    return ended - begun < LEAST_MS ? 0 : Math.max((to - from) / (ended - begun), 0);
  }

  /** The time of the run that is shown at a wall time: never earlier than before. */
  at(now) {
    const passed = Math.min(now - (this.#shown ?? now), MOST_AHEAD_MS),
      last = this.#told.at(-1),
      rate = this.#rate;
    this.#shown = now;
    if (!last) return this.#t;
    const due = last[1] + rate * Math.min(Math.max(now - last[0], 0), MOST_AHEAD_MS),
      furthest = last[1] + rate * MOST_AHEAD_MS,
      moved = Math.min(this.#t + rate * passed, Math.max(furthest, this.#t));
    const off = due - moved,
      most = Math.max(MOST_OFF_S, MOST_AHEAD_MS * rate);
    this.#t =
      Math.abs(off) > most
        ? due
        : Math.max(moved + off * (1 - Math.exp(-passed / EVENING_MS)), this.#t);
    return this.#t;
  }
}
