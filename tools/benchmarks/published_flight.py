"""Climbs and go-arounds as they are flown in calm air, beside what is published for each type.

`PUBLISHED` has the ranges. Rates are in ft/min, pitch in degrees, times in s, heights in ft.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator
from typing import Literal, NamedTuple

from airhilt.scenario.models.responses import CALL_S
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE
from airhilt.world.flight import Aircraft, AircraftState, InitialCondition, load_aircraft_type
from benchmarks.procedures import (
    COURSE_RAD,
    RUNWAY,
    THRESHOLD,
    TICK_S,
    WEATHERS,
    Flight,
    Measurements,
    states,
)


class Range(NamedTuple):
    """A range that is published, or assumed; without one, a number is only shown."""

    at_least: float = -math.inf
    at_most: float = math.inf
    basis: Literal["published", "assumed"] = "published"

    def __str__(self) -> str:
        """Return the range for the table."""
        if self == Range():
            return "-"
        if math.isinf(self.at_least):
            return f"up to {self.at_most:.4g}"
        return f"{self.at_least:.4g} to {self.at_most:.4g}"


class Row(NamedTuple):
    """One number of one type."""

    type: str
    number: str
    published: Range
    flown: float

    @property
    def is_failed(self) -> bool:
        """True outside the published range."""
        return not self.published.at_least <= self.flown <= self.published.at_most

    def __str__(self) -> str:
        """Return the line of the table."""
        verdict = "FAIL" if self.is_failed else "pass"
        return (
            f"{self.type:6} {self.number:27} {self.published.basis:9} {self.published!s:14} "
            f"flown {self.flown:7.1f}  {verdict}"
        )


JET_CLIMB_FPM = Range(2_500.0, 3_500.0, "assumed")
"""Initial climb of a 737 of 50 t and of a 747-400 of 250 t in line operation with reduced thrust.
It is assumed: the manuals have no rates for these weights."""
JET_PITCH_DEG = Range(12.0, 18.0, "assumed")
"""About the 15 degrees that the flight directors of Boeings command first (737 flight crew training
manual, takeoff); that 3 degrees are about is assumed."""
JET_GO_AROUND_FPM = Range(1_000.0, 2_000.0)
"""Rate that the autothrottle holds after the first push of TO/GA (737 flight crew training manual,
go-around and missed approach)."""
C172P_CLIMB_FPM = Range(595.0, 805.0, "assumed")
"""700 ft/min at sea level and the greatest weight (Cessna 172P pilot's operating handbook, section
1), and 15 % of it, which is assumed."""
C310_CLIMB_FPM = Range(1_495.0, 1_660.0)
"""At sea level and the greatest weight: 1,495 of a 310Q, 1,660 of a 310R (their owner's manual and
pilot's operating handbook)."""
LEAST_BALKED_GRADIENT = 0.033
"""Least climb gradient of a piston aircraft after a balked landing (14 CFR 23.77 of 1996)."""
CALL_TO_CLIMB_S = Range(3.0, 18.0)
"""Pilots need 3 s to react, and aircraft up to 15 s from the descent to the climb (ICAO Doc 8168,
volume II, part I, section 4, chapter 6)."""
HEIGHT_LOST_FT = {"A": 42.0, "B": 59.0, "C": 71.0, "D": 85.0}
"""Height loss of each category of aircraft, with a radio altimeter (ICAO Doc 8168, volume II,
table III-3-6-3 of 2006)."""
MEAN_RATE_PERCENT = Range(95.0, 105.0, "assumed")
"""Mean rate of an en-route climb as a part of what was asked; assumed."""
GREATEST_RATE_PERCENT = Range(at_most=115.0, basis="assumed")
"""Greatest rate of an en-route climb as a part of what was asked; assumed."""


def _published(
    climb_fpm: Range, pitch_deg: Range, go_around_fpm: Range, category: str
) -> dict[str, Range]:
    """Return the ranges of a type, by the names of what is measured."""
    return {
        "takeoff_climb_fpm": climb_fpm,
        "takeoff_pitch_deg": pitch_deg,
        "go_around_call_to_climb_s": CALL_TO_CLIMB_S,
        "go_around_height_lost_ft": Range(0.0, HEIGHT_LOST_FT[category]),
        "go_around_climb_fpm": go_around_fpm,
        "en_route_mean_percent": MEAN_RATE_PERCENT,
        "en_route_greatest_percent": GREATEST_RATE_PERCENT,
    }


def _balked_fpm(speed_kt: float, at_most_fpm: float) -> Range:
    """Return the climb after a balked landing: from what is certified to that after takeoff."""
    return Range(LEAST_BALKED_GRADIENT * speed_kt * KNOT / FOOT_PER_MINUTE, at_most_fpm)


PUBLISHED = {
    "737": _published(JET_CLIMB_FPM, JET_PITCH_DEG, JET_GO_AROUND_FPM, "C"),
    "B747": _published(JET_CLIMB_FPM, JET_PITCH_DEG, JET_GO_AROUND_FPM, "D"),
    "c172p": _published(C172P_CLIMB_FPM, Range(), _balked_fpm(80.0, 700.0), "A"),
    "c310": _published(C310_CLIMB_FPM, Range(), _balked_fpm(110.0, 1_660.0), "B"),
}
"""Published ranges of each type."""

CLIMB_TO_M = 1_000.0
CLIMB_FROM_FT, CLIMB_UP_TO_FT = 400.0, 1_000.0
"""Heights between which the climb after takeoff is measured: gear up, before the acceleration."""
GO_AROUND_FT = 200.0
"""Height of the main wheels at which the crew is called: the least decision height of category I
(ICAO Annex 6 part I, 4.2.8.3)."""
SETTLED_S, MEASURED_S = 5.0, 20.0
"""Time from the first climb of a go-around to the measurement of its rate, and its duration."""
ESTABLISHED_S, CLIMBING_S = 10.0, 60.0
"""Time from the command to the mean rate of an en-route climb, and to its end."""
CRUISE_FT = {"737": 10_000.0, "B747": 10_000.0, "c172p": 3_000.0, "c310": 3_000.0}


def rows(names: Iterable[str] = tuple(PUBLISHED)) -> Iterator[Row]:
    """Fly each type; yield its rows."""
    for name in names:
        flight = Flight(load_aircraft_type(name), WEATHERS["calm"], 1)
        flown = takeoff_climb(flight) | go_around(flight) | en_route_climb(flight)
        for number, published in PUBLISHED[name].items():
            yield Row(name, number, published, flown[number])


def takeoff_climb(flight: Flight) -> Measurements:
    """Take off; measure the climb before the aircraft accelerates."""
    aircraft = flight.lined_up(60.0)
    aircraft.procedures.take_off(RUNWAY, CLIMB_TO_M)
    climb = [
        state
        for state in states(aircraft, until="en_route")
        if CLIMB_FROM_FT * FOOT < state.height_agl_m < CLIMB_UP_TO_FT * FOOT
    ]
    return {
        "takeoff_climb_fpm": _mean_fpm(climb),
        "takeoff_pitch_deg": sum(state.pitch_rad for state in climb) / len(climb) / DEGREE,
    }


def go_around(flight: Flight) -> Measurements:
    """Go around after a call; the crew acts as scripted crews do."""
    aircraft = flight.on_final(2.0)
    aircraft.procedures.land(RUNWAY)
    states_on_final = states(aircraft, until="rollout")
    next(_ for _ in states_on_final if aircraft.main_wheel_height_m < GO_AROUND_FT * FOOT)
    for _ in _flown(aircraft, CALL_S):
        pass
    begun_m = lowest_m = aircraft.main_wheel_height_m
    aircraft.procedures.go_around(CLIMB_TO_M)
    waited_s = 0.0
    for state in states(aircraft, until="en_route"):
        waited_s += TICK_S
        lowest_m = min(lowest_m, aircraft.main_wheel_height_m)
        if state.vertical_rate_m_s > 0.0:
            break
    climb = _flown(aircraft, SETTLED_S + MEASURED_S)[round(SETTLED_S / TICK_S) :]
    return {
        "go_around_call_to_climb_s": CALL_S + waited_s,
        "go_around_height_lost_ft": (begun_m - lowest_m) / FOOT,
        "go_around_climb_fpm": _mean_fpm(climb),
    }


def en_route_climb(flight: Flight) -> Measurements:
    """Climb at the rate of the type for which none is asked."""
    speeds = flight.kind.speeds
    altitude_m = CRUISE_FT[flight.kind.name] * FOOT
    initial = InitialCondition(
        *THRESHOLD,
        altitude_m=altitude_m,
        track_rad=COURSE_RAD,
        calibrated_airspeed_m_s=speeds.cruise_kt * KNOT,
    )
    aircraft = flight.begin(initial)
    aircraft.en_route.hold_altitude(altitude_m + NAUTICAL_MILE)
    climb = _flown(aircraft, CLIMBING_S)
    greatest_fpm = max(state.vertical_rate_m_s for state in climb) / FOOT_PER_MINUTE
    mean_fpm = _mean_fpm(climb[round(ESTABLISHED_S / TICK_S) :])
    return {
        "en_route_mean_percent": 100.0 * mean_fpm / speeds.climb_rate_fpm,
        "en_route_greatest_percent": 100.0 * greatest_fpm / speeds.climb_rate_fpm,
    }


def _flown(aircraft: Aircraft, seconds: float) -> list[AircraftState]:
    """Fly for some time; return the state after each tick."""
    return list(itertools.islice(states(aircraft, until="rollout"), round(seconds / TICK_S)))


def _mean_fpm(climb: list[AircraftState]) -> float:
    rates = [state.vertical_rate_m_s for state in climb]
    return sum(rates) / len(rates) / FOOT_PER_MINUTE
