const CLASS_COLOUR = { airplane: "#ffdd33", truck: "#5ce1ff", bird: "#ff8ce6", deer: "#8cff78", coyote: "#beff5a" };
const MOST_BOXES = 6;
const pixels = (value) => `${fixed(value, value < 10 ? 1 : 0)} px`;
const perMinute = (value) => (known(value) ? `${fixed(value, value && value < 10 ? 2 : 0)}/min` : "–");
const vision = summary && summary.vision;
const pictures = data.pictures.filter((picture) => picture.occasion !== "start"), starts = data.pictures.filter((picture) => picture.occasion === "start");
const { state, cause } = data, cameras = new Map(data.timelines.map((one) => [one.camera, one]));

const pictureLink = (href) => html("a", { href }, "picture file");

/** Shows the videos of the cameras, which go along with the time shown; one whose file is not there is left out. */
function drawVideos() {
  const videos = data.timelines.filter((one) => one.video).map((one) => {
    const video = html("video", { src: one.video, muted: "", playsinline: "", preload: "metadata", "aria-label": `Video of ${one.camera}` });
    byId("videos").append(html("figure", { class: "panel picture" }, html("figcaption", {}, html("b", {}, one.camera), html("span", {}, " video, at the time shown")), video));
    video.muted = true;
    video.addEventListener("error", () => { video.parentElement.hidden = true; });
    video.addEventListener("loadedmetadata", () => clock.set(clock.t));
    return video;
  });
  return (t) => videos.forEach((video) => {
    const isToBeSet = followMedia(video, 0, video.duration || 0, t) || clock.rate > FASTEST_MEDIA;
    if (isToBeSet && !video.seeking && Math.abs(video.currentTime - t) > 0.02) video.currentTime = Math.min(t, video.duration || 0);
  });
}

function cameraText(camera) {
  const one = cameras.get(camera);
  return one ? `${one.width_px} × ${one.height_px}, ${fixed(one.horizontal_fov_deg, 0)}°, ${fixed(one.rate_hz, one.rate_hz % 1 ? 1 : 0)} Hz${one.carrier ? `, on ${one.carrier}` : ""}` : "";
}

const OCCASIONS = { first_detection: "First detection", first_warning: "First warning", closest_approach: "Closest approach" };

/** What a picture is about, beside its time and camera. */
function occasionText(picture) {
  if (picture.occasion === "first_warning") {
    const first = advisories.find((event) => event.active && SEVERITIES.indexOf(event.severity) >= SPOKEN && event.t >= picture.t - 1e-6);
    return first && html("p", {}, severityText(first.severity), ` to ${first.who} at ${seconds(first.t)}: ${first.text}`);
  }
  if (picture.occasion === "closest_approach" && closest) {
    const before = closest.t_s - picture.t, camera = cameras.get(picture.camera);
    const when = Math.abs(before) < 1.1 / (camera ? camera.rate_hz : 10) ? "At the closest approach" : `${seconds(Math.abs(before))} ${before > 0 ? "before the closest approach: then nobody of the pair was in view" : "after the closest approach"}`;
    return html("p", {}, `${when} (${distance(closest.horizontal_m)}, ${feet(closest.vertical_m / METRE_PER_FT)}).`);
  }
  return null;
}

function boxNodes(picture, thin = false) {
  const rect = ([left, top, right, bottom], style, grow, colour) => svg("rect", { class: style, x: left - grow, y: top - grow, width: Math.max(right - left + 2 * grow, 1), height: Math.max(bottom - top + 2 * grow, 1), stroke: colour });
  const grow = thin ? 2.5 : 2;
  return [
    ...picture.truth.map((one) => rect(one.box, "true", grow)),
    ...picture.detections.flatMap((one) => [rect(one.box, "under", grow), rect(one.box, one.confirmed ? "seen" : "unconfirmed", grow, CLASS_COLOUR[one.label] || "#fff")]),
  ];
}

function pictureFigure(picture) {
  const { width, height } = picture, name = OCCASIONS[picture.occasion];
  const image = () => svg("image", { href: picture.src, width, height });
  const label = `${name}, ${picture.camera} at ${seconds(picture.t)}`;
  const frame = picture.src ? html("div", { class: "framed" }, svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label }, image(), ...boxNodes(picture)), zoom(picture, image)) : html("p", {}, pictureLink(picture.href));
  const late = known(picture.latency_s) ? `, known ${duration(picture.latency_s)} later` : ", nobody looked at it";
  return html("figure", { class: "panel picture" }, html("figcaption", {}, `${name} `, html("span", {}, "at ", timeButton(picture.t), ` s by ${picture.camera}${late}`)), frame, occasionText(picture), boxList(picture));
}

