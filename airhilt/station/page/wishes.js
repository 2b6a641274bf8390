// What a person wishes of the station, until that has heard it: what may be lost with the connection.

export class Wishes {
  #send;
  #sent = 0; // when the last one was sent; each has another time
  #unheard = []; // the wishes that the station has not answered yet, in their order

  /** `send(message)` returns false if there is no connection. */
  constructor(send) {
    this.#send = send;
  }

  /**
   * Sends a wish, once. `heard()` is called when the station has heard it, or `lost(wasSent)` when
   * the connection is lost before that.
   */
  send(wish, { heard = () => {}, lost }) {
    if (!this.#send(wish)) {
      lost(false);
      return;
    }
    const sent = (this.#sent = Math.max(performance.now(), this.#sent + 0.001));
    this.#unheard.push({ sent, heard, lost });
    this.#send({ echo: sent });
  }

  /** Takes in that the station has heard all that was sent until a time of the page. */
  answered(sent) {
    const heard = this.#unheard.filter((one) => one.sent <= sent);
    this.#unheard = this.#unheard.slice(heard.length);
    for (const one of heard) one.heard();
  }

  /** Takes in that nothing more comes over a connection: tells what it may have lost, newest first. */
  lost() {
    const lost = this.#unheard.reverse();
    this.#unheard = [];
    for (const one of lost) one.lost(true);
  }

  /** Forgets the wishes of the former seat. */
  forget() {
    this.#unheard = [];
  }
}
