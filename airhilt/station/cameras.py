"""The cameras of a run as the page shows them: their exposures, and what a detector found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from airhilt.host.text import readable
from airhilt.messages import CameraFrame, CameraInfo, CameraTruth, CameraView, Detections
from airhilt.record import Logged, RunFolder
from airhilt.report.sections import Content
from airhilt.report.tracks import Locate
from airhilt.units import DEGREE, NAUTICAL_MILE, SECOND_NS

if TYPE_CHECKING:
    from airhilt.report.data import RunData

Json = dict[str, Any]
KEYS = ("camera/", "vision/", "truth/camera/")
"""Beginnings of the keys of the messages about cameras."""


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


class Cameras(Content):
    """The cameras of a run."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self.records: dict[str, CameraRecord] = {}

    def take(self, logged: Logged) -> None:
        """Receive a message about a camera, what is true of its pictures, or vision."""
        match logged.key.split("/"):
            case ["camera", name, "info"]:
                self.records[name] = CameraRecord(CameraInfo.model_validate_json(logged.data))
            case ["camera", name, "frame"] if name in self.records:
                frame = CameraFrame.model_validate_json(logged.data)
                if frame.encoding != "none":
                    self.records[name].exposures[frame.seq] = frame.t_frame_ns
                    self.records[name].views[frame.seq] = frame.view
            case ["truth", "camera", name] if name in self.records:
                truth = CameraTruth.model_validate_json(logged.data)
                self.records[name].there[truth.seq] = [
                    {"actor": readable(one.actor), "label": one.label, "box": _rounded(one.box)}
                    for one in truth.sightings
                    if one.pixels > 0.0
                ]
            case ["vision", name] if name in self.records:
                seen = Detections.model_validate_json(logged.data)
                if not seen.missed:
                    self.records[name].found[seen.seq] = found_as_json(seen)

    def as_json(self, run: RunData) -> list[Json]:  # noqa: ARG002
        """Return the cameras that took pictures; `CameraRecord.as_json` has their pictures."""
        return [
            {
                "name": name,
                "carrier": record.info.carrier,
                "width_px": record.info.width_px,
                "height_px": record.info.height_px,
                "rate_hz": record.info.rate_hz,
                "horizontal_fov_deg": record.info.horizontal_fov_deg,
                "pictures": len(record.exposures),
            }
            for name, record in self.records.items()
            if record.exposures
        ]


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
