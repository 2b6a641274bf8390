// The field of view of a camera on the plan.

import { colour } from "./dom.js";
import { line } from "./pen.js";

/** Draws the field of view of a camera, and the bearings of what it has detected. */
export function drawCamera(view, { place, heading, fov, bearings }) {
  const { pen } = view,
    [x, y] = view.pixel(place),
    reach = Math.max(3000 * view.scale, 40),
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
  for (const bearing of bearings) {
    const end = [x + 1.5 * reach * Math.sin(bearing), y - 1.5 * reach * Math.cos(bearing)];
    line(pen, colour("--warn"), 1.2, [x, y], end);
  }
}
