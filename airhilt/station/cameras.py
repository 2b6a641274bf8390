"""The cameras of a run as the page shows them: their exposures, and what a detector found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from airhilt.host.text import readable
from airhilt.messages import CameraFrame, CameraInfo, CameraTruth, CameraView, Detections
from airhilt.report.tracks import Locate
from airhilt.units import DEGREE, NAUTICAL_MILE, SECOND_NS

Json = dict[str, Any]


@dataclass
class CameraRecord:
    """Everything that the log has of one camera.

    Attributes
    ----------
    exposures
        Ends of the exposures of its pictures in ns, by their numbers.
    views
        Where it stood and looked, by the number of the picture.
    found
        Boxes that a detector found, by the number of the picture.
    there
        Boxes of what was really in the picture, by its number.
    """

    info: CameraInfo
    exposures: dict[int, int] = field(default_factory=dict)
    views: dict[int, CameraView] = field(default_factory=dict)
    found: dict[int, Json] = field(default_factory=dict)
    there: dict[int, list[Json]] = field(default_factory=dict)

    def take(self, message: CameraFrame | CameraTruth | Detections) -> None:
        """Receive a picture, what is true of it, or what a detector found in it."""
        match message:
            case CameraFrame() if message.encoding != "none":
                self.exposures[message.seq] = message.t_frame_ns
                self.views[message.seq] = message.view
            case CameraTruth():
                self.there[message.seq] = [
                    {"actor": readable(one.actor), "label": one.label, "box": _rounded(one.box)}
                    for one in message.sightings
                    if one.pixels > 0.0
                ]
            case Detections() if not message.missed:
                self.found[message.seq] = found_as_json(message)

    def summary(self) -> Json:
        """Return what the page lists of the camera; `as_json` has its pictures."""
        shown = {"carrier", "width_px", "height_px", "rate_hz", "horizontal_fov_deg"}
        info = self.info.model_dump(include=shown)
        return {"name": readable(self.info.camera), **info, "pictures": len(self.exposures)}

    def as_json(self, locate: Locate) -> Json:
        """Return pictures in their order, with boxes, and where the camera looked.

        Parameters
        ----------
        locate
            Returns where a place lies on the plan, in NM.
        """
        numbers = sorted(self.exposures)
        return {
            "seq": numbers,
            "t": [round(self.exposures[seq] / SECOND_NS, 3) for seq in numbers],
            "views": [view_as_json(self.views[seq], locate) for seq in numbers],
            "found": [self.found.get(seq) for seq in numbers],
            "there": [self.there.get(seq, []) for seq in numbers],
        }


def view_as_json(view: CameraView, locate: Locate) -> list[float]:
    """Return metres east and north of the plan's centre, and the heading in degrees."""
    east_nm, north_nm = locate(
        (view.latitude_deg * DEGREE, view.longitude_deg * DEGREE), view.height_m
    )
    return _rounded((east_nm * NAUTICAL_MILE, north_nm * NAUTICAL_MILE, view.heading_deg))


def found_as_json(seen: Detections) -> Json:
    """Return what a detector found in a picture."""
    return {
        "t": round(seen.t_ns / SECOND_NS, 3),
        "boxes": [
            {
                "label": detection.label,
                "confidence": round(detection.confidence, 3),
                "box": _rounded(detection.box),
                "confirmed": detection.is_confirmed,
                "track": detection.track_id,
            }
            for detection in seen.detections
        ],
    }


def _rounded(values: Sequence[float]) -> list[float]:
    return [round(value, 1) for value in values]
