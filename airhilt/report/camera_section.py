"""What the report shows of cameras: key pictures, and when somebody was in view and found."""

from __future__ import annotations

import base64
import os
from pathlib import Path
from typing import Any
from urllib.parse import quote

from airhilt.imaging.boxes import size_px
from airhilt.imaging.matching import matches
from airhilt.messages import CameraFrame, CameraInfo, CameraTruth, Detections, SightingTruth, Status
from airhilt.metrics.detection_scores import MOST_PICTURES_BEHIND, must_be_found
from airhilt.record import Logged, RunFolder
from airhilt.record.pictures import OCCASIONS, PictureName
from airhilt.units import SECOND_NS

Json = dict[str, Any]

MOST_CHARACTERS = 4_000_000
"""Of all pictures in a page."""
MOST_SPANS = 200
"""Of one kind in one lane."""
BRIDGED_NS = SECOND_NS // 2
"""Shorter pauses are left out of a lane: pictures that were dropped, and a miss or two."""
MOST_BOXES = 60
"""Of detections in one picture, and as many true ones."""
MEDIA = {".png": "image/png", ".jpg": "image/jpeg"}


class Spans:
    """From when to when something was so, without short pauses."""

    def __init__(self) -> None:
        self._bridged_ns = BRIDGED_NS
        self._spans: list[tuple[int, int]] = []

    def add(self, t_ns: int) -> None:
        """Take in that it is so now; times rise."""
        if self._spans and t_ns - self._spans[-1][1] <= self._bridged_ns:
            self._spans[-1] = self._spans[-1][0], t_ns
            return
        self._spans.append((t_ns, t_ns))
        while len(self._spans) > MOST_SPANS:
            self._bridged_ns *= 2
            self._join()

    def _join(self) -> None:
        joined = self._spans[:1]
        for begin, end in self._spans[1:]:
            if begin - joined[-1][1] <= self._bridged_ns:
                joined[-1] = joined[-1][0], end
            else:
                joined.append((begin, end))
        self._spans = joined

    def as_json(self) -> list[tuple[float, float]]:
        """Return them in seconds."""
        return [
            (round(begin / SECOND_NS, 2), round(end / SECOND_NS, 2)) for begin, end in self._spans
        ]


class _Lane:
    """One camera over time, by the times of its pictures."""

    def __init__(self, info: CameraInfo) -> None:
        self.info = info
        self.truths: dict[int, CameraTruth] = {}
        self.spans = {name: Spans() for name in ("in_view", "found", "confirmed", "false")}

    def truth(self, truth: CameraTruth) -> None:
        self.truths[truth.seq] = truth
        if len(self.truths) > MOST_PICTURES_BEHIND:
            del self.truths[next(iter(self.truths))]
        if any(must_be_found(sighting) for sighting in truth.sightings):
            self.spans["in_view"].add(truth.t_frame_ns)

    def look(self, seen: Detections) -> None:
        truth = self.truths.get(seen.seq)
        if truth is None:
            return
        for detection, sighting in zip(
            seen.detections, matches(truth.sightings, seen.detections), strict=True
        ):
            if sighting is not None:
                self.spans["found"].add(truth.t_frame_ns)
            if detection.is_confirmed:
                self.spans["false" if sighting is None else "confirmed"].add(truth.t_frame_ns)


