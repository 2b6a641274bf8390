"""What cameras have been showing: each thing that one of them follows, and how sure that is."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from airhilt.assistant.decision.line_of_sight import Eye, Ray
from airhilt.assistant.decision.traffic import Traffic
from airhilt.messages import AdsbReport, Box, Briefing, Detection, Detections, VisibleClass
from airhilt.units import FOOT, SECOND_NS

TAU_VIS = 0.7
"""Of the AIRHILT paper's ladder: what is believed less is not there (arXiv 2511.18718)."""
PERSISTENCE_NS = SECOND_NS
"""What one camera alone shows must have been there for so long."""
LOOK_NS = SECOND_NS // 2
"""Pictures that are nearer to each other in time are one look: their errors are alike."""
LOOKS = 6
"""Remembered of each thing."""
GLIMPSES_NS = 5 * SECOND_NS
"""For so long it is remembered where and how large it was."""
BLIND_NS = 10 * SECOND_NS
"""A camera that gives nothing more clears nothing: what it showed last is kept for so long."""
EXPLAINED_NS = 3 * SECOND_NS
"""Who was once found to be known by ADS-B is for so long."""
DOUBT = 0.05
"""What is believed less is forgotten."""
MOVED_SIZES = 0.5
MOVED_PX = 4.0
"""Who is so far from where he was first, in sizes of his box and pixels, has moved."""
UNTRACKED_SHIFT = 1.5
"""From picture to picture, in sizes of its box, what has no track id moves no farther."""
UNTRACKED_SHIFT_PX = 6.0


class Observation(NamedTuple):
    """A thing in one picture.

    Attributes
    ----------
    ray
        Towards its middle.
    size_rad
        Width and height.
    is_whole
        Whether all of it is in the picture.
    """

    t_ns: int
    eye: Eye
    box: Box
    confidence: float
    ray: Ray
    size_rad: tuple[float, float]
    is_whole: bool

    @classmethod
    def of(cls, t_ns: int, eye: Eye, box: Box, confidence: float) -> Observation:
        """Return what a box in a picture shows."""
        is_whole = not eye.touches_edge(box)
        return cls(t_ns, eye, box, confidence, eye.middle(box), eye.angular_size(box), is_whole)


@dataclass(slots=True)
class _Look:
    """Some pictures of which one may have shown a thing, and with what confidence."""

    begun_ns: int
    confidence: float = 0.0
    pictures: int = 0

    @property
    def mean(self) -> float:
        return self.confidence / self.pictures


@dataclass(slots=True, eq=False)
class VisualTrack:
    """Something that one camera follows.

    Attributes
    ----------
    explained_by
        Callsign of who it is, by ADS-B.
    has_moved
        Whether it has, or the camera does.
    """

    camera: str
    first_ns: int
    observations: deque[Observation] = field(default_factory=deque)
    explained_by: str | None = None
    has_moved: bool = False
    _first_box: Box | None = None
    _explained_ns: int = 0
    _looks: deque[_Look] = field(default_factory=lambda: deque(maxlen=LOOKS + 1))
    _votes: dict[VisibleClass, float] = field(default_factory=dict)

    @property
    def last(self) -> Observation:
        """Where it was seen last."""
        return self.observations[-1]

    @property
    def label(self) -> VisibleClass:
        """What it has mostly been taken for."""
        return max(self._votes, key=lambda label: self._votes[label])

    @property
    def carrier(self) -> str | None:
        """Callsign of the aircraft that the camera is on; None on the ground."""
        return self.last.eye.view.carrier

    @property
    def belief(self) -> float:
        """How sure it is that it is there: one look alone may err, all of them hardly.

        But pictures of what never moves are alike, and so are their errors: a sign that is taken
        for a truck once always is. It is as sure as one look. A look counts once it is over.
        """
        means = [look.mean for look in list(self._looks)[:-1]]
        if self.has_moved or not means:
            return 1.0 - math.prod(1.0 - mean for mean in means)
        return sum(means) / len(means)

    @property
    def is_doubtful(self) -> bool:
        """Whether it has hardly been found for a while."""
        return len(self._looks) > 1 and self.belief < DOUBT

    @property
    def age_ns(self) -> int:
        """Between the first and the last picture that showed it."""
        return self.last.t_ns - self.first_ns

    def take(self, observation: Observation, label: VisibleClass, explained_by: str | None) -> None:
        """Take in that a picture shows it."""
        self._first_box = self._first_box or observation.box
        moved = _shift(self._first_box, observation.box, MOVED_SIZES, MOVED_PX) > 1.0
        self.has_moved = self.has_moved or moved or observation.eye.view.carrier is not None
        self.observations.append(observation)
        while observation.t_ns - self.observations[0].t_ns > GLIMPSES_NS:
            self.observations.popleft()
        self._votes[label] = self._votes.get(label, 0.0) + observation.confidence
        self._look(observation.t_ns, observation.confidence)
        if explained_by is not None:
            self.explained_by, self._explained_ns = explained_by, observation.t_ns
        elif observation.t_ns - self._explained_ns > EXPLAINED_NS:
            self.explained_by = None

    def miss(self, t_ns: int) -> None:
        """Take in that a picture does not show it."""
        self._look(t_ns, 0.0)

    def _look(self, t_ns: int, confidence: float) -> None:
        if not self._looks or t_ns - self._looks[-1].begun_ns >= LOOK_NS:
            self._looks.append(_Look(t_ns))
        self._looks[-1].confidence += confidence
        self._looks[-1].pictures += 1


