"""Scores of the detections of each camera against the truth, as `airhilt.imaging.matching` says."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace

from airhilt.imaging.boxes import size_px
from airhilt.imaging.matching import matches
from airhilt.messages import (
    EXPOSURE_LEFT_OUT,
    CameraFrame,
    CameraInfo,
    CameraTruth,
    Detection,
    Detections,
    Message,
    ModalityState,
    SightingTruth,
    Status,
)
from airhilt.metrics.summary import (
    CameraStatistics,
    DetectionStatistics,
    FirstDetection,
    LatencyStatistics,
    SizeRecall,
    VisionStatistics,
)
from airhilt.units import SECOND_NS

LEAST_PX = 8.0
"""Actors whose longest side is below this, in px, need not be found."""
LEAST_VISIBLE = 0.5
"""Actors of which a smaller fraction is visible need not be found."""
LEAST_TRANSMISSION = 0.1
"""Actors need not be found if the air leaves a smaller fraction of their contrast."""
SIZES_PX = (LEAST_PX, 12.0, 20.0, 50.0)
"""Lower limits of the bins of recall, in px."""
MOST_PICTURES_BEHIND = 600
"""Number of pictures whose truth is kept for late detections: 20 s at 30 Hz."""


def must_be_found(sighting: SightingTruth) -> bool:
    """Return true if an actor is so large and clear in a picture that it counts as a sighting."""
    return (
        size_px(sighting.box) >= LEAST_PX
        and sighting.visible_fraction >= LEAST_VISIBLE
        and sighting.transmission >= LEAST_TRANSMISSION
    )


@dataclass
class _Counts:
    taken: int = 0
    taken_s: float = 0.0
    left_out: int = 0
    latencies_s: list[float] = field(default_factory=list)
    missed: int = 0
    detections: int = 0
    found: int = 0
    """Detections that match an actor."""
    labelled: int = 0
    """Detections that match an actor and have its class."""
    false: int = 0
    false_confirmed: int = 0
    false_tracks: int = 0
    sightings: Counter[float] = field(default_factory=Counter)
    """Number of sightings by the lower limit of their bin."""
    recalled: Counter[float] = field(default_factory=Counter)

    def add(self, other: _Counts) -> None:
        """Add the counts of another."""
        for each in fields(self):
            setattr(self, each.name, getattr(self, each.name) + getattr(other, each.name))

    def statistics(self, dropped: int, is_watched: bool) -> DetectionStatistics:
        """Return the statistics; without a detector only the number of pictures is known."""
        if not is_watched:
            return DetectionStatistics(
                taken=self.taken or None,
                exposures_left_out=self.left_out if self.taken else None,
                latency=LatencyStatistics.of([]),
                by_size=[],
            )
        minutes = 0.0 if self.left_out else self.taken_s / 60.0
        looked_at = len(self.latencies_s)
        return DetectionStatistics(
            taken=self.taken,
            exposures_left_out=self.left_out,
            looked_at=looked_at,
            dropped=dropped,
            missed=self.missed,
            latency=LatencyStatistics.of(self.latencies_s),
            detections=self.detections,
            sightings=self.sightings.total(),
            recall=_ratio(self.recalled.total(), self.sightings.total()),
            by_size=[
                SizeRecall(
                    from_px=low,
                    to_px=high,
                    sightings=self.sightings[low],
                    recall=_ratio(self.recalled[low], self.sightings[low]),
                )
                for low, high in zip(SIZES_PX, (*SIZES_PX[1:], None), strict=True)
            ],
            labels_right=_ratio(self.labelled, self.found),
            false_detections=self.false,
            false_per_picture=_ratio(self.false, looked_at),
            false_per_minute=_ratio(self.false, minutes),
            false_confirmed_per_minute=_ratio(self.false_confirmed, minutes),
            false_tracks=self.false_tracks,
        )


def _ratio(part: float, whole: float) -> float | None:
    return part / whole if whole else None


class _Camera:
    def __init__(self, rate_hz: float) -> None:
        self._counts = _Counts()
        self._period_s = 1.0 / rate_hz
        self._truths: dict[int, CameraTruth] = {}
        self._confirmed: dict[int, bool] = {}
        """Tracks that were confirmed, and True for those that ever matched an actor."""

    def counts(self) -> _Counts:
        """Return the counts up to now."""
        false_tracks = sum(not is_real for is_real in self._confirmed.values())
        return replace(self._counts, false_tracks=false_tracks)

    def picture(self, *, is_left_out: bool) -> None:
        self._counts.left_out += is_left_out
        self._counts.taken += not is_left_out
        self._counts.taken_s += 0.0 if is_left_out else self._period_s

    def keep(self, truth: CameraTruth) -> None:
        self._truths[truth.seq] = truth
        if len(self._truths) > MOST_PICTURES_BEHIND:
            del self._truths[next(iter(self._truths))]

    def look(self, seen: Detections) -> list[FirstDetection]:
        """Count the detections in a picture, and return the actors that were found in it."""
        truth = self._truths.get(seen.seq)
        if truth is None:
            return []
        if seen.missed:
            self._counts.missed += 1
            return []
        matched = matches(truth.sightings, seen.detections)
        self._counts.latencies_s.append((seen.t_ns - truth.t_frame_ns) / SECOND_NS)
        self._counts.detections += len(matched)
        for detection, sighting in zip(seen.detections, matched, strict=True):
            self._judge(detection, sighting)
        found = [sighting for sighting in matched if sighting is not None]
        recalled = {sighting.actor for sighting in found}
        for sighting in filter(must_be_found, truth.sightings):
            least_px = max(least for least in SIZES_PX if size_px(sighting.box) >= least)
            self._counts.sightings[least_px] += 1
            self._counts.recalled[least_px] += sighting.actor in recalled
        return [
            FirstDetection(
                actor=sighting.actor,
                t_s=seen.t_ns / SECOND_NS,
                t_frame_s=truth.t_frame_ns / SECOND_NS,
                camera=seen.camera,
                range_m=sighting.range_m,
                size_px=size_px(sighting.box),
            )
            for sighting in found
        ]

    def _judge(self, detection: Detection, sighting: SightingTruth | None) -> None:
        if sighting is None:
            self._counts.false += 1
            self._counts.false_confirmed += detection.is_confirmed
        else:
            self._counts.found += 1
            self._counts.labelled += detection.label == sighting.label
        if detection.track_id is not None and detection.is_confirmed:
            known = self._confirmed.get(detection.track_id, False)
            self._confirmed[detection.track_id] = known or sighting is not None


class DetectionScores:
    """Scores the detections of all cameras of a run."""

    def __init__(self) -> None:
        self._cameras: dict[str, _Camera] = {}
        self._first: dict[str, FirstDetection] = {}
        self._last_ns: dict[str, int] = {}
        """Time of the last detection of each actor."""
        self._state: ModalityState = "off"
        self._cause = ""
        self._why_missed = ""

    def take(self, message: Message) -> None:
        """Add a message about cameras or vision; other messages are ignored."""
        match message:
            case CameraInfo(camera=name, rate_hz=rate_hz):
                self._cameras[name] = _Camera(rate_hz)
            case CameraTruth(camera=name) if name in self._cameras:
                self._cameras[name].keep(message)
            case CameraFrame(camera=name, encoding=encoding) if name in self._cameras:
                self._cameras[name].picture(is_left_out=encoding == "none")
            case Detections(camera=name, missed=missed) if name in self._cameras:
                if missed != EXPOSURE_LEFT_OUT:
                    self._look(message)
            case Status(modality="vision", state=state, cause=cause):
                self._state, self._cause = state, cause

    def _look(self, seen: Detections) -> None:
        self._why_missed = self._why_missed or seen.missed
        for first in self._cameras[seen.camera].look(seen):
            self._first.setdefault(first.actor, first)
            self._last_ns[first.actor] = seen.t_ns

    def was_seen(self, actor: str, since_ns: int) -> bool:
        """Return true if a detection since a time really showed an actor."""
        return self._last_ns.get(actor, since_ns - 1) >= since_ns

    # --- statistics -------------------------------------------------------------------------

    def statistics(self, inputs_dropped: Mapping[str, int]) -> VisionStatistics:
        """Return the statistics of vision.

        `inputs_dropped` has the number of dropped inputs by worker and key.
        """
        counted = {name: camera.counts() for name, camera in self._cameras.items()}
        every = _Counts()
        for one in counted.values():
            every.add(one)
        is_watched = self._state == "on" or bool(every.latencies_s)
        dropped = {name: _dropped(name, inputs_dropped) for name in self._cameras}
        return VisionStatistics(
            **every.statistics(sum(dropped.values()), is_watched).model_dump(),
            state=self._state,
            cause=self._cause,
            why_missed=self._why_missed,
            cameras=[
                CameraStatistics(
                    **counted[name].statistics(dropped[name], is_watched).model_dump(), camera=name
                )
                for name in self._cameras
            ],
            first_detections=sorted(self._first.values(), key=lambda first: first.t_s),
        )


def _dropped(camera: str, inputs_dropped: Mapping[str, int]) -> int:
    """Return the number of a camera's pictures dropped by the worker that dropped most."""
    ending = f": camera/{camera}/frame"
    return max((n for name, n in inputs_dropped.items() if name.endswith(ending)), default=0)
