// The part of the plan that is shown: where its places are on the canvas.

const LONGEST_SHOWN_M = 900_000;
const MOST_PIXELS = 20; // a metre
export const ROOM = 90; // pixels for the data blocks of who is at the edge

export class PlanView {
  pen = null; // of the canvas, null until it has a size
  width = 0;
  height = 0;
  scale = 0.01; // pixels a metre
  #centre = [0, 0];

  /** Returns where a place, metres east and north, is on the canvas. */
  pixel([east, north]) {
    return [
      this.width / 2 + (east - this.#centre[0]) * this.scale,
      this.height / 2 - (north - this.#centre[1]) * this.scale,
    ];
  }

  /** Returns where some places are on the canvas. */
  pixels(places) {
    return places.map((place) => this.pixel(place));
  }

  /** Moves what is shown by some pixels. */
  move(dx, dy) {
    this.#centre = [this.#centre[0] - dx / this.scale, this.#centre[1] + dy / this.scale];
  }

  /** Zooms about a point of the canvas. */
  zoom(factor, px, py) {
    const { width, height } = this,
      least = Math.min(width, height) / LONGEST_SHOWN_M,
      scale = Math.min(Math.max(this.scale * factor, least), MOST_PIXELS),
      shift = 1 / this.scale - 1 / scale;
    this.#centre = [
      this.#centre[0] + (px - width / 2) * shift,
      this.#centre[1] - (py - height / 2) * shift,
    ];
    this.scale = scale;
  }

  /** Shows bounds, and some more of the width than they need. */
  show({ east: [west, east], north: [south, north] }, spare = 0) {
    this.#centre = [(west + east) / 2, (south + north) / 2];
    this.scale =
      Math.min(
        Math.max(this.width - ROOM, 80) / Math.max(east - west, 200),
        Math.max(this.height - ROOM, 80) / Math.max(north - south, 200),
      ) *
      (1 - spare);
  }
}
