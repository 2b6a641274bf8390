"""Measures how well procedures are flown: every type in every weather, the worst over seeds.

`PROCEDURES` lists them. Each function flies once and returns what it measured; a criterion bounds
one of the measurements. The seed makes the turbulence, and where the aircraft begins within a metre
or so.
"""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from typing import NamedTuple

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place, onward
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE
from airhilt.world.flight import (
    Aircraft,
    AircraftState,
    AircraftType,
    Atmosphere,
    InitialCondition,
    load_aircraft_type,
)
from airhilt.world.flight.procedures.final import Final
from airhilt.world.flight.state import OnGround
from airhilt.world.surface.path import Local
from airhilt.world.surface.runway import RunwayEnd

TYPES = ("737", "B747", "c172p", "c310")
TICK_S = 0.05
LONGEST_S = 600.0

ELEVATION_M = 4.0
COURSE_RAD = 10.0 * DEGREE
RIGHT_RAD = COURSE_RAD + math.pi / 2.0
LENGTH_M = 3_000.0
THRESHOLD: Place = (38.85 * DEGREE, -77.04 * DEGREE)
RUNWAY = RunwayEnd(
    ident="01",
    start=THRESHOLD,
    threshold=THRESHOLD,
    end=onward(THRESHOLD, COURSE_RAD, LENGTH_M),
    elevation_m=ELEVATION_M,
    width_m=45.0,
    length_m=LENGTH_M,
    displaced_m=0.0,
    course_rad=COURSE_RAD,
)
RUNWAY_FRAME = LocalFrame(THRESHOLD, ELEVATION_M)


def crosswind(from_left_kt: float, turbulence_kt: float = 0.0, severity: int = 0) -> Atmosphere:
    """Return a wind square to the runway, and turbulence."""
    return Atmosphere(
        -from_left_kt * KNOT * math.sin(COURSE_RAD),
        from_left_kt * KNOT * math.cos(COURSE_RAD),
        turbulence_kt * KNOT,
        severity,
    )


WEATHERS = {
    "calm": crosswind(0.0),
    "15 kt left": crosswind(15.0),
    "15 kt right": crosswind(-15.0),
    "turbulence": crosswind(0.0, 15.0, 3),
}

Measurements = dict[str, float]


class Criterion(NamedTuple):
    """A bound of one measurement."""

    measurement: str
    at_most: float = math.inf
    """Infinite for one that is only shown."""


class Procedure(NamedTuple):
    """A procedure: the function that flies it, and its criteria."""

    fly: Callable[[Flight], Measurements]
    criteria: Callable[[AircraftType], tuple[Criterion, ...]]


class Row(NamedTuple):
    """One type in one weather flying one procedure: worst values over the seeds."""

    procedure: str
    type: str
    weather: str
    worst: Measurements
    failed: tuple[str, ...]
    """The measurements that exceed their criteria, or why a flight ended."""

    @property
    def is_failed(self) -> bool:
        """True if a measurement exceeds its criterion, or a flight ended."""
        return bool(self.failed)

    def __str__(self) -> str:
        """Return the line of the table."""
        numbers = "  ".join(f"{name} {value:.1f}" for name, value in self.worst.items())
        verdict = f"FAIL: {', '.join(self.failed)}" if self.failed else "pass"
        return f"{self.procedure:17} {self.type:6} {self.weather:12} {numbers}  {verdict}"


class EndedError(Exception):
    """The flight ended before the procedure did."""


