// The plots of surveillance radars in a live run: which are shown, and which no actor explains.

const NEAR_M = 2000; // of an actor whose data block says what the plot would
const MOST_KEPT = 2000;
const MOST_SHOWN = 500; // at a time, the newest
export const TURNS = 5; // of the antenna, whose plots are shown

const isNear = (plot, track) => {
  const [east, north] = track.place(plot.t);
  return Math.hypot(east - plot.east, north - plot.north) < NEAR_M;
};

export class RadarPlots {
  #kept = []; // each with true in `isAlone` if no actor is near that another sensor has found
  #longestTurn = 0; // s

  /** Takes in a plot, and finds out once if it is alone among the tracks there are. */
  add(plot, tracks) {
    this.#longestTurn = Math.max(this.#longestTurn, plot.turn_s);
    this.#kept.push({ plot, isAlone: !tracks.some((track) => isNear(plot, track)) });
    if (this.#kept.length > 1.2 * MOST_KEPT) this.#kept.splice(0, this.#kept.length - MOST_KEPT);
  }

  /** Takes in an actor that another sensor has found now: plots of the last turn may be of it. */
  explain(track) {
    for (let i = this.#kept.length - 1; i >= 0; i -= 1) {
      const one = this.#kept[i];
      if (track.last - one.plot.t > this.#longestTurn) continue;
      one.isAlone &&= !isNear(one.plot, track);
    }
  }

  /**
   * Returns the plots that are shown at a time, each with its age in turns. Only one of the last
   * turn is alone.
   */
  at(t) {
    const shown = [],
      past = t - TURNS * this.#longestTurn;
    for (let i = this.#kept.length - 1; i >= 0 && shown.length < MOST_SHOWN; i -= 1) {
      const { plot, isAlone } = this.#kept[i],
        age = (t - plot.t) / plot.turn_s;
      if (plot.t <= past) continue; // One that came late hides no other.
      if (age >= 0 && age < TURNS) shown.push({ plot, age, isAlone: isAlone && age < 1 });
    }
    return shown.reverse();
  }
}