/** The boxes of a picture in words: what was found first, then what was not. */
function boxList(picture) {
  const swatch = (attributes) => svg("svg", { viewBox: "0 0 14 11", "aria-hidden": "true" }, svg("rect", { x: 1, y: 1, width: 12, height: 9, ...attributes }));
  const place = (one) => `${metres(one.range_m)} off, ${pixels(one.size_px)}`;
  const found = picture.detections.map((one) => html("li", {}, swatch({ style: `stroke: color-mix(in srgb, ${CLASS_COLOUR[one.label] || "#888"} 75%, var(--ink))`, "stroke-width": one.confirmed ? 2.4 : 1.2 }),
    html("span", { class: one.actor ? "" : "bad" }, `${one.label} ${fixed(one.confidence, 2)}${one.confirmed ? "" : ", not confirmed"}: ${one.actor ? `${one.actor}, ${place(one)}` : "about nothing"}`)));
  const missed = picture.truth.filter((one) => !one.found).map((one) => html("li", {}, swatch({ style: "stroke: var(--dim); stroke-dasharray: 2 2" }),
    html("span", { class: one.counts ? "warn" : "dim" }, `${one.actor} (${one.label}), ${place(one)}: not found${one.counts ? "" : ", too small, hidden or faint to count"}`)));
  const items = [...found, ...missed];
  return html("ul", { class: "boxes" }, items.slice(0, MOST_BOXES), keyMore(items.length - MOST_BOXES), !items.length && dim("nobody in view, and nothing found", "li"));
}

/** A magnified piece of a picture in the corner away from it, if what the picture is about is small. */
function zoom(picture, image) {
  const { width, height } = picture, size = ({ box }) => Math.max(box[2] - box[0], box[3] - box[1]), largest = (all) => all.reduce((a, b) => (a && size(a) >= size(b) ? a : b), null);
  const inPairOf = (one) => pair.includes(one.actor), about = largest(picture.truth.filter(inPairOf)) || largest(picture.detections) || largest(picture.truth);
  if (!about || size(about) > width / 5) return null;
  const [left, top, right, bottom] = about.box, wide = Math.max(size(about) * 2.4, 36), high = wide * 0.62;
  const x = Math.min(Math.max((left + right - wide) / 2, 0), width - wide), y = Math.min(Math.max((top + bottom - high) / 2, 0), height - high);
  const view = svg("svg", { class: "zoom", viewBox: `${x} ${y} ${wide} ${high}`, role: "img", "aria-label": `${about.actor || about.label}, magnified` }, image(), ...boxNodes(picture, true));
  view.style[(left + right) / 2 > width / 2 ? "left" : "right"] = "8px";
  view.style[(top + bottom) / 2 > height / 2 ? "top" : "bottom"] = "8px";
  return view;
}

function visionTiles() {
  const v = vision, first = v.first_detections.find((one) => pair.includes(one.actor)) || v.first_detections[0];
  const late = v.latency, dropped = v.dropped ? `, ${whole(v.dropped)} dropped` : "";
  const leftOut = v.exposures_left_out ? `, ${whole(v.exposures_left_out)} exposures left out` : "";
  return [
    tile("First detection", first ? metres(first.range_m) : "–", first ? `${first.actor} by ${first.camera}` : "", first ? `at ${seconds(first.t_s)}, when it was ${pixels(first.size_px)} long` : "nobody was found"),
    tile("Recall", percent(v.recall), `of ${counted(v.sightings, "sighting")}`, known(v.labels_right) ? `of what was found ${percent(v.labels_right)} had its class right` : ""),
    v.exposures_left_out
      ? tile("False detections", percent(v.false_per_picture), "of the pictures looked at", `${counted(v.false_tracks, "confirmed track")} about nothing`)
      : tile("False detections", perMinute(v.false_confirmed_per_minute), `${perMinute(v.false_per_minute)} before confirmation`, `a camera; ${counted(v.false_tracks, "confirmed track")} about nothing`, v.false_confirmed_per_minute > 1 ? "warn" : ""),
    tile("Vision latency", duration(late.p50_s), late.n ? `${duration(late.min_s)} least, ${duration(late.p95_s)} p95` : "", `${whole(v.taken)} pictures, ${whole(v.looked_at)} looked at${dropped}${leftOut}`),
  ];
}

function drawVision() {
  byId("vision-tiles").append(...visionTiles());
  byId("vision-tables").hidden = false;
  fillTable(byId("first-detections"), [["First detection of"], ["At", "number"], ["Range", "number"], ["Size", "number"], ["By"]],
    vision.first_detections.map((one) => [coloured(one.actor), seconds(one.t_s), metres(one.range_m), pixels(one.size_px), one.camera]), { empty: "Nobody was found." });
  fillTable(byId("recall"), [["Longest side"], ["Sightings", "number"], ["Recall", "number"]],
    vision.by_size.map((one) => [known(one.to_px) ? `${fixed(one.from_px, 0)} to ${pixels(one.to_px)}` : `${pixels(one.from_px)} and more`, whole(one.sightings), percent(one.recall)]));
}

