// The field of view of a camera on the plan.

import { colour } from "./dom.js";

/** Draws the field of view of a camera, and the bearings of what it has detected. */
export function drawCamera(view, camera) {
  const { pen } = view,
    { place, heading, fov, bearings } = camera,
    [x, y] = view.pixel(place);
  const reach = Math.max(3000 * view.scale, 40),
    from = heading - fov / 2 - Math.PI / 2;
  pen.beginPath();
  pen.moveTo(x, y);
  pen.arc(x, y, reach, from, from + fov);
  pen.closePath();
  pen.strokeStyle = colour("--accent");
  pen.setLineDash([5, 4]);
  pen.lineWidth = 1.2;
  pen.stroke();
  pen.setLineDash([]);
  pen.strokeStyle = colour("--warn");
  for (const bearing of bearings) {
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(x + 1.5 * reach * Math.sin(bearing), y - 1.5 * reach * Math.cos(bearing));
    pen.stroke();
  }
}
