"""Curves of straight lines and turns over a plane: orbits, holding patterns, ways to a runway.

`shortest` finds a curve between two poses: a turn, a line and a turn (L. E. Dubins, On curves of
minimal length, 1957). `Curve` follows pieces of one with an aircraft.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.units import wrap_angle
from airhilt.world.flight.route import Guide
from airhilt.world.flight.state import AircraftState

NO_TURN_RAD = 1e-6
"""Angle in rad below which a turn is left out, and that much less than a circle is none."""

SAME_PLACE_M = 1.0
"""Distance in m within which a piece begins at a pose."""


class Pose(NamedTuple):
    """Place in a plane, and the course there."""

    east_m: float
    north_m: float
    course_rad: float


@dataclass(frozen=True, slots=True)
class Piece:
    """A line, or a turn at a constant curvature."""

    start: Pose
    length_m: float
    curvature_per_m: float = 0.0
    """Change of course per distance, in rad/m, positive to the right; 0 for a line."""

    @property
    def end(self) -> Pose:
        """Pose at its end."""
        return self.at(self.length_m)

    def at(self, along_m: float) -> Pose:
        """Return the pose at a distance from its start."""
        east, north, course = self.start
        if not self.curvature_per_m:
            return Pose(
                east + along_m * math.sin(course), north + along_m * math.cos(course), course
            )
        radius = 1.0 / self.curvature_per_m
        after = course + along_m * self.curvature_per_m
        return Pose(
            east + radius * (math.cos(course) - math.cos(after)),
            north + radius * (math.sin(after) - math.sin(course)),
            after,
        )


def line(start: Pose, length_m: float) -> Piece:
    """Return a straight line."""
    return Piece(start, length_m)


def turn(start: Pose, angle_rad: float, radius_m: float) -> Piece:
    """Return a turn through an angle, positive to the right."""
    return Piece(start, abs(angle_rad) * radius_m, math.copysign(1.0 / radius_m, angle_rad))


def shortest(
    start: Pose, end: Pose, start_radius_m: float, end_radius_m: float
) -> tuple[Piece, ...]:
    """Return the shortest curve of a turn, a line and a turn of these radii.

    Where circles of these radii have no common tangent, both turns have the greater radius.
    """
    radii = start_radius_m, end_radius_m
    found = [
        curve
        for first, last in itertools.product((-1.0, 1.0), repeat=2)
        if (curve := _turn_line_turn(start, end, first * radii[0], last * radii[1])) is not None
    ]
    if not found:
        widest = max(radii)
        return shortest(start, end, widest, widest)
    return min(found, key=length_m)


def length_m(pieces: Sequence[Piece]) -> float:
    """Return the length of a curve."""
    return sum(each.length_m for each in pieces)


def turning_rad(pieces: Sequence[Piece]) -> float:
    """Return the sum of the turns of a curve, to either side."""
    return sum(each.length_m * abs(each.curvature_per_m) for each in pieces)


def _turn_line_turn(start: Pose, end: Pose, first: float, last: float) -> tuple[Piece, ...] | None:
    """Return the curve with turns of these radii in m, positive to the right; None if none is."""
    east = (end.east_m + last * math.cos(end.course_rad)) - (
        start.east_m + first * math.cos(start.course_rad)
    )
    north = (end.north_m - last * math.sin(end.course_rad)) - (
        start.north_m - first * math.sin(start.course_rad)
    )
    between, apart = math.hypot(east, north), last - first
    if abs(apart) > between:
        return None
    course = start.course_rad
    if between > 0.0:
        course = math.atan2(east, north) - math.asin(apart / between)
    onto = turn(start, _through(course - start.course_rad, first), abs(first))
    along = line(onto.end, math.sqrt(between**2 - apart**2))
    off = turn(along.end, _through(end.course_rad - course, last), abs(last))
    return tuple(each for each in (onto, along, off) if each.length_m > 0.0)


def _through(change_rad: float, side: float) -> float:
    """Return the angle of a turn to a side that changes the course so."""
    sign = math.copysign(1.0, side)
    angle = (sign * change_rad) % math.tau
    return 0.0 if min(angle, math.tau - angle) < NO_TURN_RAD else sign * angle


class Curve:
    """Pieces that an aircraft follows one after the other, and the last one's line beyond it.

    With ``repeat_from`` it begins again with that piece, counted from 0, after the last one.
    """

    def __init__(
        self, frame: LocalFrame, pieces: Sequence[Piece], repeat_from: int | None = None
    ) -> None:
        self._frame = frame
        self._pieces = tuple(pieces)
        self._repeat_from = repeat_from
        self._index = 0
        self._along = 0.0
        self._rest = [length_m(pieces[index + 1 :]) for index in range(len(pieces))]

    @property
    def to_go_m(self) -> float:
        """Distance to the end of the last piece, negative beyond it, as of the last `guide`."""
        return self._pieces[self._index].length_m - self._along + self._rest[self._index]

    @property
    def is_on_last_piece(self) -> bool:
        """True on the last piece and beyond it."""
        return self._index == len(self._pieces) - 1

    @property
    def end(self) -> Pose:
        """Pose at the end of the last piece."""
        return self._pieces[-1].end

    def has_passed(self, pose: Pose) -> bool:
        """Return whether a pose at which a piece begins has been passed."""
        near = (
            index
            for index, piece in enumerate(self._pieces)
            if math.dist(piece.start[:2], pose[:2]) < SAME_PLACE_M
        )
        return self._index >= next(near, len(self._pieces))

    def guide(self, state: AircraftState, lead_s: float) -> Guide:
        """Return the position of the aircraft relative to the curve.

        The turn rate is that of the curve so much later, for the time that a roll takes.
        """
        here = self._frame.to_local((state.latitude_rad, state.longitude_rad))
        off_m = self._follow(here)
        speed = state.ground_speed_m_s
        pose = self._pieces[self._index].at(self._along)
        return Guide(off_m, pose.course_rad, self._curvature(lead_s * speed) * speed)

    def _follow(self, here: tuple[float, float]) -> float:
        """Note how far along the aircraft is; return how far it is to the right."""
        along, off_m = self._beside(here)
        while along >= self._pieces[self._index].length_m:
            if not self.is_on_last_piece:
                self._index += 1
            elif self._repeat_from is not None:
                self._index = self._repeat_from
            else:
                break
            self._along = 0.0
            along, off_m = self._beside(here)
        self._along = along
        return off_m

    def _beside(self, here: tuple[float, float]) -> tuple[float, float]:
        """Return how far along the present piece a place is, and how far to the right of it."""
        piece = self._pieces[self._index]
        start, curvature = piece.start, piece.curvature_per_m
        if piece.length_m <= self._along or not curvature:
            from_pose = piece.end if curvature else start
            past_m = piece.length_m if curvature else 0.0
            east, north = here[0] - from_pose.east_m, here[1] - from_pose.north_m
            sin, cos = math.sin(from_pose.course_rad), math.cos(from_pose.course_rad)
            return past_m + east * sin + north * cos, east * cos - north * sin
        radius = 1.0 / curvature
        east = here[0] - (start.east_m + radius * math.cos(start.course_rad))
        north = here[1] - (start.north_m - radius * math.sin(start.course_rad))
        # Course of the circle beside the aircraft, which changes little between two looks.
        course = math.atan2(east, north) + math.copysign(math.pi / 2.0, curvature)
        turned = wrap_angle(course - start.course_rad - self._along * curvature)
        inside = abs(radius) - math.hypot(east, north)
        return self._along + turned / curvature, inside if curvature > 0.0 else -inside

    def _curvature(self, ahead_m: float) -> float:
        """Return the curvature so far ahead."""
        index, left = self._index, self._along + ahead_m
        while left > self._pieces[index].length_m:
            left -= self._pieces[index].length_m
            if index < len(self._pieces) - 1:
                index += 1
            elif self._repeat_from is not None:
                index = self._repeat_from
            else:
                return 0.0
        return self._pieces[index].curvature_per_m