class CameraSection:
    """Takes in what a log says of cameras.

    Parameters
    ----------
    folder
        Of the run.
    page
        From which files are linked to that have no room in it.

    Attributes
    ----------
    cause
        Why vision was lost or not evaluated.
    linked
        How many pictures had no room, and are linked to.
    """

    def __init__(self, folder: RunFolder, page: Path) -> None:
        self.cause = ""
        self.linked = 0
        self._folder = folder
        self._page = page
        self._room = MOST_CHARACTERS
        self._names = _pictures(folder.pictures_path)
        self._lanes: dict[str, _Lane] = {}
        self._state = "off"
        wanted = {(name.camera, name.seq) for name in self._names}
        self._frames: dict[tuple[str, int], CameraFrame | None] = dict.fromkeys(wanted)
        self._truths: dict[tuple[str, int], CameraTruth] = {}
        self._seen: dict[tuple[str, int], Detections] = {}

    def takes(self, key: str) -> bool:
        """Return whether messages of a key are for the gallery alone."""
        return key.startswith(("camera/", "vision/", "truth/camera/"))

    def take(self, logged: Logged) -> None:
        """Take in a message of such a key."""
        match logged.key.split("/"):
            case ["camera", name, "info"]:
                self._lanes[name] = _Lane(CameraInfo.model_validate_json(logged.data))
            case ["camera", _, "frame"] if None in self._frames.values():
                frame = CameraFrame.model_validate_json(logged.data)
                if (frame.camera, frame.seq) in self._frames:
                    self._frames[frame.camera, frame.seq] = frame
            case ["truth", "camera", name] if name in self._lanes:
                truth = CameraTruth.model_validate_json(logged.data)
                self._lanes[name].truth(truth)
                if (name, truth.seq) in self._frames:
                    self._truths[name, truth.seq] = truth
            case ["vision", name] if name in self._lanes:
                seen = Detections.model_validate_json(logged.data)
                if seen.missed:
                    return
                self._lanes[name].look(seen)
                if (name, seen.seq) in self._frames:
                    self._seen[name, seen.seq] = seen

    def status(self, status: Status) -> None:
        """Take in how vision is."""
        self._state, self.cause = status.state, status.cause

    def as_json(self) -> Json:
        """Return what the page shows, with as many of the pictures as there is room for."""
        shown = [self._picture(name) for name in self._names]
        return {
            "state": self._state,
            "lanes": [self._lane(lane) for lane in self._lanes.values()],
            "pictures": [picture for picture in shown if picture is not None],
        }

    def _lane(self, lane: _Lane) -> Json:
        info = lane.info
        video = self._folder.video_path / f"{info.camera}.mp4"
        return {
            "camera": info.camera,
            "carrier": info.carrier,
            "width_px": info.width_px,
            "height_px": info.height_px,
            "rate_hz": info.rate_hz,
            "horizontal_fov_deg": info.horizontal_fov_deg,
            "video": self._link(video) if video.is_file() else None,
            **{name: spans.as_json() for name, spans in lane.spans.items()},
        }

    def _picture(self, name: PictureName) -> Json | None:
        """Return one picture with what was seen in it and what is true of it."""
        place = name.camera, name.seq
        frame = self._frames[place]
        source = self._source(name.path(self._folder.pictures_path))
        if frame is None or source is None:
            return None
        truth, seen = self._truths.get(place), self._seen.get(place)
        sightings = () if truth is None else truth.sightings
        detections = () if seen is None else seen.detections
        matched = matches(sightings, detections)
        found = [sighting.actor for sighting in matched if sighting is not None]
        return {
            "occasion": name.occasion,
            "camera": name.camera,
            "t": frame.t_frame_ns / SECOND_NS,
            "width": frame.view.width_px,
            "height": frame.view.height_px,
            "latency_s": None if seen is None else (seen.t_ns - frame.t_frame_ns) / SECOND_NS,
            "detections": [
                {
                    "label": detection.label,
                    "confidence": detection.confidence,
                    "box": _rounded(detection.box),
                    "confirmed": detection.is_confirmed,
                    "actor": None if sighting is None else sighting.actor,
                    "range_m": None if sighting is None else round(sighting.range_m, 1),
                    "size_px": round(size_px(detection.box), 1),
                }
                for detection, sighting in list(zip(detections, matched, strict=True))[:MOST_BOXES]
            ],
            "truth": [_truth(one, one.actor in found) for one in sightings if one.pixels > 0.0][
                :MOST_BOXES
            ],
            **source,
        }

    def _source(self, path: Path) -> Json | None:
        try:
            data = path.read_bytes()
        except OSError:
            return None
        if 4 * -(-len(data) // 3) > self._room:
            self.linked += 1
            return {"href": self._link(path)}
        source = f"data:{MEDIA[path.suffix]};base64,{base64.b64encode(data).decode()}"
        self._room -= len(source)
        return {"src": source}

    def _link(self, path: Path) -> str:
        return quote(os.path.relpath(path, self._page.parent).replace(os.sep, "/"))


def _pictures(folder: Path) -> list[PictureName]:
    """Return what is in a folder of pictures; those of the start come last."""
    found = [name for path in sorted(folder.glob("*")) if (name := PictureName.of(path))]
    order = (*OCCASIONS[1:], OCCASIONS[0])
    return sorted(found, key=lambda name: order.index(name.occasion))


def _truth(sighting: SightingTruth, found: bool) -> Json:
    return {
        "actor": sighting.actor,
        "label": sighting.label,
        "box": _rounded(sighting.box),
        "range_m": round(sighting.range_m, 1),
        "size_px": round(size_px(sighting.box), 1),
        "found": found,
        "counts": must_be_found(sighting),
    }


def _rounded(box: tuple[float, float, float, float]) -> list[float]:
    return [round(side, 1) for side in box]
