// Symbols of actors and events, and the keys of charts.

const SEVERITY_COLOUR = { INFO: "var(--dim)", ADVISORY: "var(--accent)", CAUTION: "var(--warn)", WARNING: "var(--bad)" };
function advisorySymbol(x, y, severity) {
  const filled = SEVERITIES.indexOf(severity) >= SPOKEN, colour = SEVERITY_COLOUR[severity] || "var(--dim)";
  return svg("path", { d: `M${x} ${y - 6}L${x + 6} ${y + 5}L${x - 6} ${y + 5}Z`, fill: filled ? colour : "var(--panel)", stroke: colour, "stroke-width": 1.6 });
}
const reactionSymbol = (x, y) => svg("path", { d: `M${x} ${y - 6}L${x + 6} ${y}L${x} ${y + 6}L${x - 6} ${y}Z`, fill: "var(--panel)", stroke: "var(--ink)", "stroke-width": 1.6 });
const crossSymbol = (x, y, colour = "var(--ink)") => svg("path", { d: `M${x - 5} ${y - 5}L${x + 5} ${y + 5}M${x - 5} ${y + 5}L${x + 5} ${y - 5}`, stroke: colour, "stroke-width": 2.2, fill: "none" });
const arrowSymbol = (x, y, heading, colour) => svg("path", {
  d: "M0 -8L6 7L0 4L-6 7Z", fill: colour, stroke: "var(--panel)", "stroke-width": 1,
  transform: `translate(${x.toFixed(1)} ${y.toFixed(1)}) rotate(${(heading * 180 / Math.PI).toFixed(1)})`,
});
/** Shapes of bodies, one long and one wide, pointing up, and how many pixels they are long at least. */
const SHAPES = {
  aircraft: ["M0 -.5C.035 -.5 .05 -.43 .05 -.37V-.14L.5 .1V.17L.05 .07L.035 .33L.19 .42V.48L0 .45L-.19 .48V.42L-.035 .33L-.05 .07L-.5 .17V.1L-.05 -.14V-.37C-.05 -.43 -.035 -.5 0 -.5Z", 24],
  vehicle: ["M-.5 .5V-.2L-.3 -.5H.3L.5 -.2V.5Z", 13],
};
const PAW = "M0 -.5C3 -.5 5 5.5 0 5.5S-3 -.5 0 -.5ZM-6 -1a1.6 2 0 1 0 3.2 0a1.6 2 0 1 0 -3.2 0M-3.2 -4.2a1.6 2 0 1 0 3.2 0a1.6 2 0 1 0 -3.2 0M.1 -4.2a1.6 2 0 1 0 3.2 0a1.6 2 0 1 0 -3.2 0M2.9 -1a1.6 2 0 1 0 3.2 0a1.6 2 0 1 0 -3.2 0";
const BIRD = "M-9 -2Q-5 -7 0 -1Q5 -7 9 -2Q5 -3.5 0 4Q-5 -3.5 -9 -2Z";

/** Symbol of an actor on a plan: to scale where that is large enough to be seen. */
function bodySymbol(x, y, track, state, perMetre) {
  const move = `translate(${x.toFixed(1)} ${y.toFixed(1)})`, turn = `rotate(${(state.heading * 180 / Math.PI).toFixed(1)})`;
  if (track.category === "wildlife") return svg("path", { class: "body", d: state.onGround ? PAW : BIRD, fill: track.colour, transform: move });
  const isVehicle = track.category === "vehicle", [d, least] = SHAPES[isVehicle ? "vehicle" : "aircraft"];
  const long = known(track.length_m) ? Math.max(track.length_m * perMetre, least) : least;
  const wide = long * (isVehicle ? 0.55 : known(track.span_m) ? track.span_m / track.length_m : 0.9);
  return svg("path", { class: "body", d, fill: track.colour, transform: `${move} ${turn} scale(${wide.toFixed(1)} ${long.toFixed(1)})` });
}
const keyItem = (symbol, text) => html("li", {}, svg("svg", { viewBox: "0 0 20 14", "aria-hidden": "true" }, symbol), text);
const keyLine = (attributes) => line(0, 7, 20, 7, attributes);
const keyMore = (n, what = "") => n > 0 && dim(`and ${n} more${what}`, "li");

/** Key of the conflict window, false if there was none. */
const windowKey = () => known(timeOf("opened")) && keyItem(svg("rect", { class: "window", width: 20, height: 14 }), "conflict window");
