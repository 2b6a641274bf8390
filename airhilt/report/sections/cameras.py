"""The cameras: key pictures with boxes, and when actors were in view and found."""

from __future__ import annotations

import base64
import os
from pathlib import Path
from typing import Any

from airhilt.host.files import open_inside
from airhilt.host.text import readable
from airhilt.imaging.boxes import size_px
from airhilt.imaging.matching import matches
from airhilt.messages import CameraFrame, CameraInfo, CameraTruth, Detections, Status
from airhilt.metrics.detection_scores import MOST_PICTURES_BEHIND, must_be_found
from airhilt.record import Logged, RunFolder
from airhilt.record.pictures import OCCASIONS, PictureName
from airhilt.record.run import result_problem
from airhilt.report.data import RunData
from airhilt.report.intervals import BridgedIntervals
from airhilt.report.sections import Content, Section
from airhilt.units import SECOND_NS

Json = dict[str, Any]

MOST_CHARACTERS = 4_000_000
"""Greatest length of all pictures in a page."""
MOST_BOXES = 60
"""Largest number of detections in one picture, and of true boxes."""
MOST_NAMED = 5
"""Number of damaged pictures that are named; the others are counted."""
OF_CAMERA = ("camera", "carrier", "width_px", "height_px", "rate_hz", "horizontal_fov_deg")
"""Fields of `CameraInfo` in the page."""
MEDIA_TYPES = {".png": "image/png", ".jpg": "image/jpeg"}


class CameraTimeline:
    """Intervals in which one camera had actors in view, and found them, at its pictures' times."""

    def __init__(self, info: CameraInfo) -> None:
        self.info = info
        self._truths: dict[int, CameraTruth] = {}
        self._intervals = {
            name: BridgedIntervals() for name in ("in_view", "found", "confirmed", "false")
        }

    def add_truth(self, truth: CameraTruth) -> None:
        """Add what was true of the next picture."""
        self._truths[truth.seq] = truth
        if len(self._truths) > MOST_PICTURES_BEHIND:
            del self._truths[next(iter(self._truths))]
        if any(must_be_found(sighting) for sighting in truth.sightings):
            self._intervals["in_view"].add(truth.t_frame_ns)

    def add_detections(self, seen: Detections) -> None:
        """Add what a detector found in a picture."""
        truth = self._truths.get(seen.seq)
        if truth is None:
            return
        for detection, sighting in zip(
            seen.detections, matches(truth.sightings, seen.detections), strict=True
        ):
            if sighting is not None:
                self._intervals["found"].add(truth.t_frame_ns)
            if detection.is_confirmed:
                kind = "false" if sighting is None else "confirmed"
                self._intervals[kind].add(truth.t_frame_ns)

    def as_json(self, run: RunData) -> Json:
        """Return the camera and its intervals."""
        info = self.info
        return {
            **{name: getattr(info, name) for name in OF_CAMERA},
            "video": _video(run, info.camera),
            **{name: intervals.as_json() for name, intervals in self._intervals.items()},
        }


