"""The things that cameras follow, each with the belief that it is there."""

from __future__ import annotations

import math
from collections import defaultdict, deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from pydantic import Field

from airhilt.assistant.decision.line_of_sight import PictureGeometry, Ray
from airhilt.assistant.decision.traffic import Traffic
from airhilt.configuration import Configuration, Seconds, Share
from airhilt.messages import AdsbReport, Box, Briefing, Detection, Detections, VisibleClass
from airhilt.units import FOOT, SECOND_NS

LOOK_NS = SECOND_NS // 2
"""Length of one look, in ns. The detector's errors in pictures of one look are correlated."""
LOOKS = 6
"""Number of looks that are kept of each thing."""
OBSERVED_NS = 5 * SECOND_NS
"""Time for which observations are kept, in ns."""
BLIND_NS = 10 * SECOND_NS
"""Time for which a thing is kept without new pictures, in ns, so that an outage of a camera does
not clear a runway."""
EXPLAINED_NS = 3 * SECOND_NS
"""Time for which a thing stays known by ADS-B, in ns."""
DOUBT = 0.05
"""Belief below which a thing is forgotten."""
MOVED_SIZES = 0.5
MOVED_PX = 4.0
"""Distance from its first place, in sizes of its box and pixels, from which a thing has moved."""
UNTRACKED_SHIFT = 1.5
"""Largest movement between pictures of what has no track id, in sizes of its box and pixels."""
UNTRACKED_SHIFT_PX = 6.0


class SightConfig(Configuration):
    """Thresholds for what cameras show."""

    tau_vis: Share = Field(
        0.7, description="least belief with which something is there; arXiv 2511.18718"
    )
    cameras: int = Field(
        2,
        ge=1,
        le=100,
        description="number of cameras that suffice if they show the same thing: K of "
        "arXiv 2511.18718; its value is an assumption",
    )
    persistence_s: Seconds = Field(
        1.0,
        description="time for which fewer cameras must show something, in s; an assumption",
    )


class Observation(NamedTuple):
    """A thing in one picture."""

    t_ns: int
    geometry: PictureGeometry
    box: Box
    confidence: float
    ray: Ray
    """Direction towards its middle."""
    size_rad: tuple[float, float]
    """Width and height."""
    is_whole: bool
    """True if all of it is in the picture."""

    @classmethod
    def of(cls, t_ns: int, geometry: PictureGeometry, box: Box, confidence: float) -> Observation:
        """Return the observation of a box in a picture."""
        ray, size_rad = geometry.middle(box), geometry.angular_size(box)
        return cls(t_ns, geometry, box, confidence, ray, size_rad, not geometry.touches_edge(box))


@dataclass(slots=True)
class _Look:
    """The pictures of half a second, with the sum of the confidences in them."""

    begun_ns: int
    confidence: float = 0.0
    pictures: int = 0


@dataclass(slots=True, eq=False)
class VisualTrack:
    """Something that one camera follows."""

    camera: str
    first_ns: int
    observations: deque[Observation] = field(default_factory=deque)
    explained_by: str | None = None
    """Callsign that it has by ADS-B; None if it is unknown."""
    has_moved: bool = False
    """True if it has moved, or its camera moves."""
    heard_ns: int = 0
    """Time at which the last picture that shows it arrived, however old that was."""
    _first_box: Box | None = None
    _explained_ns: int = 0
    _looks: deque[_Look] = field(default_factory=lambda: deque(maxlen=LOOKS + 1))
    _votes: defaultdict[VisibleClass, float] = field(default_factory=lambda: defaultdict(float))

    @property
    def last(self) -> Observation:
        """The last observation."""
        return self.observations[-1]

    @property
    def label(self) -> VisibleClass:
        """The class that it was mostly taken for, weighted by confidence."""
        return max(self._votes, key=lambda label: self._votes[label])

    @property
    def carrier(self) -> str | None:
        """Callsign of the aircraft that the camera is on; None on the ground."""
        return self.last.geometry.view.carrier

    @property
    def belief(self) -> float:
        """Belief that it is there, from 0 to 1, by the looks that are over.

        Looks at something that moves err independently. Pictures of something that never moves are
        alike, and so are the errors in them: a sign that was taken for a truck once always is. Its
        belief is that of one look.
        """
        if self.has_moved:
            return 1.0 - math.prod(1.0 - mean for mean in self._means())
        return self.belief_of_one_look

    @property
    def belief_of_one_look(self) -> float:
        """Mean confidence in the looks that are over, from 0 to 1; 0 in a picture without it."""
        means = self._means()
        return sum(means) / len(means) if means else 0.0

    def _means(self) -> list[float]:
        return [look.confidence / look.pictures for look in list(self._looks)[:-1]]

    @property
    def is_doubtful(self) -> bool:
        """True if the belief has fallen so low that it is forgotten."""
        return len(self._looks) > 1 and self.belief < DOUBT

    def take(self, observation: Observation, label: VisibleClass, explained_by: str | None) -> None:
        """Update with a picture that shows it."""
        self._first_box = self._first_box or observation.box
        moved = _shift(self._first_box, observation.box, MOVED_SIZES, MOVED_PX) > 1.0
        self.has_moved = self.has_moved or moved or observation.geometry.view.carrier is not None
        self.observations.append(observation)
        while observation.t_ns - self.observations[0].t_ns > OBSERVED_NS:
            self.observations.popleft()
        self._votes[label] += observation.confidence
        self.look(observation.t_ns, observation.confidence)
        if explained_by is not None:
            self.explained_by, self._explained_ns = explained_by, observation.t_ns
        elif observation.t_ns - self._explained_ns > EXPLAINED_NS:
            self.explained_by = None

    def look(self, t_ns: int, confidence: float = 0.0) -> None:
        """Update its looks with a picture that shows it with a confidence; 0: it does not."""
        if not self._looks or t_ns - self._looks[-1].begun_ns >= LOOK_NS:
            self._looks.append(_Look(t_ns))
        self._looks[-1].confidence += confidence
        self._looks[-1].pictures += 1


