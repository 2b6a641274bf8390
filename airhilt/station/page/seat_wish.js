// What a person wants of a seat. It is sent whole at each connection, and kept when the page is
// loaded again, so that nothing depends on what was heard of it before.

const KEPT = "seat-wish";

export class SeatWish {
  #run; // name of the run: a wish is for no other

  constructor(run) {
    this.#run = run;
    const kept = JSON.parse(sessionStorage.getItem(KEPT));
    this.set(kept?.run === run ? kept : {});
  }

  /** Wants what is given, or nothing; `tuned` null: all frequencies of the seat. */
  set({ seat = null, uses = [], tuned = null }) {
    Object.assign(this, { seat, uses, tuned });
    if (seat) sessionStorage.setItem(KEPT, JSON.stringify({ run: this.#run, seat, uses, tuned }));
    else sessionStorage.removeItem(KEPT);
  }

  /** The acts by which the run learns of it. */
  get acts() {
    if (!this.seat) return [];
    return [
      { do: "take" },
      { do: "agree", uses: this.uses },
      ...(this.tuned ? [{ do: "tune", frequencies_khz: this.tuned }] : []),
    ];
  }
}