class Flight(NamedTuple):
    """One flight to be flown."""

    kind: AircraftType
    atmosphere: Atmosphere
    seed: int

    def scattered(self, what: str) -> float:
        """Return a number in [-1, 1] that the seed determines."""
        return random.Random(f"{what} {self.seed}").uniform(-1.0, 1.0)

    def begin(self, initial: InitialCondition | OnGround) -> Aircraft:
        """Return the aircraft."""
        return Aircraft(
            self.kind,
            initial,
            seed=self.seed,
            atmosphere=self.atmosphere,
            terrain_elevation_m=ELEVATION_M,
            tick_s=TICK_S,
        )

    def lined_up(self, along_m: float) -> Aircraft:
        """Return the aircraft on the runway: within 1.5 m of its centre line, and a degree."""
        on_line = onward(THRESHOLD, COURSE_RAD, along_m)
        place = onward(on_line, RIGHT_RAD, 1.5 * self.scattered("aside"))
        heading = COURSE_RAD + DEGREE * self.scattered("heading")
        return self.begin(OnGround(*place, heading, lined_up=True))

    def on_final(self, distance_nm: float) -> Aircraft:
        """Return the aircraft on the glide path, within 10 m of the final approach course."""
        distance = distance_nm * NAUTICAL_MILE
        slope = math.tan(RUNWAY.glide_path_rad)
        height = self.kind.dimensions.wheel_height_offset_m
        height += (distance + self.kind.landing.aim_m) * slope
        airspeed = self.kind.speeds.approach_kt * KNOT
        on_line = onward(THRESHOLD, COURSE_RAD, -distance)
        initial = InitialCondition(
            *onward(on_line, RIGHT_RAD, 10.0 * self.scattered("aside")),
            altitude_m=ELEVATION_M + height,
            track_rad=COURSE_RAD,
            calibrated_airspeed_m_s=airspeed,
            vertical_rate_m_s=-airspeed * slope,
            on_approach=True,
        )
        return self.begin(initial)


def states(aircraft: Aircraft, until: str) -> Iterator[AircraftState]:
    """Fly until a phase begins; yield the state after every tick before.

    Raises
    ------
    EndedError
        The flight ends, or lasts too long.
    """
    for _ in range(round(LONGEST_S / TICK_S)):
        aircraft.advance()
        if aircraft.ended is not None:
            raise EndedError(f"{aircraft.ended} in {aircraft.phase}")
        if aircraft.phase == until:
            return
        yield aircraft.state
    raise EndedError(f"still in {aircraft.phase} after {LONGEST_S:.0f} s")


# --- taxi -----------------------------------------------------------------------------------------

TAXI_RADIUS_M = 30.0
TAXI_LEGS_M = (120.0, 140.0, 90.0)
STRAIGHT_FROM_M = 60.0
"""Behind a bend, from where a straight counts as one: the length of the longest aircraft here."""


def taxi(flight: Flight) -> Measurements:
    """Taxi along three straights and the right and the left bend between them, and stop."""
    aircraft = flight.lined_up(0.0)
    track = _taxi_track()
    aircraft.procedures.taxi([_place(point) for point in track])
    radius, (first, second, _) = TAXI_RADIUS_M, TAXI_LEGS_M
    straight = bend = 0.0
    for state in states(aircraft, until="standing"):
        here = x, y = _ahead_and_right(state)
        off = min(_distance(here, a, b) for a, b in itertools.pairwise(track))
        if (
            STRAIGHT_FROM_M < x < first
            or radius + STRAIGHT_FROM_M < y < radius + second
            or x > first + 2.0 * radius + STRAIGHT_FROM_M
        ):
            straight = max(straight, off)
        else:
            bend = max(bend, off)
    off_end = math.dist(_ahead_and_right(aircraft.state), track[-1])
    return {"off_straight_m": straight, "off_bend_m": bend, "off_end_m": off_end}


def taxi_criteria(kind: AircraftType) -> tuple[Criterion, ...]:
    """Return what taxiing is held to; in a bend, the main wheels inside of it need room."""
    return (
        Criterion("off_straight_m", 2.0),
        Criterion("off_bend_m", 2.0 + kind.dimensions.length_m / 20.0),
        Criterion("off_end_m", 2.0),
    )


def _taxi_track() -> list[Local]:
    """Return points of the path, in metres ahead and to the right of the threshold."""
    radius, (first, second, third) = TAXI_RADIUS_M, TAXI_LEGS_M
    angles = [math.pi / 2.0 * step / 16 for step in range(17)]
    right = [(first + radius * math.sin(a), radius * (1.0 - math.cos(a))) for a in angles]
    x, y = right[-1][0], right[-1][1] + second
    left = [(x + radius * (1.0 - math.cos(a)), y + radius * math.sin(a)) for a in angles]
    return [(0.0, 0.0), *right, *left, (left[-1][0] + third, left[-1][1])]