def belief_in(tracks: Iterable[VisualTrack]) -> float:
    """Return the belief that something is there which one or more cameras show."""
    return 1.0 - math.prod(1.0 - track.belief for track in tracks)


class VisualTracks:
    """All visual tracks of all cameras; those known by ADS-B are marked."""

    def __init__(self, config: SightConfig | None = None) -> None:
        self.config = config or SightConfig()
        self.traffic = Traffic()
        self._tracks: dict[str, dict[int, VisualTrack]] = {}
        """Tracks by camera and by the detector's number."""
        self._unnumbered = -1

    def __iter__(self) -> Iterator[VisualTrack]:
        for followed in self._tracks.values():
            yield from followed.values()

    def shows(self, tracks: Iterable[VisualTrack]) -> bool:
        """Return whether something is there: enough cameras agree, or it was shown long enough."""
        together = list(tracks)
        if not together or belief_in(together) < self.config.tau_vis:
            return False
        if len({track.camera for track in together}) >= self.config.cameras:
            return True
        longest_ns = max(track.last.t_ns - track.first_ns for track in together)
        return longest_ns >= self.config.persistence_s * SECOND_NS

    def take_briefing(self, briefing: Briefing) -> None:
        """Set the elevation of the airport."""
        if briefing.airport is not None:
            self.traffic.ground_m = briefing.airport.elevation_ft * FOOT

    def take_report(self, report: AdsbReport, t_ns: int) -> None:
        """Update the position of an aircraft or a vehicle at a time."""
        self.traffic.take_report(report, t_ns)

    def take_detections(self, detections: Detections, now_ns: int) -> None:
        """Update the tracks of a camera with one picture, which arrived at a time.

        A missed picture changes nothing.
        """
        if detections.missed:
            return
        t_ns, geometry = detections.t_frame_ns, PictureGeometry(detections.view)
        self.traffic.learn_ground(detections.view, t_ns)
        followed = self._tracks.setdefault(detections.camera, {})
        found: dict[int, VisualTrack] = {}
        for detection in detections.detections:
            number = self._number(detection, followed, found)
            track = followed.get(number) or VisualTrack(detections.camera, t_ns)
            explained_by = self.traffic.explaining(geometry, detection.box, t_ns)
            observation = Observation.of(t_ns, geometry, detection.box, detection.confidence)
            track.take(observation, detection.label, explained_by)
            track.heard_ns = now_ns
            found[number] = track
        for number, track in followed.items():
            if number not in found:
                track.look(t_ns)
                if not track.is_doubtful:
                    found[number] = track
        self._tracks[detections.camera] = found

    def _number(
        self, detection: Detection, followed: dict[int, VisualTrack], found: dict[int, VisualTrack]
    ) -> int:
        """Return the track number of a detection, the nearest track if it has none."""
        if detection.track_id is not None:
            return detection.track_id
        shifts = [
            (_shift(track.last.box, detection.box, UNTRACKED_SHIFT, UNTRACKED_SHIFT_PX), number)
            for number, track in followed.items()
            if number not in found
        ]
        shift, nearest = min(shifts, default=(math.inf, 0))
        if shift <= 1.0:
            return nearest
        self._unnumbered -= 1
        return self._unnumbered

    def forget(self, t_ns: int) -> None:
        """Forget what has not been seen for `BLIND_NS`."""
        self.traffic.forget(t_ns)
        for followed in self._tracks.values():
            for number, track in list(followed.items()):
                if t_ns - track.heard_ns > BLIND_NS:
                    del followed[number]


def _shift(before: Box, now: Box, sizes: float, pixels: float) -> float:
    x = (now[0] + now[2] - before[0] - before[2]) / 2.0
    y = (now[1] + now[3] - before[1] - before[3]) / 2.0
    size_px = max(before[2] - before[0], before[3] - before[1])
    return math.hypot(x, y) / (sizes * size_px + pixels)
