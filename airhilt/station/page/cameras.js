// The picture of a camera at the time shown, as the run has kept it or drawn again by the server,
// with the boxes of a detector.

import { Pane } from "./pane.js";
import { byId, offer, on, svg } from "./dom.js";
import { identity } from "./identity.js";
import { before } from "./series.js";
import { counted, fixed, seconds } from "./words.js";

const FOUND = "#ffdd33",
  THERE = "#5ce1ff";
const MOST_RECORDS = 1000; // of pictures of a camera of a live run: about a minute
const PATIENCE_MS = 30000; // with a server that draws
const RADIANS = Math.PI / 180;

export class Cameras extends Pane {
  #plan;
  #watch;
  #choice = byId("camera");
  #image = byId("camera-image");
  #boxes = byId("camera-boxes");
  #records = new Map();
  #shown = "";
  #carrier = undefined;
  #isLoading = false;
  #failure = ""; // why no picture can be drawn here
  #missing = ""; // the picture that did not come, and is not asked for once more

  /** `watch(name)` lets the pictures of a camera of a live run come. */
  constructor(run, clock, plan, watch) {
    super(run, clock);
    this.#watch = watch;
    this.#plan = plan;
    this.#choice.addEventListener("change", () => this.#open());
    for (const id of ["camera-found", "camera-there"]) on(id, "change", () => this.#drawBoxes());
    this.renew();
  }

  /**
   * Offers only the cameras that an actor carries, those of the ground with null, or all with
   * undefined.
   */
  offer(carrier) {
    if (carrier === this.#carrier) return;
    this.#carrier = carrier;
    this.#close();
    this.renew();
  }

  /** Forgets the pictures, as the run has forgotten the cameras. */
  forget() {
    this.#records.clear();
    this.#close();
    this.renew();
  }

  #close() {
    this.#choice.value = "";
    this.#image.removeAttribute("src");
    this.#hide("");
    this.#plan.setCamera(null);
  }

  get #offered() {
    return this.run.cameras.filter(
      (camera) => this.#carrier === undefined || camera.carrier === this.#carrier,
    );
  }