def _place(point: Local) -> Place:
    sin, cos = math.sin(COURSE_RAD), math.cos(COURSE_RAD)
    return RUNWAY_FRAME.to_place(point[0] * sin + point[1] * cos, point[0] * cos - point[1] * sin)


def _ahead_and_right(state: AircraftState) -> Local:
    east, north = RUNWAY_FRAME.to_local((state.latitude_rad, state.longitude_rad))
    sin, cos = math.sin(COURSE_RAD), math.cos(COURSE_RAD)
    return east * sin + north * cos, east * cos - north * sin


def _distance(point: Local, a: Local, b: Local) -> float:
    """Return the distance of a point from the segment between two others."""
    length = math.dist(a, b)
    along = ((point[0] - a[0]) * (b[0] - a[0]) + (point[1] - a[1]) * (b[1] - a[1])) / length
    part = min(max(along / length, 0.0), 1.0)
    return math.dist(point, (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])))


# --- takeoff --------------------------------------------------------------------------------------

BEGINS_M = 60.0
CLIMB_TO_M = 250.0
REJECTED_AT_KT = {"jet": 100.0, "heavy_jet": 100.0, "piston_single": 40.0, "piston_twin": 70.0}
"""100 kt, or what is well below rotation for those that lift off before."""


def takeoff(flight: Flight) -> Measurements:
    """Take off and climb to an altitude."""
    aircraft = flight.lined_up(BEGINS_M)
    aircraft.procedures.take_off(RUNWAY, CLIMB_TO_M)
    line = Final(RUNWAY, flight.kind)
    off = pitch = bank = lost = highest = screen = 0.0
    for state in states(aircraft, until="en_route"):
        if aircraft.on_ground:
            off = max(off, abs(line.cross_track_m(state)))
            pitch = max(pitch, state.pitch_rad)
            bank = max(bank, abs(state.roll_rad))
        if not screen and state.height_agl_m > 35.0 * FOOT:
            screen = line.along_m(state) - BEGINS_M
        highest = max(highest, state.height_agl_m)
        lost = max(lost, highest - state.height_agl_m)
    return {
        "off_centre_ft": off / FOOT,
        "pitch_deg": pitch / DEGREE,
        "bank_deg": bank / DEGREE,
        "height_lost_ft": lost / FOOT,
        "at_35_ft_after_ft": screen / FOOT,
    }


def takeoff_criteria(kind: AircraftType) -> tuple[Criterion, ...]:
    """Return what a takeoff is held to; pitch and bank on the ground must strike neither end."""
    return (
        Criterion("off_centre_ft", 20.0),
        Criterion("pitch_deg", kind.ground.tail_contact_deg),
        Criterion("bank_deg", kind.ground.wing_contact_deg),
        Criterion("height_lost_ft", 10.0),
        Criterion("at_35_ft_after_ft"),
    )


def rejected_takeoff(flight: Flight) -> Measurements:
    """Reject a takeoff, and stop."""
    aircraft = flight.lined_up(BEGINS_M)
    aircraft.procedures.take_off(RUNWAY, CLIMB_TO_M)
    line = Final(RUNWAY, flight.kind)
    speed = REJECTED_AT_KT[flight.kind.category] * KNOT
    off = rejected = 0.0
    for state in states(aircraft, until="standing"):
        off = max(off, abs(line.cross_track_m(state)))
        if aircraft.phase == "takeoff_roll" and state.calibrated_airspeed_m_s >= speed:
            aircraft.procedures.reject_takeoff()
            rejected = line.along_m(state)
    return {
        "stop_ft": (line.along_m(aircraft.state) - rejected) / FOOT,
        "off_centre_ft": off / FOOT,
    }