function drawCameraFigures() {
  const heads = ["Pictures", "Looked at", "Dropped", "Missed", "Least", "Median", "p95", "Sightings", "Recall", "False", "Confirmed false"].map((name) => [name, "number"]);
  const count = (value) => (known(value) ? whole(value) : "–");
  const row = (name, v) => [name, ...[v.taken, v.looked_at, v.dropped, v.missed].map(count), ...[v.latency.min_s, v.latency.p50_s, v.latency.p95_s].map(duration), count(v.sightings), percent(v.recall), perMinute(v.false_per_minute), perMinute(v.false_confirmed_per_minute)];
  const named = (camera) => {
    const video = cameras.get(camera)?.video;
    return [...explained(camera, cameraText(camera)), video && html("a", { href: video }, "video")];
  };
  const rows = vision ? vision.cameras.map((v) => row(named(v.camera), v)) : [...cameras.keys()].map((camera) => [named(camera), ...heads.map(() => "–")]);
  if (vision?.cameras.length > 1) rows.push(row(html("b", {}, "all"), vision));
  byId("camera-figures").parentElement.hidden = false;
  fillTable(byId("camera-figures"), [["Camera"], ...heads], rows);
}

const FOUND = { in_view: "in view", found: "found", confirmed: "confirmed", false: "false" };

/** Draws when an actor was in view of each camera, and when it was found. */
function drawDetections() {
  if (!cameras.size) return null;
  const shown = data.timelines.slice(0, MOST_ROWS).map((one) => ({ ...one, text: one.camera.length > 18 ? `${one.camera.slice(0, 17)}…` : one.camera, colour: one.carrier ? colourOf(one.carrier) : "var(--ink)" }));
  const example = (style, y, height) => svg("rect", { class: style, x: 0, y, width: 20, height });
  fillKey("detections-key", keyItem(example("in-view", 0, 14), "in view, large and clear enough to count"), keyItem(example("found", 2, 10), "found"), keyItem(example("confirmed", 2, 10), "confirmed"),
    shown.some((camera) => camera.false.length) && keyItem(example("false", 5, 5), "confirmed, about nothing"), pictures.length && keyItem(pictureSymbol(10, 10), "picture above"));
  return timelines("detections", shown, "In view and found, over time", (one, x, y) => {
    const bars = (name, top, height) => one[name].map(([from, to]) => intervalRect(x, { from, to }, y + top, height, { class: name.replace("_", "-") }));
    return [bars("in_view", -8, 16), bars("found", -5, 10), bars("confirmed", -5, 10), bars("false", 5, 5), pictures.filter((picture) => picture.camera === one.camera).map((picture) => pictureSymbol(x(picture.t), y - 9))].flat();
  }, (t, near) => [
    ...shown.map((one) => `${one.camera}: ${Object.keys(FOUND).filter((name) => one[name].some(([from, to]) => from - 0.05 <= t && t <= to + 0.05)).map((name) => FOUND[name]).join(", ") || "nobody in view"}`),
    ...near(pictures).map((picture) => `${OCCASIONS[picture.occasion]}, ${seconds(picture.t)}`),
  ]).follow;
}
const pictureSymbol = (x, y) => svg("path", { class: "taken", d: `M${x - 5} ${y - 5}H${x + 5}L${x} ${y + 3}Z`, fill: "var(--ink)", stroke: "var(--panel)" });

byId("cameras").hidden = !cameras.size && !cause;
if (byId("cameras").hidden) return null;
const missed = vision?.missed ? `${counted(vision.missed, "picture")} could not be looked at, the first because of this: ${vision.why_missed}`
  : vision?.looked_at === 0 ? "No picture had been looked at when the run ended." : "";
byId("cameras-note").hidden = state === "on" && !missed;
byId("cameras-note").textContent = state === "on" ? missed : state === "off" ? "Nobody looked at the pictures: there is nothing to measure."
  : `Vision ${state === "lost" ? "was lost" : "is not evaluated"}${cause ? `: ${cause}` : "."}${vision?.looked_at ? " The numbers are of what was seen before." : ""}`;
byId("key-pictures").append(...pictures.map(pictureFigure));
if (known(vision?.looked_at)) drawVision();
if (cameras.size) drawCameraFigures();
byId("h-starts").hidden = !starts.length;
byId("starts").append(...starts.map(({ camera, src, href, t }) => html("figure", {}, src ? html("img", { src, alt: `View of ${camera} at ${seconds(t)}` }) : pictureLink(href),
  html("figcaption", {}, html("b", {}, camera), ` ${cameraText(camera)}`))));
return { draw: drawVideos, fit: drawDetections };