class Cameras(Content):
    """The cameras of a run, and its key pictures."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._state, self._cause = "off", ""
        self._names = _pictures(folder.pictures_path)
        self._timelines: dict[str, CameraTimeline] = {}
        wanted = {(name.camera, name.seq) for name in self._names}
        self._frames: dict[tuple[str, int], CameraFrame | None] = dict.fromkeys(wanted)
        self._truths: dict[tuple[str, int], CameraTruth] = {}
        self._seen: dict[tuple[str, int], Detections] = {}

    def take(self, logged: Logged) -> None:
        """Receive a message about cameras, what is true of their pictures, or vision."""
        match logged.key.split("/"):
            case ["status", "vision"]:
                status = Status.model_validate_json(logged.data)
                self._state, self._cause = status.state, status.cause
            case ["camera", name, "info"]:
                self._timelines[name] = CameraTimeline(CameraInfo.model_validate_json(logged.data))
            case ["camera", _, "frame"] if None in self._frames.values():
                frame = CameraFrame.model_validate_json(logged.data)
                if (frame.camera, frame.seq) in self._frames:
                    self._frames[frame.camera, frame.seq] = frame
            case ["truth", "camera", name] if name in self._timelines:
                truth = CameraTruth.model_validate_json(logged.data)
                self._timelines[name].add_truth(truth)
                if (name, truth.seq) in self._frames:
                    self._truths[name, truth.seq] = truth
            case ["vision", name] if name in self._timelines:
                seen = Detections.model_validate_json(logged.data)
                if seen.missed:
                    return
                self._timelines[name].add_detections(seen)
                if (name, seen.seq) in self._frames:
                    self._seen[name, seen.seq] = seen

    def as_json(self, run: RunData) -> Json:
        """Return cameras and pictures, the latter as far as there is room."""
        sources = PictureSources(run)
        shown = [self._picture(name, sources) for name in self._names]
        if sources.linked:
            run.notes.append(
                f"There was no room in this file for {sources.linked} pictures: they are links "
                "to the pictures folder of the run."
            )
        for problem in sources.refused[:MOST_NAMED]:
            run.notes.append(f"Damaged: {readable(problem)}. It is not shown.")
        if len(sources.refused) > MOST_NAMED:
            run.notes.append(f"Damaged: {len(sources.refused) - MOST_NAMED} more pictures.")
        return {
            "state": self._state,
            "timelines": [timeline.as_json(run) for timeline in self._timelines.values()],
            "pictures": [picture for picture in shown if picture is not None],
            "cause": readable(self._cause),
        }

    def _picture(self, name: PictureName, sources: PictureSources) -> Json | None:
        place = name.camera, name.seq
        frame = self._frames[place]
        source = sources.of(name)
        if frame is None or source is None:
            return None
        truth, seen = self._truths.get(place), self._seen.get(place)
        return {
            "occasion": name.occasion,
            "camera": name.camera,
            "t": frame.t_frame_ns / SECOND_NS,
            "width": frame.view.width_px,
            "height": frame.view.height_px,
            "latency_s": None if seen is None else (seen.t_ns - frame.t_frame_ns) / SECOND_NS,
            **_boxes(truth, seen),
            **source,
        }


def _video(run: RunData, camera: str) -> str | None:
    path = run.folder.video_path / f"{camera}.mp4"
    try:
        with open_inside(run.folder.path, path):
            problem = result_problem(run.folder, run.info, path)
    except FileNotFoundError:
        return None
    except OSError as error:
        problem = f"video of camera {camera}: {error.strerror}"
    if problem:
        run.notes.append(f"Damaged: {readable(problem)}. It is not linked.")
        return None
    return run.link(path)


class PictureSources:
    """Puts pictures into the page, or links to them once there is no room.

    `linked` counts the links; `refused` has a line for each picture that the run did not write so.
    """

    def __init__(self, run: RunData) -> None:
        self.linked = 0
        self.refused: list[str] = []
        self._run = run
        self._room = MOST_CHARACTERS

    def of(self, name: PictureName) -> Json | None:
        """Return ``src`` of a picture or ``href`` of its file, None if the run did not write it."""
        folder = self._run.folder
        path = name.path(folder.pictures_path)
        try:
            with open_inside(folder.path, path) as stream:
                problem = result_problem(folder, self._run.info, path)
                size_bytes = os.fstat(stream.fileno()).st_size
                has_room = 4 * -(-size_bytes // 3) <= self._room
                data = stream.read() if has_room and not problem else b""
        except OSError as error:
            problem = f"{path.name}: {error.strerror}"
        if problem:
            self.refused.append(problem)
            return None
        if not has_room:
            self.linked += 1
            return {"href": self._run.link(path)}
        source = f"data:{MEDIA_TYPES[path.suffix]};base64,{base64.b64encode(data).decode()}"
        self._room -= len(source)
        return {"src": source}


def _pictures(folder: Path) -> list[PictureName]:
    found = [name for path in sorted(folder.glob("*")) if (name := PictureName.of(path))]
    order = (*OCCASIONS[1:], OCCASIONS[0])
    return sorted(found, key=lambda name: order.index(name.occasion))


def _boxes(truth: CameraTruth | None, seen: Detections | None) -> Json:
    sightings = () if truth is None else truth.sightings
    detections = () if seen is None else seen.detections
    matched = matches(sightings, detections)
    found = [sighting.actor for sighting in matched if sighting is not None]
    visible = [one for one in sightings if one.pixels > 0.0]
    return {
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
        "truth": [
            {
                "actor": sighting.actor,
                "label": sighting.label,
                "box": _rounded(sighting.box),
                "range_m": round(sighting.range_m, 1),
                "size_px": round(size_px(sighting.box), 1),
                "found": sighting.actor in found,
                "counts": must_be_found(sighting),
            }
            for sighting in visible[:MOST_BOXES]
        ],
    }


def _rounded(box: tuple[float, float, float, float]) -> list[float]:
    return [round(side, 1) for side in box]


SECTION = Section(
    "cameras",
    order=50,
    module=__file__,
    content=Cameras,
    keys=("camera/", "vision/", "truth/camera/", "status/vision"),
)
