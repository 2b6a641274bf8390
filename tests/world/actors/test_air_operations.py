"""What crews fly when told, with the flight dynamics of their aircraft, at KDCA; or why not."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, cast

import pytest
from pydantic import TypeAdapter

from airhilt.commands import Command
from airhilt.geodesy.positions import GeodeticPosition, RunwayPosition
from airhilt.geodesy.wgs84 import Place, distance_m
from airhilt.scenario.models import AircraftSpec, Reactions
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE, wrap_angle
from airhilt.world.actors.actor import Unable
from airhilt.world.actors.crew import Crew
from airhilt.world.actors.final_approach import FinalApproach
from airhilt.world.flight import Aircraft, Atmosphere, InitialCondition, load_aircraft_type
from airhilt.world.flight.state import OnGround
from airhilt.world.loading import load
from airhilt.world.site import ScenarioSite
from breadth import mostly_slow

COMMAND = TypeAdapter(Command)
CALM = Atmosphere()
WIND = Atmosphere(wind_north_m_s=4.0, wind_east_m_s=-5.0)
LAM = GeodeticPosition(type="geodetic", lat_deg=38.80, lon_deg=-77.00)


@cache
def kdca() -> ScenarioSite:
    return replace(ScenarioSite.of(load("s01a_nominal")), fixes={"LAM": LAM})


@dataclass
class Flight:
    """A crew in an aircraft, and what it has said that it was unable to do."""

    crew: Crew
    aircraft: Aircraft
    said: list[str]

    @property
    def here(self) -> Place:
        state = self.aircraft.state
        return state.latitude_rad, state.longitude_rad

    def tell(self, action: str, **arguments: Any) -> str | None:
        """Give a command; return why it is refused, before anything changes, or None."""
        command = COMMAND.validate_python({"action": action, **arguments})
        before = self.aircraft.phase, self.crew.bound_runway, self.aircraft.target_altitude_m
        why = self.crew.refusal(command)
        after = self.aircraft.phase, self.crew.bound_runway, self.aircraft.target_altitude_m
        assert after == before
        if why is None:
            self.crew.command(command)
        return why

    def fly(self, seconds: float, until: Callable[[Aircraft], bool] = lambda _: False) -> Flight:
        for tick in range(round(seconds * 20)):
            self.aircraft.advance()
            if tick % 4 == 0:
                try:
                    self.crew.attend()
                except Unable as unable:
                    self.said.append(str(unable))
            if until(self.aircraft):
                return self
        return self

    def fly_to(self, *phases: str, within_s: float = 900.0) -> Flight:
        self.fly(within_s, lambda aircraft: aircraft.phase in phases)
        assert self.aircraft.phase in phases
        return self

    def lands_on(self, runway: str) -> None:
        """Fly on to the rollout, which is on that runway."""
        self.fly_to("rollout", within_s=1_500.0)
        final = FinalApproach(kdca().airport, kdca().runway(runway))
        assert abs(final.right_m(self.here)) < 20.0
        assert -1_000.0 < final.before_m(self.here) < 0.0
        assert abs(final.angle_rad(self.aircraft.state.track_rad)) < 10 * DEGREE


def crew_in(aircraft: Aircraft) -> Flight:
    spec = cast(Any, AircraftSpec).model_construct(callsign="AAL1", initial=None, pilot=Reactions())
    return Flight(Crew(spec, aircraft, kdca(), 1), aircraft, [])


def made(kind: str, start: InitialCondition | OnGround, air: Atmosphere) -> Flight:
    elevation_m = kdca().ground_m
    return crew_in(
        Aircraft(
            load_aircraft_type(kind), start, seed=1, atmosphere=air, terrain_elevation_m=elevation_m
        )
    )


def on_final(kind: str, before_nm: float, *, air: Atmosphere = CALM) -> Flight:
    """Return a flight on the glide path of runway 01."""
    runway, of = kdca().runway("01"), load_aircraft_type(kind)
    away_m = before_nm * NAUTICAL_MILE
    slope = math.tan(runway.glide_path_rad)
    speed = of.speeds.approach_kt * KNOT
    place = kdca().place(RunwayPosition(type="runway", runway="01", along_m=-away_m))
    wheels_m = kdca().ground_m + of.dimensions.wheel_height_offset_m
    start = InitialCondition(
        *place,
        altitude_m=wheels_m + (away_m + of.landing.aim_m) * slope,
        track_rad=runway.course_rad,
        calibrated_airspeed_m_s=speed,
        vertical_rate_m_s=-speed * slope,
        on_approach=True,
    )
    flight = made(kind, start, air)
    flight.crew.runway_operations.begin_on_final("01")
    return flight


def en_route(
    kind: str, *, before_nm: float = 8.0, right_m: float = -4_000.0, altitude_ft: float = 2_500.0,
    turned_deg: float = 40.0, air: Atmosphere = CALM,
) -> Flight:  # fmt: skip
    """Return a flight towards runway 01, so far before it and to the right, off its course."""
    of, runway = load_aircraft_type(kind), kdca().runway("01")
    place = RunwayPosition(
        type="runway", runway="01", along_m=-before_nm * NAUTICAL_MILE, offset_m=right_m
    )
    start = InitialCondition(
        *kdca().place(place),
        altitude_m=altitude_ft * FOOT,
        track_rad=runway.course_rad + turned_deg * DEGREE,
        calibrated_airspeed_m_s=1.05 * of.speeds.minimum_clean_kt * KNOT,
    )
    return made(kind, start, air)


def on_runway(kind: str) -> Flight:
    runway = kdca().runway("01")
    place = kdca().place(RunwayPosition(type="runway", runway="01", along_m=40.0))
    flight = made(kind, OnGround(*place, runway.course_rad, lined_up=True), Atmosphere())
    flight.crew.runway_operations.bind("01")
    return flight


def told(flight: Flight, action: str, **arguments: Any) -> Flight:
    assert flight.tell(action, **arguments) is None
    return flight


PHASES: dict[str, Callable[[str], Flight]] = {
    "lined_up": on_runway,
    "takeoff_roll": lambda kind: told(on_runway(kind), "take_off", runway="01").fly(8.0),
    "climb_out": lambda kind: told(on_runway(kind), "take_off", runway="01").fly_to("climb_out"),
    "en_route": en_route,
    "approach": lambda kind: told(en_route(kind), "join", leg="downwind", runway="01").fly(5.0),
    "orbit": lambda kind: told(on_final(kind, 4.0), "orbit").fly(5.0),
    "glide": lambda kind: on_final(kind, 4.0).fly(1.0),
    "short_final": lambda kind: told(on_final(kind, 1.0), "land", runway="01").fly(1.0),
    "flare": lambda kind: told(on_final(kind, 0.5), "land", runway="01").fly_to("flare").fly(0.5),
    "rollout": lambda kind: told(on_final(kind, 0.5), "land", runway="01").fly_to("rollout"),
    "go_around": lambda kind: told(on_final(kind, 1.0), "go_around").fly(1.0),
    "emergency_descent": lambda kind: told(
        en_route(kind, altitude_ft=9_000.0), "emergency_descent", altitude_ft=3_000.0
    ).fly(1.0),
    "drift_down": lambda kind: told(en_route(kind, altitude_ft=9_000.0), "drift_down").fly(1.0),
}
COMMANDS: tuple[dict[str, Any], ...] = (
    {"action": "altitude", "altitude_ft": 3_000.0},
    {"action": "altitude", "altitude_ft": 60_000.0},
    {"action": "track", "track_deg": 90.0},
    {"action": "turn", "degrees": -30.0},
    {"action": "speed", "cas_kt": 110.0},
    {"action": "mach", "mach": 0.3},
    {"action": "mach", "mach": 3.0},
    {"action": "resume_speed"},
    {"action": "vertical_rate", "vertical_rate_fpm": 500.0},
    {"action": "cross_fix", "fix": "LAM", "altitude_ft": 3_000.0},
    {"action": "route", "route": [LAM.model_dump()]},
    {"action": "resume_route"},
    {"action": "direct", "to": "LAM"},
    {"action": "direct", "to": "the field"},
    {"action": "direct", "to": "nowhere"},
    {"action": "orbit", "turn": "left"},
    {"action": "hold_at", "fix": "LAM"},
    {"action": "land", "runway": "01"},
    {"action": "land", "runway": "33"},
    {"action": "land", "runway": "09"},
    {"action": "land", "runway": "01", "then": "touch_and_go"},
    {"action": "land", "runway": "01", "then": "stop_and_go"},
    {"action": "land", "runway": "01", "then": "low_approach"},
    {"action": "go_around"},
    {"action": "side_step", "runway": "04"},
    {"action": "approach", "runway": "01", "kind": "straight_in"},
    {"action": "approach", "runway": "33", "kind": "circling"},
    {"action": "approach", "runway": "19", "kind": "visual"},
    {"action": "join", "leg": "base", "runway": "01", "side": "right"},
    {"action": "extend", "leg": "downwind"},
    {"action": "short_approach"},
    {"action": "return_to_field"},
    {"action": "drift_down"},
    {"action": "emergency_descent", "altitude_ft": 2_000.0},
)


@pytest.mark.parametrize("phase", mostly_slow(PHASES, "glide", "takeoff_roll"))
def test_in_every_phase_a_command_is_refused_in_words_or_begun_and_flown_safely(
    phase: str, subtests: pytest.Subtests
) -> None:
    for given in COMMANDS:
        with subtests.test(str(given)):
            flight = PHASES[phase]("737")
            why = flight.tell(**given)
            if why is not None:
                assert why.startswith("unable")
                assert "expected" not in why
                continue
            flight.fly(40.0)
            assert flight.aircraft.ended is None


@pytest.mark.parametrize("phase", ["lined_up", "takeoff_roll"])
def test_on_the_ground_nothing_is_done_that_belongs_in_the_air(phase: str) -> None:
    flight = PHASES[phase]("737")
    for given in COMMANDS:
        assert flight.tell(**given) in ("unable, on the ground", "unable, taking off")


def test_in_an_emergency_descent_a_crew_goes_its_way_down_first() -> None:
    flight = PHASES["emergency_descent"]("737")
    for given in ({"action": "orbit"}, {"action": "land", "runway": "01"}, {"action": "go_around"},
                  {"action": "altitude", "altitude_ft": 12_000.0}):  # fmt: skip
        assert flight.tell(**given) == "unable, emergency descent"
    assert flight.tell("track", track_deg=90.0) is None


# --- to another runway ------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["737", "c172p"])
@pytest.mark.parametrize("runway", mostly_slow(["33", "19", "04"], "33"))
def test_cleared_to_land_on_another_runway_it_lands_on_that_one(kind: str, runway: str) -> None:
    flight = on_final(kind, 5.0, air=WIND)
    assert flight.tell("approach", runway=runway, kind="circling") is None
    assert flight.tell("land", runway=runway) is None
    flight.lands_on(runway)


def test_an_approach_is_no_clearance_to_land_nor_is_that_for_another_runway() -> None:
    flight = told(on_final("737", 5.0), "land", runway="01")
    told(flight, "approach", runway="33", kind="circling").fly_to("go_around")
    assert flight.said == ["unable, no clearance to land: going around"]
    assert 150 * FOOT < flight.aircraft.state.height_agl_m < 200 * FOOT


def test_too_low_or_too_close_to_turn_it_refuses_and_lands_where_it_was_going() -> None:
    flight = told(on_final("737", 1.2), "land", runway="01")
    assert flight.tell("land", runway="33") == "unable, too low to turn to runway 33"
    close = told(on_final("737", 1.8), "land", runway="01")
    assert close.tell("land", runway="33") == "unable, too close to turn to runway 33"
    flight.lands_on("01")


def test_wings_are_level_on_the_final_course_at_300_ft_after_circling() -> None:
    flight = told(told(on_final("737", 5.0), "land", runway="33"), "land", runway="33")
    flight.fly(600.0, lambda aircraft: aircraft.state.height_agl_m < 290 * FOOT)
    final = FinalApproach(kdca().airport, kdca().runway("33"))
    assert abs(final.right_m(flight.here)) < 30.0
    assert abs(final.angle_rad(flight.aircraft.state.track_rad)) < 5 * DEGREE


@pytest.mark.parametrize("seed", mostly_slow(range(8), 0, 1))
def test_from_wherever_it_flies_it_lands_where_it_is_cleared_or_refuses(seed: int) -> None:
    draw = random.Random(seed)
    kind, runway = draw.choice(["737", "B747", "c172p"]), draw.choice(["01", "19", "33", "15"])
    flight = en_route(
        kind,
        before_nm=draw.uniform(-6.0, 10.0),
        right_m=draw.uniform(-10_000.0, 10_000.0),
        altitude_ft=draw.choice([900.0, 1_500.0, 3_000.0]),
        turned_deg=draw.uniform(-180.0, 180.0),
    )
    why = flight.tell("land", runway=runway)
    if why is None:
        flight.lands_on(runway)
        assert flight.said == []
    else:
        assert why.startswith("unable, too")


# --- the circuit ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "leg", mostly_slow(["upwind", "crosswind", "downwind", "base", "final"], "downwind")
)
@pytest.mark.parametrize("kind", ["737", "c172p"])
def test_it_joins_a_leg_of_the_circuit_and_lands(kind: str, leg: str) -> None:
    flight = told(en_route(kind, before_nm=5.0, altitude_ft=1_800.0, air=WIND), "join",
                  leg=leg, runway="01", side="right")  # fmt: skip
    assert flight.tell("land", runway="01") is None
    flight.lands_on("01")


def test_an_extended_downwind_goes_on_until_the_turn_to_base_is_told() -> None:
    flight = en_route("c172p", before_nm=0.0, right_m=-2_500.0, altitude_ft=1_000, turned_deg=180)
    told(flight, "join", leg="downwind", runway="01").fly(40.0)
    told(told(flight, "extend"), "land", runway="01").fly(180.0)
    final = FinalApproach(kdca().airport, kdca().runway("01"))
    assert final.before_m(flight.here) > 5_000.0
    assert abs(wrap_angle(final.angle_rad(flight.aircraft.state.track_rad) - math.pi)) < 0.1
    told(flight, "join", leg="base", runway="01").lands_on("01")


@pytest.mark.parametrize("extended_s", mostly_slow([30.0, 60.0, 90.0, 150.0], 60.0))
def test_however_long_the_downwind_is_it_turns_base_when_told(extended_s: float) -> None:
    flight = en_route("c172p", before_nm=-0.8, right_m=-1_900.0, altitude_ft=1_000, turned_deg=180)
    told(flight, "join", leg="downwind", runway="01", side="left").fly(4.0)
    told(flight, "extend").fly(extended_s)
    told(told(flight, "join", leg="base", runway="01"), "land", runway="01").lands_on("01")


def test_a_short_approach_is_shorter() -> None:
    def seconds(*action: str) -> float:
        flight = en_route(
            "c172p", before_nm=0.0, right_m=-2_000.0, altitude_ft=1_000, turned_deg=180
        )
        told(told(flight, "join", leg="downwind", runway="01"), "land", runway="01").fly(10.0)
        for each in action:
            told(flight, each)
        ticks = 0
        while flight.aircraft.phase != "rollout":
            flight.fly(0.25)
            ticks += 1
        flight.lands_on("01")
        return 0.25 * ticks

    assert seconds("short_approach") < seconds() - 20.0


def test_what_is_not_flown_is_not_extended_nor_shortened() -> None:
    flight = en_route("737")
    assert flight.tell("extend") == "unable, not in the circuit"
    assert flight.tell("short_approach") == "unable, not in the circuit"


def test_from_far_away_it_returns_to_the_field() -> None:
    flight = en_route("737", before_nm=24.0, altitude_ft=7_000.0, turned_deg=90.0)
    told(flight, "return_to_field").fly_to("approach")
    runway = flight.crew.bound_runway
    assert runway is not None
    told(flight, "land", runway=runway).lands_on(runway)


# --- around again -----------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["737", "c172p"])
@pytest.mark.parametrize("wheels_ft", [200, 30, 5])
def test_it_goes_around_from_the_flare_too(kind: str, wheels_ft: int) -> None:
    flight = told(on_final(kind, 0.8), "land", runway="01")
    flight.fly(120, lambda aircraft: aircraft.main_wheel_height_m < wheels_ft * FOOT)
    told(flight, "go_around").fly(60.0)
    assert flight.aircraft.ended is None
    assert flight.aircraft.state.altitude_m > 400 * FOOT
    assert flight.crew.bound_runway is None


def test_just_after_touchdown_it_takes_off_again_and_later_it_refuses() -> None:
    flight = PHASES["rollout"]("737")
    late = PHASES["rollout"]("737").fly(12.0)
    told(flight, "go_around").fly_to("climb_out")
    assert late.tell("go_around") == "unable, already on the runway"


@pytest.mark.parametrize("then", ["touch_and_go", "stop_and_go", "low_approach"])
def test_it_flies_again_after_the_runway(then: str) -> None:
    flight = told(on_final("c172p", 0.6), "land", runway="01", then=then)
    touched, stopped = [], []

    def is_away(aircraft: Aircraft) -> bool:
        touched.append(aircraft.on_ground)
        stopped.append(aircraft.on_ground and aircraft.state.ground_speed_m_s < 1.0)
        return aircraft.phase in ("climb_out", "go_around")

    flight.fly(200.0, is_away)
    assert (any(touched), any(stopped)) == (then != "low_approach", then == "stop_and_go")
    flight.fly(60.0)
    assert flight.aircraft.state.altitude_m > 300 * FOOT
    assert flight.said == []


def test_a_runway_that_is_too_short_to_stop_and_go_on_is_refused() -> None:
    why = on_final("B747", 4.0).tell("land", runway="01", then="stop_and_go")
    assert why == "unable, runway 01 is too short for us"


# --- orbits, fixes, holds ---------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["737", "c172p"])
@pytest.mark.parametrize("begin", [en_route, lambda kind, air: on_final(kind, 4.0, air=air)])
def test_an_orbit_ends_where_it_began_and_goes_on_as_before(
    kind: str, begin: Callable[..., Flight]
) -> None:
    flight = begin(kind, air=WIND)
    track, place, altitude_m = (
        flight.aircraft.state.track_rad, flight.here, flight.aircraft.state.altitude_m,
    )  # fmt: skip
    told(flight, "orbit", turn="left").fly(60.0)
    steepest = 0.0

    def is_back(aircraft: Aircraft) -> bool:
        nonlocal steepest
        steepest = max(steepest, abs(aircraft.state.roll_rad))
        turned = abs(wrap_angle(aircraft.state.track_rad - track))
        return distance_m(flight.here, place) < 100.0 and turned < 10 * DEGREE

    flight.fly(240.0, is_back)
    assert is_back(flight.aircraft)
    assert steepest < 30 * DEGREE
    assert flight.aircraft.state.altitude_m == pytest.approx(altitude_m, abs=30.0)
    flight.fly(5.0)
    assert abs(wrap_angle(flight.aircraft.state.track_rad - track)) < 10 * DEGREE


def test_it_flies_over_the_fix_and_on_along_its_route() -> None:
    flight, lam = en_route("737"), kdca().place(LAM)
    beyond = kdca().place(GeodeticPosition(type="geodetic", lat_deg=38.84, lon_deg=-76.87))
    flight.crew.fly_route([kdca().runway("19").threshold, lam, beyond])
    told(told(flight, "track", track_deg=270.0).fly(20.0), "direct", to="lam")
    nearest = [math.inf, math.inf]

    def note(_: Aircraft) -> bool:
        for index, place in enumerate((lam, beyond)):
            nearest[index] = min(nearest[index], distance_m(flight.here, place))
        return False

    flight.fly(420.0, note)
    assert max(nearest) < 0.5 * NAUTICAL_MILE


def test_a_fix_that_nobody_knows_is_refused() -> None:
    for action, key in (("direct", "to"), ("hold_at", "fix")):
        why = en_route("737").tell(action, **{key: "ALPHA"})
        assert why == "unable, we do not have ALPHA, say heading"


def test_it_holds_at_the_fix_until_it_gets_another_heading() -> None:
    flight, lam = told(en_route("c172p", air=WIND), "hold_at", fix="LAM"), kdca().place(LAM)
    passed, was_near = 0, False
    for _ in range(1_500):
        flight.fly(1.0)
        is_near = distance_m(flight.here, lam) < 0.1 * NAUTICAL_MILE
        passed += is_near and not was_near
        was_near = is_near
    assert passed >= 3
    told(flight, "track", track_deg=90.0).fly(120.0)
    assert flight.aircraft.state.track_rad == pytest.approx(math.pi / 2.0, abs=0.05)


def test_a_level_is_reached_at_the_fix_or_refused() -> None:
    flight = told(en_route("737", before_nm=12.0, turned_deg=10.0), "direct", to="LAM")
    assert flight.tell("cross_fix", fix="LAM", altitude_ft=30_000.0) == "unable 30000 ft by LAM"
    told(flight, "cross_fix", fix="LAM", altitude_ft=4_000.0)
    lam = kdca().place(LAM)
    flight.fly(300.0, lambda _: distance_m(flight.here, lam) < 0.3 * NAUTICAL_MILE)
    assert flight.aircraft.state.altitude_m == pytest.approx(4_000 * FOOT, abs=50.0)


@pytest.mark.parametrize(
    ("bound", "told_ft", "over_ft", "then_ft"),
    [
        ("or_more", 4_000.0, 6_000.0, 4_000.0),
        (None, 4_000.0, 6_000.0, 4_000.0),
        (None, None, 6_000.0, 6_000.0),
        ("or_more", None, 8_000.0, 8_000.0),
        ("or_less", None, 6_000.0, 6_000.0),
        ("or_less", 4_000.0, None, 4_000.0),
    ],
)
def test_beyond_a_fix_it_goes_on_to_the_level_that_was_told(
    bound: str | None, told_ft: float | None, over_ft: float | None, then_ft: float
) -> None:
    flight = told(en_route("737", before_nm=16.0, altitude_ft=8_000.0), "direct", to="LAM")
    if told_ft is not None:
        told(flight, "altitude", altitude_ft=told_ft)
    told(flight, "cross_fix", fix="LAM", altitude_ft=6_000.0, bound=bound)
    lam = kdca().place(LAM)
    flight.fly(400.0, lambda _: distance_m(flight.here, lam) < 0.4 * NAUTICAL_MILE)
    over_m = flight.aircraft.state.altitude_m
    assert over_m < 6_050 * FOOT if over_ft is None else abs(over_m - over_ft * FOOT) < 50.0
    flight.fly(120.0)
    assert flight.aircraft.state.altitude_m == pytest.approx(then_ft * FOOT, abs=30.0)


@pytest.mark.parametrize("action", ["approach", "land", "join"])
def test_a_level_with_an_approach_is_kept_until_the_final_approach(action: str) -> None:
    leg = {"leg": "final"} if action == "join" else {}
    flight = en_route("737", before_nm=14.0, right_m=-3_000.0, altitude_ft=3_000.0)
    assert flight.tell(action, runway="01", level_ft=8_000.0, **leg).startswith("unable 8000 ft")
    told(flight, "altitude", altitude_ft=2_000.0)
    told(flight, action, runway="01", level_ft=2_000.0, **leg)
    lowest_m = math.inf

    def note(aircraft: Aircraft) -> bool:
        nonlocal lowest_m
        lowest_m = min(lowest_m, aircraft.state.altitude_m)
        final = FinalApproach(kdca().airport, kdca().runway("01"))
        return abs(final.right_m(flight.here)) < 60.0

    flight.fly(600.0, note)
    assert lowest_m == pytest.approx(2_000 * FOOT, abs=30.0)


def test_a_heading_to_the_final_course_is_flown_until_it_is_met() -> None:
    flight = en_route("737", before_nm=14.0, right_m=-4_000.0, altitude_ft=2_000.0, turned_deg=30.0)
    track_rad = flight.aircraft.state.track_rad
    told(flight, "approach", runway="01", level_ft=2_000.0).fly(60.0)
    assert flight.aircraft.state.track_rad == pytest.approx(track_rad, abs=0.02)
    told(flight, "land", runway="01").lands_on("01")


def test_without_its_clearance_it_goes_on_with_the_approach_and_goes_around_at_its_minimum() -> (
    None
):
    flight = told(told(on_final("737", 2.5), "land", runway="01"), "cancel_landing").fly(5.0)
    assert flight.aircraft.phase == "glide"
    flight.fly_to("go_around")
    assert flight.said == ["unable, no clearance to land: going around"]
    assert on_final("737", 4.0).tell("cancel_landing") == "unable, not cleared to land"


def test_a_side_step_to_the_other_end_is_refused() -> None:
    why = on_final("737", 5.0).tell("side_step", runway="19")
    assert why == "unable, runway 19 is no side step from 01"


def test_another_heading_ends_an_approach_and_its_clearance() -> None:
    flight = told(on_final("737", 5.0), "land", runway="01")
    told(flight, "track", track_deg=300.0).fly(5.0)
    assert (flight.aircraft.phase, flight.crew.bound_runway) == ("en_route", None)


def test_flaps_let_it_fly_slower_on_final_until_it_slows_down_to_land() -> None:
    flight = told(on_final("737", 5.5), "land", runway="01").fly(1.0)
    assert flight.tell("speed", cas_kt=210.0) == "unable 210 kt, maximum 186 kt"
    assert flight.tell("speed", cas_kt=120.0) == "unable 120 kt, minimum 143 kt"
    told(flight, "speed", cas_kt=165.0).fly(25.0)
    assert flight.aircraft.state.calibrated_airspeed_m_s == pytest.approx(165 * KNOT, abs=4.0)
    flight.lands_on("01")


def test_flaps_are_lowered_early_for_a_speed_that_is_too_slow_without_them() -> None:
    flight = told(en_route("737", before_nm=12.0, right_m=0.0, turned_deg=0.0), "land", runway="01")
    told(flight, "speed", cas_kt=165.0).fly(60.0)
    assert flight.aircraft.state.calibrated_airspeed_m_s == pytest.approx(165 * KNOT, abs=4.0)
    told(flight, "resume_speed").fly(60.0)
    assert flight.aircraft.state.calibrated_airspeed_m_s == pytest.approx(143 * KNOT, abs=4.0)


def test_a_speed_is_flown_on_the_approach_until_the_landing_is_prepared() -> None:
    flight = told(en_route("737", before_nm=12.0, right_m=0.0, turned_deg=0.0), "land", runway="01")
    assert flight.tell("speed", cas_kt=220.0) is None
    flight.fly(60.0)
    assert flight.aircraft.phase == "glide"
    assert flight.aircraft.state.calibrated_airspeed_m_s == pytest.approx(220 * KNOT, abs=3.0)
    assert on_final("737", 3.0).fly(1.0).tell("speed", cas_kt=160.0) == "unable, at approach speed"