def rejected_takeoff_criteria(kind: AircraftType) -> tuple[Criterion, ...]:
    """Return what a rejected takeoff is held to."""
    del kind
    return Criterion("stop_ft", 3_000.0), Criterion("off_centre_ft", 20.0)


# --- landing --------------------------------------------------------------------------------------


def landing(flight: Flight) -> Measurements:
    """Land and stop on the runway."""
    aircraft = flight.on_final(4.0)
    aircraft.procedures.land(RUNWAY)
    final = Final(RUNWAY, flight.kind)
    sink = touchdown = off = bounce = 0.0
    for state in states(aircraft, until="standing"):
        if aircraft.phase in {"glide", "flare"}:
            if not aircraft.on_ground:
                sink, touchdown = state.velocity_down_m_s, final.along_m(state)
            continue
        off = max(off, abs(final.cross_track_m(state)))
        bounce = max(bounce, aircraft.main_wheel_height_m)
    return {
        "sink_fpm": sink / FOOT_PER_MINUTE,
        "touchdown_ft": touchdown / FOOT,
        "off_centre_ft": off / FOOT,
        "bounce_ft": bounce / FOOT,
    }


def landing_criteria(kind: AircraftType) -> tuple[Criterion, ...]:
    """Return what a landing is held to; the touchdown zone is 3,000 ft long (FAA glossary)."""
    return (
        Criterion("sink_fpm", 250.0 if "jet" in kind.category else 200.0),
        Criterion("touchdown_ft", 3_000.0),
        Criterion("off_centre_ft", 20.0),
        Criterion("bounce_ft", 2.0),
    )


GO_AROUND_FT = 50.0


def go_around(flight: Flight) -> Measurements:
    """Go around with the wheels at 50 ft."""
    aircraft = flight.on_final(1.0)
    aircraft.procedures.land(RUNWAY)
    lowest, begun = math.inf, 0.0
    for _ in states(aircraft, until="en_route"):
        height = aircraft.main_wheel_height_m / FOOT
        if aircraft.phase in {"glide", "flare"} and height < GO_AROUND_FT:
            aircraft.procedures.go_around(CLIMB_TO_M)
            begun = height
        lowest = min(lowest, height)
    return {"height_lost_ft": begun - lowest}


def go_around_criteria(kind: AircraftType) -> tuple[Criterion, ...]:
    """Return what a go-around is held to: the wheels do not touch."""
    del kind
    return (Criterion("height_lost_ft", GO_AROUND_FT),)


# --- all of them ----------------------------------------------------------------------------------

PROCEDURES = {
    "taxi": Procedure(taxi, taxi_criteria),
    "takeoff": Procedure(takeoff, takeoff_criteria),
    "rejected_takeoff": Procedure(rejected_takeoff, rejected_takeoff_criteria),
    "landing": Procedure(landing, landing_criteria),
    "go_around": Procedure(go_around, go_around_criteria),
}


def measure(procedure: str, name: str, weather: str, seeds: int) -> Row:
    """Fly one procedure with one type in one weather, once for each seed."""
    kind = load_aircraft_type(name)
    fly, criteria = PROCEDURES[procedure]
    bounds = criteria(kind)
    worst = {bound.measurement: -math.inf for bound in bounds}
    failed: dict[str, None] = {}
    for seed in range(1, seeds + 1):
        try:
            measured = fly(Flight(kind, WEATHERS[weather], seed))
        except EndedError as error:
            failed[f"seed {seed} {error}"] = None
            continue
        for bound in bounds:
            value = measured[bound.measurement]
            worst[bound.measurement] = max(worst[bound.measurement], value)
            if not value <= bound.at_most:
                failed[bound.measurement] = None
    return Row(procedure, name, weather, worst, tuple(failed))


def rows(seeds: int, procedures: tuple[str, ...] = tuple(PROCEDURES)) -> Iterator[Row]:
    """Fly everything on all cores; yield the rows of the table in order."""
    jobs = list(itertools.product(procedures, TYPES, WEATHERS))
    with ProcessPoolExecutor() as pool:
        yield from pool.map(measure, *zip(*jobs, strict=True), itertools.repeat(seeds))
