"""Plans of the script for each aircraft, had nobody been warned: its levels and its path."""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from types import UnionType

from airhilt.commands import (
    AltitudeCommand,
    Command,
    DirectCommand,
    HoldAtCommand,
    MachCommand,
    OrbitCommand,
    ResumeRouteCommand,
    ResumeSpeedCommand,
    RouteCommand,
    SpeedCommand,
    TrackCommand,
    TurnCommand,
)
from airhilt.geodesy.relative_motion import VerticalProfile
from airhilt.geodesy.wgs84 import Place, earth_centred, offset_m
from airhilt.messages import ActorTruth
from airhilt.scenario.failures import EffectiveLine
from airhilt.surveillance.tcas import AltitudeAt
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, SECOND_NS, seconds_to_ns
from airhilt.world.flight.route import Leg, legs_through

LEVEL_M_S = 100.0 * FOOT_PER_MINUTE
"""Vertical speed below which an aircraft does not climb or descend yet, in m/s."""
LateralOffset = Callable[[Place], float]
"""Lateral distance (m) of a place from a path."""
KEEPS_PATH = AltitudeCommand | SpeedCommand | MachCommand | ResumeSpeedCommand
"""Commands after which an aircraft flies on along its path."""
KEEPS_LEVEL = (
    KEEPS_PATH | TrackCommand | TurnCommand | RouteCommand | ResumeRouteCommand | DirectCommand
    | OrbitCommand | HoldAtCommand
)  # fmt: skip
"""Commands after which the planned altitude of an aircraft is known."""


@dataclass(frozen=True)
class Start:
    """Plan of an aircraft from the start of the run.

    The usual rate is the vertical speed of a climb for which none was told.
    """

    usual_rate_m_s: float
    route: tuple[Place, ...] = ()
    commands: tuple[Command, ...] = ()


class Plans:
    """The commands of the script, and when each is carried out.

    The lines have the scenario's failures applied. `ends_ns` is the time by which each line ends,
    by its id; for one to come, if the frequency is free then. `starts` are by callsign.
    """

    def __init__(
        self,
        lines: Sequence[EffectiveLine],
        ends_ns: Mapping[str, int],
        starts: Mapping[str, Start],
    ) -> None:
        self._starts = starts
        self._due: dict[str, list[tuple[int, Command]]] = {
            callsign: [(0, command) for command in start.commands]
            for callsign, start in starts.items()
        }
        for effective in lines:
            for scripted in effective.line.commands if effective.line else ():
                due_ns = ends_ns[effective.declared.id] + seconds_to_ns(scripted.delay_s)
                self._due.setdefault(scripted.actor, []).append((due_ns, scripted.command))

    def altitude_at(self, callsign: str, now_ns: int, profile: VerticalProfile) -> AltitudeAt:
        """Return the altitude over time of an aircraft that has this profile now, as planned."""
        pieces = [(0.0, profile)]
        for due_ns, command in sorted(self._due.get(callsign, []), key=lambda plan: plan[0]):
            if due_ns <= now_ns or not isinstance(command, AltitudeCommand):
                continue
            time_s = (due_ns - now_ns) / SECOND_NS
            last_s, last = pieces[-1]
            begin_m = last.at(time_s - last_s)
            rate = command.vertical_rate_fpm
            usual_m_s = self._starts[callsign].usual_rate_m_s
            speed_m_s = usual_m_s if rate is None else rate * FOOT_PER_MINUTE
            target_m = command.altitude_ft * FOOT
            rate_m_s = speed_m_s if target_m > begin_m else -speed_m_s
            pieces.append((time_s, VerticalProfile(begin_m, rate_m_s, target_m)))
        begins_s = [begin_s for begin_s, _ in pieces]

        def at(time_s: float) -> float:
            begin_s, piece = pieces[bisect.bisect_right(begins_s, time_s) - 1]
            return piece.at(time_s - begin_s)

        return at

    def altitude_from_start(self, state: ActorTruth, target_m: float) -> AltitudeAt:
        """Return the planned altitude of an aircraft that has this state at the start."""
        climb_m = target_m - state.altitude_m
        speed_m_s = abs(state.velocity_down_m_s)
        if speed_m_s < LEVEL_M_S:
            speed_m_s = self._starts[state.actor].usual_rate_m_s
        profile = VerticalProfile(state.altitude_m, math.copysign(speed_m_s, climb_m), target_m)
        return self.altitude_at(state.actor, state.t_ns, profile)

    def offset_from_start(self, state: ActorTruth) -> LateralOffset:
        """Return the distance from the planned path of an aircraft with this state at the start.

        The path is its route, or without one its track.
        """
        here = place_of(state)
        if route := self._starts[state.actor].route:
            return partial(_from_legs_m, legs_through(here, route))
        track_rad = math.atan2(state.velocity_east_m_s, state.velocity_north_m_s)
        return partial(_from_track_m, here, track_rad)

    def level_until_ns(self, callsign: str) -> float:
        """Return until when the planned altitude of an aircraft is known, in ns."""
        return self._first_ns(callsign, KEEPS_LEVEL)

    def path_until_ns(self, callsign: str) -> float:
        """Return until when the planned path of an aircraft is known, in ns."""
        return self._first_ns(callsign, KEEPS_PATH)

    def _first_ns(self, callsign: str, keeping: UnionType) -> float:
        due = self._due.get(callsign, ())
        times = (due_ns for due_ns, command in due if not isinstance(command, keeping))
        return min(times, default=math.inf)


def place_of(state: ActorTruth) -> Place:
    """Return where an actor is."""
    return state.latitude_deg * DEGREE, state.longitude_deg * DEGREE


def _from_track_m(begin: Place, track_rad: float, here: Place) -> float:
    north_m, east_m = offset_m(begin, here)
    return abs(east_m * math.cos(track_rad) - north_m * math.sin(track_rad))


def _from_legs_m(legs: Sequence[Leg], here: Place) -> float:
    place = earth_centred(here)
    return min(leg.distance_m(place, is_last=leg is legs[-1]) for leg in legs)
