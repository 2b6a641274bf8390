"""Things on the ground and low over it, as one or several cameras show them together."""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from airhilt.assistant.decision.aerodrome import Aerodrome, Vector
from airhilt.assistant.decision.line_of_sight import AirFix, GroundFix, LineOfSight, Ray, meeting
from airhilt.assistant.decision.visual_tracks import (
    Observation,
    VisualTrack,
    VisualTracks,
    belief_in,
)
from airhilt.messages import VisibleClass
from airhilt.units import SECOND_NS

MOTION_NS = 2 * SECOND_NS
"""Time over which a speed is measured, in ns."""
LEAST_MOTION_NS = SECOND_NS
SAME_INSTANT_NS = SECOND_NS // 4
"""Longest time between two cameras' observations of one thing in the air, in ns."""
FLOCK_M = 20.0
"""Largest size of a flock, in m."""
SMALLEST_BIRD_M = 0.4
ALOFT_SIGMAS = 2.0
ALOFT_M = 4.0
"""Height, in m, above which birds are in the air."""
STEADY_SIGMAS = 2.0
"""Speeds below this many standard deviations are treated as standing."""


class SeenOnGround(NamedTuple):
    """Something on the ground, as one or more cameras show it."""

    label: VisibleClass
    is_animal: bool
    fix: GroundFix
    belief: float
    is_established: bool
    """True if cameras show it surely enough to say that it is there."""
    tracks: tuple[VisualTrack, ...]
    """Its visual tracks, the one with the highest belief first."""


class SeenAloft(NamedTuple):
    """Birds in the air, or an aircraft without transponder."""

    are_birds: bool
    places: tuple[AirFix, ...]
    """Positions that it may have; one if cameras tell the distance."""
    velocity: tuple[float, float, float]
    """East, north and up, in m/s; 0 where it is not known."""
    is_located: bool
    t_ns: int
    tracks: tuple[VisualTrack, ...]


def seen_on_ground(
    visual_tracks: VisualTracks,
    aerodrome: Aerodrome,
    aloft: Iterable[SeenAloft],
    animals: Collection[VisibleClass],
) -> Iterator[SeenOnGround]:
    """Yield what neither flies nor is known by ADS-B, by falling belief."""
    flying = {track for thing in aloft for track in thing.tracks}
    known = [
        (track, fix)
        for track in visual_tracks
        if track not in flying
        and track.explained_by is None
        and (fix := _ground_fix(track.last, aerodrome)) is not None
    ]
    known.sort(key=lambda pair: -pair[0].belief)
    while known:
        (first, fix), *known = known
        is_animal = first.label in animals
        together, rest = [first], []
        for other, place in known:
            is_new = all(other.camera != one.camera for one in together)
            is_alike = (other.label in animals) == is_animal
            if is_new and is_alike and fix.is_same(place):
                together.append(other)
                fix = fix.merged(place)
            else:
                rest.append((other, place))
        known = rest
        belief, is_established = belief_in(together), visual_tracks.shows(together)
        yield SeenOnGround(first.label, is_animal, fix, belief, is_established, tuple(together))


def _ground_fix(observation: Observation, aerodrome: Aerodrome) -> GroundFix | None:
    return _line(observation, aerodrome, observation.geometry.foot(observation.box)).on_ground()


def _line(observation: Observation, aerodrome: Aerodrome, ray: Ray) -> LineOfSight:
    view = observation.geometry.view
    place = aerodrome.locate(view.latitude_deg, view.longitude_deg)
    return LineOfSight(place, view.height_m, ray, observation.geometry.error_rad)


def velocity_of(thing: SeenOnGround, aerodrome: Aerodrome) -> Vector:
    """Return the velocity of something on the ground, in m/s; 0 unless it clearly moves."""
    track = thing.tracks[0]
    last_ns = track.last.t_ns
    places = [
        ((observation.t_ns - last_ns) / SECOND_NS, fix)
        for observation in track.observations
        if last_ns - observation.t_ns <= MOTION_NS
        and (fix := _ground_fix(observation, aerodrome)) is not None
    ]
    if len(places) < 3 or -places[0][0] < LEAST_MOTION_NS / SECOND_NS:
        return Vector(0.0, 0.0)
    times = np.array([time_s for time_s, _ in places])
    points = np.array([fix.point for _, fix in places])
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

    Detectors easily take distant birds and aircraft for each other.
    """
    flying = [
        s for s in visual_tracks if s.label in ("bird", "airplane") and s.explained_by is None
    ]
    located: set[VisualTrack] = set()
    for first, second in itertools.combinations(flying, 2):
        if first.camera != second.camera and visual_tracks.shows((first, second)):
            flock = _flock(first, second, aerodrome)
            if flock is not None:
                located |= {first, second}
                yield flock
    for bird in flying:
        if bird.label == "bird" and bird not in located and visual_tracks.shows([bird]):
            line = _line(bird.last, aerodrome, bird.last.geometry.foot(bird.last.box))
            if line.ray.up > 2.0 * line.error_rad:
                places = tuple(_along(bird.last, aerodrome))
                yield SeenAloft(True, places, (0.0, 0.0, 0.0), False, bird.last.t_ns, (bird,))


def _flock(first: VisualTrack, second: VisualTrack, aerodrome: Aerodrome) -> SeenAloft | None:
    """Return the position at which two cameras see one thing in the air, None if they do not."""
    last_ns = min(first.last.t_ns, second.last.t_ns)
    fixes: list[tuple[float, AirFix]] = []
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
    """Yield pairs of observations of about the same instant, in order of time."""
    for one in first:
        other = min(second, key=lambda observation: abs(observation.t_ns - one.t_ns), default=None)
        if other is not None and abs(other.t_ns - one.t_ns) <= SAME_INSTANT_NS:
            yield one, other


def _along(observation: Observation, aerodrome: Aerodrome) -> Iterator[AirFix]:
    """Yield positions along the line of sight for birds from one small bird to a flock."""
    line = _line(observation, aerodrome, observation.ray)
    size_rad = max(observation.size_rad)
    steps = 12
    for step in range(steps + 1):
        size_m = SMALLEST_BIRD_M * (FLOCK_M / SMALLEST_BIRD_M) ** (step / steps)
        yield line.at(size_m / max(size_rad, line.error_rad))