  /** Lists the cameras, and opens the first one if none is open. */
  renew() {
    const chosen = this.#choice.value,
      offered = this.#offered;
    offer(
      this.#choice,
      offered.map(({ name }) => name),
    );
    this.#choice.hidden = !offered.length;
    document.body.dataset.camera = offered.length ? "some" : "none";
    if (offered.length && this.#choice.value !== chosen) this.#open();
    else if (offered.length) return;
    else
      byId("camera-none").textContent = this.#carrier
        ? "This aircraft has no camera."
        : this.clock.live
          ? "No pictures so far."
          : "This run has no pictures.";
  }

  /** Adds a picture of a live run. */
  add(name, seq, t, view, found) {
    const record = this.#records.get(name) ?? { seq: [], t: [], views: [], found: [], there: [] };
    this.#records.set(name, record);
    if (record.seq.length && seq <= record.seq.at(-1)) return;
    for (const [part, value] of Object.entries({ seq, t, views: view, found, there: [] }))
      record[part].push(value);
    if (record.seq.length > 1.2 * MOST_RECORDS)
      for (const values of Object.values(record)) values.splice(0, values.length - MOST_RECORDS);
  }

  /** Shows another camera. */
  choose(name) {
    if (!this.#offered.some((camera) => camera.name === name)) return;
    this.#choice.value = name;
    this.#open();
  }

  get #camera() {
    return this.run.cameras.find((camera) => camera.name === this.#choice.value);
  }

  async #open() {
    const { name, width_px: width, height_px: height } = this.#camera;
    byId("picture").style.aspectRatio = `${width} / ${height}`;
    this.#boxes.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.#shown = "";
    this.#failure = this.#missing = "";
    if (this.clock.live) this.#watch(name);
    else if (!this.#records.has(name)) {
      const content = await answered(`api/cameras/${encodeURIComponent(name)}`);
      if (!content.seq) {
        if (this.#camera?.name !== name) return;
        this.#plan.setCamera(null);
        this.#hide(content.error ?? "The server does not answer.");
        return;
      }
      this.#records.set(name, content);
    }
    if (this.#camera?.name === name) this.draw();
  }

  /** Shows the newest picture at the time shown; while one is on its way, none is asked for. */
  draw() {
    const record = this.#camera && this.#records.get(this.#camera.name);
    if (!record?.seq.length) return;
    const i = before(record.t, this.clock.t);
    this.#point(record, i);
    if (this.#failure && !isKept(record, i)) this.#hide(this.#failure);
    else this.#load(record, i);
  }

  /** Shows on the plan where the camera looks. */
  #point(record, i) {
    const view = record.views[i];
    const { width_px: width, horizontal_fov_deg: fov } = this.#camera,
      heading = view && view[2] * RADIANS;
    const focal = width / 2 / Math.tan((fov * RADIANS) / 2),
      bearing = ({ box }) => heading + Math.atan(((box[0] + box[2]) / 2 - width / 2) / focal);
    this.#plan.setCamera(
      view && {
        place: [view[0], view[1]],
        heading,
        fov: fov * RADIANS,
        bearings: (record.found[i]?.boxes ?? []).map(bearing),
      },
    );
  }

  async #load(record, i) {
    const { name } = this.#camera,
      { live } = this.clock,
      wanted = `${name}/${record.seq[i]}`;
    if (this.#isLoading || wanted === this.#shown || wanted === this.#missing) return;
    this.#isLoading = true;
    if (!this.#shown && !this.#failure && !live && !isKept(record, i))
      byId("camera-none").textContent = "Drawing the first picture. That takes some seconds.";
    const arrived = new Image();
    arrived.src = `api/cameras/${encodeURIComponent(name)}/${record.seq[i]}.jpg?browser=${identity()}`;
    const isThere = await arrived.decode().then(
      () => true,
      () => false,
    );
    const why = isThere || live ? "" : ((await answered(arrived.src)).error ?? "");
    this.#isLoading = false;
    if (!isThere && live) return; // It is an old one, which is not kept.
    if (this.#camera?.name === name && isThere) {
      this.#image.src = arrived.src;
      this.#image.alt = `Camera ${name} at ${seconds(record.t[i])}`;
      this.#image.hidden = false;
      byId("camera-none").textContent = "";
      this.#shown = wanted;
      this.#missing = "";
      this.#drawBoxes();
    } else if (this.#camera?.name === name) {
      this.#missing = wanted;
      if (!isKept(record, i)) this.#failure = why; // Without a reason, others may come.
      this.#hide(why || "The picture did not come. Go to another one and back.");
    }
    this.draw();
  }

  /** Shows a text in the place of a picture. */
  #hide(text) {
    this.#shown = "";
    this.#image.hidden = true;
    this.#image.alt = "";
    this.#boxes.replaceChildren();
    byId("camera-caption").textContent = "";
    byId("camera-none").textContent = text;
  }

  #drawBoxes() {
    const record = this.#records.get(this.#camera?.name),
      i = record?.seq.indexOf(Number(this.#shown.split("/")[1])) ?? -1;
    this.#boxes.replaceChildren();
    if (i < 0) return;
    const found = record.found[i],
      there = record.there[i],
      wide = this.#camera.width_px / 640;
    if (byId("camera-there").checked)
      for (const one of there) this.#box(one.box, THERE, `${one.actor}`, true, wide);
    if (byId("camera-found").checked && found)
      for (const one of found.boxes)
        this.#box(one.box, FOUND, `${one.label} ${fixed(one.confidence, 2)}`, !one.confirmed, wide);
    const seen = found
      ? `${counted(found.boxes.length, "detection")} after ${seconds(found.t - record.t[i], 2)}`
      : "no detector looked at it";
    const origin = isKept(record, i) ? "as it was" : "drawn again from the log";
    byId("camera-caption").textContent =
      `Picture ${record.seq[i]} at ${seconds(record.t[i], 2)}, ${this.clock.live ? "" : `${origin}; `}${seen}`;
  }

  #box([left, top, right, bottom], ink, text, isDashed, wide) {
    const frame = {
      x: left - 3,
      y: top - 3,
      width: right - left + 6,
      height: bottom - top + 6,
      stroke: ink,
      "stroke-width": 2,
      "stroke-dasharray": isDashed ? "5 4" : null,
    };
    const y = top > 24 * wide ? top - 8 * wide : bottom + 20 * wide,
      words = { x: left - 3, y, fill: ink, "font-size": 14 * wide };
    this.#boxes.append(svg("rect", frame), svg("text", words, text));
  }
}

/** Returns what the server answers as JSON, an object without content if it does not. */
async function answered(place) {
  try {
    const answer = await fetch(place, { signal: AbortSignal.timeout(PATIENCE_MS) });
    return await answer.json();
  } catch {
    return {};
  }
}

/** Returns true if a run has kept a picture: it need not be drawn again. */
const isKept = (record, i) => record.kept?.includes(record.seq[i]) ?? false;
