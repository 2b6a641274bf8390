// The instruments of the own aircraft between two messages: what is drawn moves evenly.

const PERIOD_MS = 200; // of the messages: five a second
const TURNING = ["heading_deg", "track_deg"];

export class Instruments {
  #before = null;
  #newest = null;
  #arrived = 0;

  /** Forgets the aircraft of another seat. */
  clear() {
    this.#before = this.#newest = null;
  }

  /** Takes in a message. */
  take(shown) {
    this.#before = this.now() ?? shown;
    this.#newest = shown;
    this.#arrived = performance.now();
  }

  /** What the instruments show at this moment, null before the first message. */
  now() {
    if (!this.#newest) return null;
    const part = Math.min((performance.now() - this.#arrived) / PERIOD_MS, 1),
      shown = { ...this.#newest };
    for (const [name, to] of Object.entries(this.#newest)) {
      const from = this.#before[name];
      if (typeof to !== "number" || typeof from !== "number") continue;
      const change = TURNING.includes(name) ? ((to - from + 540) % 360) - 180 : to - from;
      shown[name] = from + change * part;
    }
    for (const name of TURNING) shown[name] = (shown[name] + 360) % 360;
    return shown;
  }
}