def is_established(sightings: Iterable[VisualTrack]) -> bool:
    """Return whether something is there: cameras agree, or one of them persists."""
    together = list(sightings)
    if belief_in(together) < TAU_VIS:
        return False
    return len(together) > 1 or together[0].age_ns >= PERSISTENCE_NS


def belief_in(sightings: Iterable[VisualTrack]) -> float:
    """Return how sure it is that something is there which one or more cameras show."""
    return 1.0 - math.prod(1.0 - sighting.belief for sighting in sightings)


class VisualTracks:
    """Keeps what cameras have shown, and tells apart what is known by ADS-B."""

    def __init__(self) -> None:
        self.traffic = Traffic()
        self._sightings: dict[str, dict[int, VisualTrack]] = {}
        """By camera, and by the detector's track."""
        self._unnumbered = -1

    def __iter__(self) -> Iterator[VisualTrack]:
        for followed in self._sightings.values():
            yield from followed.values()

    def take_briefing(self, briefing: Briefing) -> None:
        """Take in how high the airport lies."""
        if briefing.airport is not None:
            self.traffic.ground_m = briefing.airport.elevation_ft * FOOT

    def take_report(self, report: AdsbReport) -> None:
        """Take in where somebody is."""
        self.traffic.take_report(report)

    def take_detections(self, detections: Detections) -> None:
        """Take in what was found in a picture; one that was missed tells nothing."""
        if detections.missed:
            return
        t_ns, eye = detections.t_frame_ns, Eye(detections.view)
        self.traffic.learn_ground(detections.view, t_ns)
        followed = self._sightings.setdefault(detections.camera, {})
        found: dict[int, VisualTrack] = {}
        for detection in detections.detections:
            number = self._number(detection, followed, found)
            sighting = followed.get(number) or VisualTrack(detections.camera, t_ns)
            explained_by = self.traffic.explaining(eye, detection.box, t_ns)
            observation = Observation.of(t_ns, eye, detection.box, detection.confidence)
            sighting.take(observation, detection.label, explained_by)
            found[number] = sighting
        for number, sighting in followed.items():
            if number not in found:
                sighting.miss(t_ns)
                if not sighting.is_doubtful:
                    found[number] = sighting
        self._sightings[detections.camera] = found

    def _number(
        self, detection: Detection, followed: dict[int, VisualTrack], found: dict[int, VisualTrack]
    ) -> int:
        """Return the track of a detection; a detector that gives none is followed simply."""
        if detection.track_id is not None:
            return detection.track_id
        near = [
            (shift, number)
            for number, sighting in followed.items()
            if number not in found and (shift := _step(sighting.last.box, detection.box)) <= 1.0
        ]
        if near:
            return min(near)[1]
        self._unnumbered -= 1
        return self._unnumbered

    def forget(self, t_ns: int) -> None:
        """Forget what was seen long ago."""
        self.traffic.forget(t_ns)
        for followed in self._sightings.values():
            for number, sighting in list(followed.items()):
                if t_ns - sighting.last.t_ns > BLIND_NS:
                    del followed[number]


def _step(before: Box, now: Box) -> float:
    return _shift(before, now, UNTRACKED_SHIFT, UNTRACKED_SHIFT_PX)


def _shift(before: Box, now: Box, sizes: float, pixels: float) -> float:
    """Return how far a box has moved, in units of some of its sizes and pixels."""
    x = (now[0] + now[2] - before[0] - before[2]) / 2.0
    y = (now[1] + now[3] - before[1] - before[3]) / 2.0
    size_px = max(before[2] - before[0], before[3] - before[1])
    return math.hypot(x, y) / (sizes * size_px + pixels)
