"""The plan view: tracks, the airport below them, and traffic and cameras at the time shown."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from airhilt.messages import CameraFrame, CameraInfo, CameraView, Detections
from airhilt.record import Logged, RunFolder
from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section
from airhilt.units import DEGREE, SECOND_NS

Json = dict[str, Any]
PERIOD_NS = SECOND_NS // 2
"""Least time between two directions of a camera that are drawn, in ns."""
MOST_LOOKS = 1500
"""Largest number of them for a camera: the first ones."""
Pose = tuple[float, float, float, float]
"""Latitude and longitude in degrees, height in m, heading in degrees."""


class _Camera:
    """Where one camera stood and looked, and in which directions a detector has found something."""

    def __init__(self, info: CameraInfo) -> None:
        self.info = info
        self.poses: list[tuple[int, Pose]] = []
        self.found: list[tuple[int, list[float]]] = []

    def look(self, frame: CameraFrame) -> None:
        view = frame.view
        pose = (view.latitude_deg, view.longitude_deg, view.height_m, view.heading_deg)
        if not self.poses or (pose != self.poses[-1][1] and _is_due(self.poses, frame.t_frame_ns)):
            self.poses.append((frame.t_frame_ns, pose))

    def see(self, seen: Detections) -> None:
        bearings = [_bearing_deg(seen.view, one.box) for one in seen.detections]
        is_other = bool(bearings) or (bool(self.found) and bool(self.found[-1][1]))
        if is_other and _is_due(self.found, seen.t_frame_ns):
            self.found.append((seen.t_frame_ns, bearings))

    def as_json(self, run: RunData) -> Json:
        def placed(pose: Pose) -> list[float]:
            east_nm, north_nm = run.locate((pose[0] * DEGREE, pose[1] * DEGREE), pose[2])
            return [round(east_nm, 4), round(north_nm, 4), round(pose[3], 1)]

        return {
            "camera": self.info.camera,
            "fov_deg": self.info.horizontal_fov_deg,
            "poses": [[round(t_ns / SECOND_NS, 2), *placed(pose)] for t_ns, pose in self.poses],
            "found": [[round(t_ns / SECOND_NS, 2), bearings] for t_ns, bearings in self.found],
        }


class Plan(Content):
    """The fields of view of the cameras, and the bearings of what was found in their pictures."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._cameras: dict[str, _Camera] = {}

    def take(self, logged: Logged) -> None:
        """Receive a message about a camera, or what a detector found."""
        match logged.key.split("/"):
            case ["camera", name, "info"]:
                self._cameras[name] = _Camera(CameraInfo.model_validate_json(logged.data))
            case ["camera", name, "frame"] if name in self._cameras:
                self._cameras[name].look(CameraFrame.model_validate_json(logged.data))
            case ["vision", name] if name in self._cameras:
                seen = Detections.model_validate_json(logged.data)
                if not seen.missed:
                    self._cameras[name].see(seen)

    def as_json(self, run: RunData) -> list[Json]:
        """Return the cameras that took pictures."""
        return [camera.as_json(run) for camera in self._cameras.values() if camera.poses]


def _is_due(looks: Sequence[tuple[int, object]], t_ns: int) -> bool:
    return not looks or (t_ns - looks[-1][0] >= PERIOD_NS and len(looks) < MOST_LOOKS)


def _bearing_deg(view: CameraView, box: tuple[float, float, float, float]) -> float:
    """Return the true bearing of the middle of a box in a picture."""
    focal_px = view.width_px / 2.0 / math.tan(view.horizontal_fov_deg * DEGREE / 2.0)
    off_rad = math.atan(((box[0] + box[2]) / 2.0 - view.width_px / 2.0) / focal_px)
    return round((view.heading_deg + off_rad / DEGREE) % 360.0, 1)


SECTION = Section(
    "plan", order=10, module=__file__, content=Plan, keys=("camera/", "vision/"), within="flight"
)
