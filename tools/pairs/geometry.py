"""Random encounters: two aircraft whose paths are drawn from published distributions.

| what | distribution |
| --- | --- |
| course of each | uniform over all directions |
| ground speed of each | uniform, 120 to 480 kt |
| time from the start to the closest approach | uniform, 150 to 300 s |
| horizontal miss distance | uniform, 0 to 12 NM, to either side |
| vertical distance at the closest approach | uniform, 0 to 4,000 ft, either above |
| vertical movement of each | level, a steady rate, or a manoeuvre that begins; a third each |
| steady rate | uniform, 300 to 2,500 ft/min, up or down |
| manoeuvre | such a rate from a time on, uniform, 120 s before to 20 s after closest approach |
| end of a climb or descent | none in one of two, otherwise a level off after 30 to 240 s |

Paths are straight over the ground, and levels waver by 15 ft as in light turbulence. Nobody reacts.
The closest approach is the horizontal one; levels are shifted so that its vertical distance holds.
An encounter that begins within 8 NM and 1,500 ft is drawn anew. Close ones are not, and have 20 to
180 s, 0 to 0.2 NM and 0 to 600 ft in place of the bounds in the table.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from airhilt.units import FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE

SPEED_KT = (120.0, 480.0)
RATE_FPM = (300.0, 2500.0)
BEGINS_S = (-120.0, 20.0)
"""Begin of a manoeuvre, counted from the closest approach."""
LASTS_S = (30.0, 240.0)
MIDDLE_FT = 25_000.0
AFTER_S = 60.0
"""Time that is flown after the closest approach."""
APART_M = 8.0 * NAUTICAL_MILE
LEVELS_APART_M = 1500.0 * FOOT
"""Distances of which one is exceeded when an encounter begins."""
WAVER_FT = 15.0
WAVER_S = 60.0


class Passing(NamedTuple):
    """Bounds of the time to the closest approach, and of the distances there."""

    approach_s: tuple[float, float]
    miss_nm: tuple[float, float]
    vertical_ft: tuple[float, float]


USUAL = Passing((150.0, 300.0), (0.0, 12.0), (0.0, 4000.0))
CLOSE = Passing((20.0, 180.0), (0.0, 0.2), (0.0, 600.0))


@dataclass(frozen=True)
class Path:
    """The path of one aircraft; metres and seconds.

    Attributes
    ----------
    closest_m
        Place at the closest approach, east and north.
    closest_s
        Time of that.
    level_m
        Altitude before the vertical movement.
    begins_s, ends_s
        Begin and end of the vertical movement.
    phase_rad
        Phase of the wavering at the start.
    """

    course_rad: float
    speed_m_s: float
    closest_m: tuple[float, float]
    closest_s: float
    level_m: float
    rate_m_s: float
    begins_s: float
    ends_s: float
    phase_rad: float

    @property
    def velocity_m_s(self) -> tuple[float, float]:
        """Velocity, east and north."""
        return (
            self.speed_m_s * math.sin(self.course_rad),
            self.speed_m_s * math.cos(self.course_rad),
        )

    def place_m(self, time_s: float) -> tuple[float, float]:
        """Return where it is at a time, east and north."""
        east, north = self.velocity_m_s
        elapsed = time_s - self.closest_s
        return self.closest_m[0] + east * elapsed, self.closest_m[1] + north * elapsed

    def altitude_m(self, time_s: float) -> float:
        """Return its altitude at a time."""
        moved_s = min(max(time_s, self.begins_s), self.ends_s) - self.begins_s
        waver = math.sin(math.tau * time_s / WAVER_S + self.phase_rad)
        return self.level_m + self.rate_m_s * moved_s + WAVER_FT * FOOT * waver

    def vertical_rate_m_s(self, time_s: float) -> float:
        """Return its rate of climb at a time."""
        waver = math.cos(math.tau * time_s / WAVER_S + self.phase_rad) * math.tau / WAVER_S
        moving = self.rate_m_s if self.begins_s <= time_s < self.ends_s else 0.0
        return moving + WAVER_FT * FOOT * waver


@dataclass(frozen=True)
class Encounter:
    """Two paths, and how long they are flown."""

    first: Path
    second: Path
    duration_s: float

    def distances_m(self, time_s: float) -> tuple[float, float]:
        """Return the horizontal and the vertical distance at a time."""
        one, other = self.first.place_m(time_s), self.second.place_m(time_s)
        gap = self.first.altitude_m(time_s) - self.second.altitude_m(time_s)
        return math.hypot(one[0] - other[0], one[1] - other[1]), abs(gap)


def draw(draws: np.random.Generator) -> Encounter:
    """Return a random encounter."""
    while True:
        encounter = _drawn(draws, USUAL)
        horizontal_m, vertical_m = encounter.distances_m(0.0)
        if horizontal_m > APART_M or vertical_m > LEVELS_APART_M:
            return encounter


def draw_close(draws: np.random.Generator) -> Encounter:
    """Return a random encounter of two that pass close, and may be seen late."""
    return _drawn(draws, CLOSE)


def _drawn(draws: np.random.Generator, passing: Passing) -> Encounter:
    courses = draws.uniform(0.0, math.tau, size=2)
    speeds = draws.uniform(*SPEED_KT, size=2) * KNOT
    approach_s = float(draws.uniform(*passing.approach_s))
    miss = float(draws.uniform(*passing.miss_nm)) * NAUTICAL_MILE * float(draws.choice((-1.0, 1.0)))
    vertical = float(draws.uniform(*passing.vertical_ft)) * FOOT * float(draws.choice((-1.0, 1.0)))
    motions = [_motion(draws, approach_s) for _ in range(2)]
    east = speeds * np.sin(courses)
    north = speeds * np.cos(courses)
    relative = np.array((east[1] - east[0], north[1] - north[0]))
    across = np.array((-relative[1], relative[0])) / max(float(np.hypot(*relative)), 1e-9)
    paths = []
    for index, (rate, begins_s, ends_s) in enumerate(motions):
        moved = rate * (min(max(approach_s, begins_s), ends_s) - begins_s)
        at_approach = MIDDLE_FT * FOOT + vertical * index
        place = across * miss * index
        paths.append(
            Path(
                float(courses[index]),
                float(speeds[index]),
                (float(place[0]), float(place[1])),
                approach_s,
                at_approach - moved,
                rate,
                begins_s,
                ends_s,
                float(draws.uniform(0.0, math.tau)),
            )
        )
    return Encounter(paths[0], paths[1], approach_s + AFTER_S)


def _motion(draws: np.random.Generator, approach_s: float) -> tuple[float, float, float]:
    """Return the rate of a vertical movement, when it begins and when it ends."""
    kind = draws.choice(("level", "steady", "begins"))
    rate = float(draws.uniform(*RATE_FPM)) * FOOT_PER_MINUTE * float(draws.choice((-1.0, 1.0)))
    begins_s = approach_s + float(draws.uniform(*BEGINS_S)) if kind == "begins" else 0.0
    ends_s = begins_s + float(draws.uniform(*LASTS_S)) if draws.random() < 0.5 else math.inf
    return (0.0, 0.0, math.inf) if kind == "level" else (rate, begins_s, ends_s)
