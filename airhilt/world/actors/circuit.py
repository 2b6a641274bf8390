"""The traffic circuit of a runway for one type of aircraft, and the turns that it flies there."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from airhilt.commands import CircuitLeg, Side
from airhilt.geodesy.wgs84 import Place
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE, STANDARD_GRAVITY
from airhilt.world.actors.final_approach import FinalApproach
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.curves import Piece, Pose, line, shortest
from airhilt.world.flight.guidance import ARC_BANK_PART
from airhilt.world.flight.state import AircraftState

CIRCUIT_HEIGHT_FT = {"jet": 1500.0, "heavy_jet": 1500.0}
"""Height of the circuit above the airport, in ft, where it is not `LIGHT_CIRCUIT_FT` (FAA
Aeronautical Information Manual 4-3-3: 500 ft above the usual one for turbine-powered aircraft)."""
LIGHT_CIRCUIT_FT = 1000.0
"""Usual height of the circuit above the airport, in ft (FAA Aeronautical Information Manual
4-3-3)."""
LEAST_WIDTH_M = 1.0 * NAUTICAL_MILE
"""Least distance between the downwind leg and the runway, in m (FAA Airplane Flying Handbook, 8: a
half to one mile)."""
WIDTH_RADII = 2.5
"""Least distance of the downwind leg of faster aircraft, in turn radii: two turns and a short
base leg between them; assumed."""
WIDEST_PART = 2.0
"""Greatest distance of a downwind leg that is flown already, in parts of the usual one; assumed."""
STABLE_FT = 500.0
"""Height at which an approach has its wings level on the final course, in ft (Flight Safety
Foundation, ALAR Briefing Note 7.1: stabilised in visual conditions)."""
STABLE_CIRCLING_FT = 300.0
"""The same for a circling approach, in ft (ALAR Briefing Note 7.1)."""
SETTLE_S = 5.0
"""Time from the end of the last turn until the wings are level, in s; assumed."""
APPROACH_SPEED_PART = 1.1
"""Speed in the last turns, as a part of the approach speed; assumed."""
LEG_ANGLES = {"upwind": 0.0, "crosswind": -90.0, "downwind": 180.0, "base": 90.0, "final": 0.0}
"""Courses of the legs of a circuit with left turns, in degrees from that of the runway."""
ON_LEG_RAD = 45.0 * DEGREE
"""Greatest angle to the course of a leg at which an aircraft flies on it, in rad; assumed."""


def circuit_height_m(kind: AircraftType) -> float:
    """Return the height of the circuit above the airport."""
    return CIRCUIT_HEIGHT_FT.get(kind.category, LIGHT_CIRCUIT_FT) * FOOT


def turn_radius_m(kind: AircraftType, speed_m_s: float) -> float:
    """Return the radius of a turn at a speed over the ground, with some bank left to correct."""
    bank_rad = ARC_BANK_PART * kind.gains.roll.bank_limit_deg * DEGREE
    return speed_m_s**2 / (STANDARD_GRAVITY * math.tan(bank_rad))


def radius_now_m(kind: AircraftType, state: AircraftState) -> float:
    """Return the radius of a turn all around at the present airspeed, in the present wind."""
    return turn_radius_m(kind, max(state.true_airspeed_m_s, state.ground_speed_m_s))


def last_radius_m(kind: AircraftType, state: AircraftState) -> float:
    """Return the radius of the turns to base and to final, in the present wind."""
    wind = abs(state.ground_speed_m_s - state.true_airspeed_m_s)
    return turn_radius_m(kind, APPROACH_SPEED_PART * kind.speeds.approach_kt * KNOT + wind)


def gate_m(kind: AircraftType, final: FinalApproach, stable_ft: float) -> float:
    """Return how far before the threshold the last turn ends, to be stable at a height in ft."""
    stable_m = stable_ft * FOOT / math.tan(final.runway.glide_path_rad) - kind.landing.aim_m
    return stable_m + SETTLE_S * kind.speeds.approach_kt * KNOT


def joined(poses: Sequence[Pose], first_radius_m: float, radius_m: float) -> tuple[Piece, ...]:
    """Return the shortest curve through poses; the first turn has a radius of its own."""
    pieces: list[Piece] = []
    for start, end in itertools.pairwise(poses):
        pieces += shortest(start, end, radius_m if pieces else first_radius_m, radius_m)
    return tuple(pieces)


class Circuit:
    """Traffic circuit of a runway with turns to one side, for an aircraft as it flies now."""

    def __init__(
        self,
        final: FinalApproach,
        kind: AircraftType,
        side: Side,
        state: AircraftState,
        stable_ft: float = STABLE_FT,
    ) -> None:
        self.final = final
        self.side = side
        self._sign = -1.0 if side == "left" else 1.0
        self._radius_m = last_radius_m(kind, state)
        self._radius_now_m = radius_now_m(kind, state)
        self._width_m = max(LEAST_WIDTH_M, WIDTH_RADII * self._radius_m)
        self._gate_m = gate_m(kind, final, stable_ft)

    def course_rad(self, leg: CircuitLeg) -> float:
        """Return the course of a leg."""
        return self.final.pose(0.0, 0.0, self._angle(leg)).course_rad

    def is_on(self, leg: CircuitLeg, here: Place, track_rad: float) -> bool:
        """Return whether an aircraft flies along a leg, on its side of the runway."""
        along = abs(math.remainder(track_rad - self.course_rad(leg), math.tau)) < ON_LEG_RAD
        aside_m = self._sign * self.final.right_m(here)
        return along and (leg in ("upwind", "final") or aside_m > 0.0)

    def poses(self, leg: CircuitLeg, here: Place, track_rad: float) -> dict[CircuitLeg, Pose]:
        """Return where the circuit is joined on a leg, and a place on each leg from there on."""
        final, radius, width_m = self.final, self._radius_m, self._width_m
        if self.is_on("downwind", here, track_rad):
            width_m = min(max(width_m, abs(final.right_m(here))), WIDEST_PART * width_m)
        width_m *= self._sign
        before_m, length_m = final.before_m(here), final.runway.length_m
        is_on = self.is_on(leg, here, track_rad)
        turn_m = self._gate_m + radius
        along = {
            "upwind": -length_m if not is_on else min(-length_m, before_m - radius),
            "crosswind": -length_m - radius,
            "downwind": -length_m / 2.0
            if not is_on
            else max(-length_m / 2.0, before_m + self._radius_now_m),
            "base": turn_m,
        }
        if leg == "base" and self.is_on("downwind", here, track_rad):
            along["base"] = max(turn_m, before_m + self._radius_now_m)
        if is_on and leg == "crosswind":
            along["crosswind"] = min(along["crosswind"], before_m)
        if leg == "upwind":
            along["crosswind"] = min(along["crosswind"], along["upwind"] - radius)
        if leg == "downwind":
            along["base"] = max(turn_m, along["downwind"] + radius)
        aside = {"upwind": 0.0, "downwind": 1.0}
        legs: tuple[CircuitLeg, ...] = ("upwind", "crosswind", "downwind", "base")
        ahead = () if leg == "final" else legs[legs.index(leg) :]
        poses = {
            each: final.pose(along[each], aside.get(each, 0.5) * width_m, self._angle(each))
            for each in ahead
        }
        gate_m = max(self._gate_m, along["base"] - radius) if ahead else self._gate_m
        return {**poses, "final": final.pose(gate_m)}

    def _angle(self, leg: CircuitLeg) -> float:
        return -self._sign * LEG_ANGLES[leg] * DEGREE


def to_threshold(final: FinalApproach, pieces: Sequence[Piece], gate: Pose) -> tuple[Piece, ...]:
    """Return a curve to a gate on the final approach, and the line from there to the threshold."""
    east, north, _ = final.pose(0.0)
    return *pieces, line(gate, math.hypot(east - gate.east_m, north - gate.north_m))
