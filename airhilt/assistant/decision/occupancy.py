"""What cameras show on the ground and low over it, by several of them together."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from airhilt.assistant.decision.aerodrome import Aerodrome, Vector
from airhilt.assistant.decision.line_of_sight import Fix, Ray, Sightline, Spot, meeting
from airhilt.assistant.decision.visual_tracks import (
    Observation,
    VisualTrack,
    VisualTracks,
    belief_in,
    is_established,
)
from airhilt.messages import CameraView, VisibleClass
from airhilt.units import SECOND_NS

ANIMALS: frozenset[VisibleClass] = frozenset(("deer", "coyote", "bird"))
MOTION_NS = 2 * SECOND_NS
"""Over which a speed is measured."""
LEAST_MOTION_NS = SECOND_NS
SAME_INSTANT_NS = SECOND_NS // 4
"""Two cameras that were to see one bird in the air saw it at times no farther apart."""
FLOCK_M = 20.0
"""Across a flock, at most."""
SMALLEST_BIRD_M = 0.4
ALOFT_SIGMAS = 2.0
ALOFT_M = 4.0
"""Birds that are higher are in the air."""
STEADY_SIGMAS = 2.0
"""A speed that is less surely one is none."""


class SeenOnGround(NamedTuple):
    """Something on the ground, as one or more cameras show it."""

    label: VisibleClass
    spot: Spot
    belief: float
    is_established: bool
    sighting: VisualTrack
    """The surest."""
    t_ns: int

    @property
    def is_animal(self) -> bool:
        """Whether it is no vehicle and no aircraft."""
        return self.label in ANIMALS


@dataclass(frozen=True, slots=True)
class SeenAloft:
    """Birds in the air, or an aircraft without transponder.

    Attributes
    ----------
    places
        Where it may be; one, if cameras tell the distance.
    """

    are_birds: bool

    places: tuple[Fix, ...]
    velocity: tuple[float, float, float]
    """East, north and up, in m/s; nothing where it is not known."""
    is_located: bool
    t_ns: int
    sightings: tuple[VisualTrack, ...]


def seen_on_ground(
    visual_tracks: VisualTracks, aerodrome: Aerodrome, aloft: Iterable[SeenAloft] = ()
) -> Iterator[SeenOnGround]:
    """Yield what is on the ground and not known by ADS-B, the surest first."""
    flying = {id(sighting) for thing in aloft for sighting in thing.sightings}
    known: list[tuple[VisualTrack, Spot]] = []
    for sighting in visual_tracks:
        if id(sighting) in flying:
            continue
        spot = _spot(sighting.last, aerodrome)
        if sighting.explained_by is None and spot is not None:
            known.append((sighting, spot))
    known.sort(key=lambda pair: -pair[0].belief)
    while known:
        (first, spot), *known = known
        together, rest = [first], []
        for other, place in known:
            is_new = all(other.camera != one.camera for one in together)
            if is_new and _alike(first, other) and spot.is_same(place):
                together.append(other)
                spot = spot.merged(place)
            else:
                rest.append((other, place))
        known = rest
        yield SeenOnGround(
            first.label,
            spot,
            belief_in(together),
            is_established(together),
            first,
            max(sighting.last.t_ns for sighting in together),
        )


def _alike(first: VisualTrack, second: VisualTrack) -> bool:
    return (first.label in ANIMALS) == (second.label in ANIMALS)


def _spot(observation: Observation, aerodrome: Aerodrome) -> Spot | None:
    return _line(observation, aerodrome, observation.eye.foot(observation.box)).on_ground()


def _line(observation: Observation, aerodrome: Aerodrome, ray: Ray) -> Sightline:
    view = observation.eye.view
    return Sightline(_place(view, aerodrome), view.height_m, ray, observation.eye.error_rad)


def _place(view: CameraView, aerodrome: Aerodrome) -> Vector:
    return aerodrome.locate(view.latitude_deg, view.longitude_deg)


def velocity_of(thing: SeenOnGround, aerodrome: Aerodrome) -> Vector:
    """Return how fast something on the ground moves (m/s); nothing unless it surely does."""
    sighting = thing.sighting
    last_ns = sighting.last.t_ns
    places = [
        ((observation.t_ns - last_ns) / SECOND_NS, spot)
        for observation in sighting.observations
        if last_ns - observation.t_ns <= MOTION_NS
        and (spot := _spot(observation, aerodrome)) is not None
    ]
    if len(places) < 3 or -places[0][0] < LEAST_MOTION_NS / SECOND_NS:
        return Vector(0.0, 0.0)
    times = np.array([time_s for time_s, _ in places])
    points = np.array([spot.point for _, spot in places])
    (slope, base), *_ = np.linalg.lstsq(
        np.column_stack((times, np.ones_like(times))), points, rcond=None
    )
    scatter_m = np.std(points - np.outer(times, slope) - base, axis=0)
    error_m_s = scatter_m / (np.std(times) * math.sqrt(len(places)))
    speed = math.hypot(*slope)
    if speed < STEADY_SIGMAS * math.hypot(*error_m_s):
        return Vector(0.0, 0.0)
    return Vector(float(slope[0]), float(slope[1]))


# --- in the air -----------------------------------------------------------------------------


def seen_aloft(visual_tracks: VisualTracks, aerodrome: Aerodrome) -> Iterator[SeenAloft]:
    """Yield what two cameras see in the air, and birds that one sees above its horizon.

    Far away, birds and aircraft are easily taken for each other.
    """
    flying = [
        s for s in visual_tracks if s.label in ("bird", "airplane") and s.explained_by is None
    ]
    located: set[int] = set()
    for first, second in itertools.combinations(flying, 2):
        if first.camera != second.camera and is_established((first, second)):
            flock = _flock(first, second, aerodrome)
            if flock is not None:
                located |= {id(first), id(second)}
                yield flock
    for bird in (sighting for sighting in flying if sighting.label == "bird"):
        if id(bird) not in located and is_established([bird]):
            line = _line(bird.last, aerodrome, bird.last.eye.foot(bird.last.box))
            if line.ray.up > 2.0 * line.error_rad:
                places = tuple(_along(bird.last, aerodrome))
                yield SeenAloft(True, places, (0.0, 0.0, 0.0), False, bird.last.t_ns, (bird,))


def _flock(first: VisualTrack, second: VisualTrack, aerodrome: Aerodrome) -> SeenAloft | None:
    """Return where two cameras see one thing in the air, None if they do not."""
    last_ns = min(first.last.t_ns, second.last.t_ns)
    fixes: list[tuple[float, Fix]] = []
    lately = (
        [g for g in each.observations if last_ns - g.t_ns <= MOTION_NS] for each in (first, second)
    )
    for one, other in _at_once(*lately):
        fix = meeting(_line(one, aerodrome, one.ray), _line(other, aerodrome, other.ray), FLOCK_M)
        if fix is not None:
            fixes.append(((one.t_ns - last_ns) / SECOND_NS, fix))
    if not fixes:
        return None
    last = fixes[-1][1]
    if last.height_m < ALOFT_M + ALOFT_SIGMAS * last.height_error_m:
        return None
    velocity = (0.0, 0.0, 0.0)
    if fixes[-1][0] - fixes[0][0] >= LEAST_MOTION_NS / SECOND_NS:
        times = np.array([time_s for time_s, _ in fixes])
        places = np.array([(*fix.point, fix.height_m) for _, fix in fixes])
        slopes = np.polyfit(times, places, 1)[0]
        velocity = (float(slopes[0]), float(slopes[1]), float(slopes[2]))
    are_birds = "bird" in (first.label, second.label)
    return SeenAloft(are_birds, (last,), velocity, True, last_ns, (first, second))


def _at_once(
    first: Sequence[Observation], second: Sequence[Observation]
) -> Iterator[tuple[Observation, Observation]]:
    """Yield glimpses of two cameras that are of about the same instant, in order of time."""
    for one in first:
        other = min(second, key=lambda observation: abs(observation.t_ns - one.t_ns), default=None)
        if other is not None and abs(other.t_ns - one.t_ns) <= SAME_INSTANT_NS:
            yield one, other


def _along(observation: Observation, aerodrome: Aerodrome) -> Iterator[Fix]:
    """Yield where birds may be that look so large: one small bird, or a flock, or between."""
    line = _line(observation, aerodrome, observation.ray)
    size_rad = max(observation.size_rad)
    steps = 12
    for step in range(steps + 1):
        size_m = SMALLEST_BIRD_M * (FLOCK_M / SMALLEST_BIRD_M) ** (step / steps)
        yield line.at(size_m / max(size_rad, line.error_rad))
