// What a person wants of a seat. It is sent whole at each connection, and kept when the page is
// loaded again, so that nothing depends on what was heard of it before.

const KEPT = "seat-wish";

export class SeatWish {
  #run; // name of the run: a wish is for no other

  constructor(run) {
    this.#run = run;
    const kept = JSON.parse(sessionStorage.getItem(KEPT));
    this.clear(kept?.run === run ? kept : {});
  }

  /** Wants a seat with these uses, and all of its frequencies. */
  sit(seat, uses) {
    this.clear({ seat, uses });
  }

  agree(uses) {
    this.clear({ ...this, uses });
  }

  tune(tuned) {
    this.clear({ ...this, tuned });
  }

  /** Wants nothing, or what is given; `tuned` null: all frequencies of the seat. */
  clear({ seat = null, uses = [], tuned = null } = {}) {
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
