"""Conditions on the true state, each when it is true and when it is not."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, cast

import pytest
from pydantic import TypeAdapter

from airhilt.errors import ScenarioError
from airhilt.scenario.models import Condition
from airhilt.units import SECOND_NS
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.layout import Layout
from airhilt.world.truth.conditions import ConditionCompiler
from airhilt.world.truth.runways import RunwayMonitor
from straight import EARTH_RADIUS_M, Performing, Rolling, Straight, Watch


class Fixes:
    """A place with one fix, 20 km east of where aircraft begin."""

    def fix(self, name: str) -> tuple[float, float] | None:
        return (0.0, 20_000.0 / EARTH_RADIUS_M) if name == "LAM" else None


SITE = cast(Any, Fixes())


class Case:
    """A condition on two aircraft, A and B, that meet after a minute if nobody says otherwise."""

    def __init__(self, condition: dict[Any, Any], *aircraft: Rolling | Straight) -> None:
        pair = aircraft or (
            Straight(-15_000.0, east_m_s=250.0),
            Straight(15_000.0, east_m_s=-250.0),
        )
        self.watch = Watch(*pair, names=("AA", "BB"))
        self.begun_lines: set[str] = set()
        self.ended_lines: set[str] = set()
        self.actors = {name: Performing(body) for name, body in self.watch.aircraft.items()}
        compiler = ConditionCompiler(
            cast(Any, self.actors),
            self.watch.monitor,
            None,
            self.begun_lines,
            self.ended_lines,
            SITE,
        )
        self.test = compiler.compile(TypeAdapter(Condition).validate_python(condition))

    def __call__(self) -> bool:
        return self.test(self.watch.now_ns)

    def after(self, seconds: float) -> bool:
        for craft in self.watch.aircraft.values():
            craft.advance(seconds)
        self.watch.now_ns += round(seconds * SECOND_NS)
        return self()

    def end(self, callsign: str = "AA") -> None:
        self.watch.aircraft[callsign].ended = "ground_contact"


PAIR = ["AA", "BB"]


def test_time_is_reached_from_then_on() -> None:
    case = Case({"type": "time", "at_s": 10.0})
    seen = [case(), case.after(9.9), case.after(0.1), case.after(50.0)]
    assert seen == [False, False, True, True]


def test_a_line_begins_before_it_ends() -> None:
    begun = Case({"type": "line_begun", "line": "readback"})
    ended = Case({"type": "line_ended", "line": "readback"})
    for case in (begun, ended):
        case.begun_lines.add("readback")
        case.ended_lines.add("clearance")
    assert begun()
    assert not ended()
    ended.ended_lines.add("readback")
    assert ended()


def test_separation_is_below_both_distances_at_once() -> None:
    def below(**second: Any) -> bool:
        condition = {"type": "separation_below", "actors": PAIR, "horizontal_nm": 5.0,
                     "vertical_ft": 1000.0}  # fmt: skip
        return Case(condition, Straight(), Straight(**second))()

    assert below(east_m=9_000.0, altitude_ft=35_900.0)
    assert not below(east_m=9_500.0)
    assert not below(altitude_ft=36_100.0)


def test_a_loss_is_predicted_within_just_the_time_that_it_takes() -> None:
    condition = {"type": "predicted_loss_of_separation", "actors": PAIR}
    loss_s = Case(condition).watch.monitor.time_to_loss_s(("AA", "BB"))
    assert loss_s is not None
    assert Case(condition | {"within_s": loss_s})()
    assert not Case(condition | {"within_s": math.nextafter(loss_s, 0.0)})()


def test_a_loss_is_predicted_however_far_ahead_where_no_time_is_given() -> None:
    far = (Straight(-400_000.0, east_m_s=250.0), Straight(400_000.0, east_m_s=-250.0))
    condition = {"type": "predicted_loss_of_separation", "actors": PAIR}
    assert Case(condition, *far)()
    assert not Case(condition | {"within_s": 1200.0}, *far)()


def test_no_loss_is_predicted_of_two_that_have_passed_or_keep_apart() -> None:
    condition = {"type": "predicted_loss_of_separation", "actors": PAIR, "within_s": 1200.0}
    apart = (Straight(-15_000.0, east_m_s=-250.0), Straight(15_000.0, east_m_s=250.0))
    assert not Case(condition, *apart)()
    above = (Straight(-15_000.0, east_m_s=250.0), Straight(15_000.0, altitude_ft=37_000.0))
    assert not Case(condition, *above)()


def test_a_closest_approach_has_passed_when_the_two_have_drawn_apart_for_a_while() -> None:
    case = Case({"type": "closest_approach_passed", "actors": PAIR, "for_s": 20.0})
    assert not case()
    assert not case.after(59.0)
    assert not case.after(2.0)
    assert not case.after(19.0)
    assert case.after(1.1)


def test_drawing_apart_must_not_be_broken_off() -> None:
    case = Case({"type": "closest_approach_passed", "actors": PAIR, "for_s": 20.0})
    case.after(61.0)
    case.after(15.0)
    for craft in case.watch.aircraft.values():
        craft.state = craft.state._replace(velocity_east_m_s=-craft.state.velocity_east_m_s)
    assert not case.after(1.0)
    assert not case.after(30.0)
    assert not case.after(10.0)


def test_bound_for_an_altitude_is_where_an_aircraft_flies_to_and_not_where_it_is(
    subtests: pytest.Subtests,
) -> None:
    table = [(31_000, 35_000, True), (31_000, 35_040, True), (31_000, 35_060, False),
     (35_000, 31_000, False), (35_000, None, True)]  # fmt: skip
    for altitude_ft, target_ft, true in table:
        with subtests.test(str((altitude_ft, target_ft, true))):
            condition = {"type": "bound_for_altitude", "actor": "AA", "altitude_ft": 35_000}
            first = Straight(altitude_ft=altitude_ft, target_ft=target_ft)
            assert Case(condition, first, Straight())() == true


@pytest.mark.parametrize(
    "condition",
    [
        {"type": "threshold_within", "actor": "AA", "runway": "01", "within_s": 1200.0},
        {"type": "bound_for_runway", "actor": "AA", "runway": "01"},
        {"type": "on_runway", "actor": "AA", "runway": "01"},
    ],
    ids=lambda condition: condition["type"],
)
def test_where_there_is_no_airport_nothing_is_true_of_its_runways(
    condition: dict[Any, Any],
) -> None:
    assert not Case(condition)()


LATE, EARLY = {"type": "time", "at_s": 20.0}, {"type": "time", "at_s": 10.0}


def test_all_of_them_are_true_when_the_last_is_and_any_of_them_when_the_first_is() -> None:
    everything = Case({"type": "all_of", "conditions": [EARLY, LATE]})
    anything = Case({"type": "any_of", "conditions": [LATE, EARLY]})
    assert [everything(), everything.after(10.0), everything.after(10.0)] == [False, False, True]
    assert [anything(), anything.after(10.0), anything.after(10.0)] == [False, True, True]


def test_a_condition_that_keeps_time_keeps_it_while_another_is_not_yet_true() -> None:
    passed = {"type": "closest_approach_passed", "actors": PAIR, "for_s": 20.0}
    case = Case({"type": "all_of", "conditions": [{"type": "time", "at_s": 90.0}, passed]})
    for _ in range(89):
        assert not case.after(1.0)
    assert case.after(1.0)


# --- at an airport --------------------------------------------------------------------------


class Airport(Case):
    """A condition on an aircraft on final approach to runway 01 at KDCA, and a car on it."""

    def __init__(
        self,
        condition: dict[Any, Any],
        along_m: float = -3_000.0,
        speed: float = 72.0,
        car_along_m: float = 800.0,
        **aircraft: Any,
    ) -> None:
        layout = Layout(load_airport("KDCA"))
        end = layout.runway("01")
        east, north = layout.local_frame.to_local(end.threshold)
        sin, cos = math.sin(end.course_rad), math.cos(end.course_rad)

        def at(body: Rolling | Straight, along: float) -> Rolling | Straight:
            place = layout.local_frame.to_place(east + along * sin, north + along * cos)
            body.state = body.state._replace(latitude_rad=place[0], longitude_rad=place[1])
            return body

        flown: dict[str, Any] = {"altitude_ft": 500.0, "phase": "glide"} | aircraft
        plane = Straight(east_m_s=speed * sin, north_m_s=speed * cos, **flown)
        super().__init__(condition, at(plane, along_m), at(Rolling(), car_along_m))
        self.actors["AA"].bound_runway = "01"
        self.actors["BB"].category = "vehicle"
        nothing = lambda *_: None  # noqa: E731
        self.runways = RunwayMonitor(layout, cast(Any, self.actors), set(), set(), nothing, nothing)
        compiler = ConditionCompiler(
            cast(Any, self.actors), self.watch.monitor, self.runways, set(), set(), SITE
        )
        self.test = compiler.compile(TypeAdapter(Condition).validate_python(condition))

    def __call__(self) -> bool:
        self.runways.tick(self.watch.now_ns)
        return super().__call__()


@pytest.mark.parametrize(("phases", "true"), [(["glide"], True), (["flare", "rollout"], False),
                                              (["flare", "glide"], True)])  # fmt: skip
def test_an_actor_is_in_one_of_some_phases(phases: list[str], true: bool) -> None:
    assert Airport({"type": "in_phase", "actor": "AA", "phases": phases})() == true


@pytest.mark.parametrize(("runway", "true"), [("01", True), ("1", True), ("19", False)])
def test_bound_for_a_runway_is_in_which_direction_a_crew_means_to_use_it(
    runway: str, true: bool
) -> None:
    assert Airport({"type": "bound_for_runway", "actor": "AA", "runway": runway})() == true


def test_an_actor_is_on_a_runway_in_both_directions_and_only_on_the_ground() -> None:
    def on(actor: str, runway: str, **case: Any) -> bool:
        return Airport({"type": "on_runway", "actor": actor, "runway": runway}, **case)()

    assert on("BB", "01")
    assert on("BB", "19")
    assert not on("BB", "33")
    assert not on("BB", "01", car_along_m=-400.0)
    assert not on("AA", "01", along_m=500.0)
    assert on("AA", "01", along_m=500.0, on_ground=True, altitude_ft=0.0)


def test_an_actor_is_off_the_runways_on_the_ground_or_only_after_it_was_on_one() -> None:
    def off(actor: str, **case: Any) -> bool:
        return Airport({"type": "off_runways", "actor": actor}, **case)()

    assert off("BB", car_along_m=-400.0)
    assert not off("BB")
    assert not off("AA", along_m=-3000.0)
    only_after = {"type": "off_runways", "actor": "BB", "has_been_on": True}
    assert not Airport(only_after, car_along_m=-400.0)()
    leaves = Airport(only_after)
    assert not leaves()
    leaves.watch.aircraft["BB"].state = (
        Airport(only_after, car_along_m=-400.0).watch.aircraft["BB"].state
    )
    assert leaves()


@pytest.mark.parametrize(
    ("leg", "within_nm", "true"),
    [("final", None, True), ("final", 1.7, True), ("final", 1.5, False), ("base", None, False)],
)
def test_an_arrival_is_on_final_within_a_distance_of_its_threshold(
    leg: str, within_nm: float | None, true: bool
) -> None:
    """3000 m before it, which is 1.62 NM."""
    condition = {"type": "on_leg", "actor": "AA", "leg": leg, "within_nm": within_nm}
    assert Airport(condition)() == true


@pytest.mark.parametrize(
    ("turned_deg", "leg"), [(90.0, "base"), (-90.0, "base"), (180.0, "downwind")]
)
def test_a_leg_is_told_by_the_track_against_the_runway(turned_deg: float, leg: str) -> None:
    arrival = Airport({"type": "on_leg", "actor": "AA", "leg": leg})
    plane = arrival.watch.aircraft["AA"]
    track = plane.state.track_rad + math.radians(turned_deg)
    plane.state = plane.state._replace(
        velocity_east_m_s=72.0 * math.sin(track), velocity_north_m_s=72.0 * math.cos(track)
    )
    assert arrival()


def test_the_threshold_is_within_a_time_of_an_arrival(subtests: pytest.Subtests) -> None:
    """3000 m away at 72 m/s."""
    for runway, within_s, true in [
        ("01", 41.0, False),
        ("01", 42.0, True),
        ("1", 42.0, True),
        ("19", 1200.0, False),
    ]:
        with subtests.test(str((runway, within_s, true))):
            condition = {"type": "threshold_within", "actor": "AA"}
            assert Airport(condition | {"runway": runway, "within_s": within_s})() == true


def test_the_threshold_is_no_matter_of_who_has_passed_it_or_stands_or_has_landed() -> None:
    condition = {"type": "threshold_within", "actor": "AA", "runway": "01", "within_s": 1200.0}
    assert not Airport(condition, along_m=10.0)()
    assert not Airport(condition, speed=0.5)()
    assert not Airport(condition, on_ground=True)()
    assert not Airport({**condition, "actor": "BB"}, car_along_m=-900.0)()


def test_a_speed_is_above_a_value_over_the_ground() -> None:
    condition = {"type": "speed_above", "actor": "AA"}
    assert Airport({**condition, "speed_kt": 139.0})()
    assert not Airport({**condition, "speed_kt": 141.0})()


def test_a_height_is_below_a_value_above_the_ground() -> None:
    condition = {"type": "height_below", "actor": "AA"}
    assert Airport({**condition, "height_ft": 501.0})()
    assert not Airport({**condition, "height_ft": 499.0})()


def test_a_distance_is_below_a_value_whatever_the_height() -> None:
    condition = {"type": "distance_below", "actors": PAIR}
    assert Airport({**condition, "distance_m": 3_810.0}, altitude_ft=9_000.0)()
    assert not Airport({**condition, "distance_m": 3_790.0})()


def test_two_have_collided_once_they_have_touched_and_ever_after() -> None:
    for actors in (PAIR, PAIR[::-1]):
        case = Case({"type": "collided", "actors": actors})
        assert not case()
        case.watch.fly(59.0)
        assert not case()
        case.watch.fly(2.0)
        assert case()
        case.end()
        assert case()


def test_of_an_actor_that_has_ended_nothing_is_true(
    subtests: pytest.Subtests,
) -> None:
    rows: list[Any] = [
        {"type": "in_phase", "actor": "AA", "phases": ["glide"]},
        {"type": "bound_for_runway", "actor": "AA", "runway": "01"},
        {"type": "on_runway", "actor": "BB", "runway": "01"},
        {"type": "threshold_within", "actor": "AA", "runway": "01", "within_s": 60.0},
        {"type": "speed_above", "actor": "AA", "speed_kt": 100.0},
        {"type": "height_below", "actor": "AA", "height_ft": 600.0},
        {"type": "distance_below", "actors": PAIR, "distance_m": 5_000.0},
    ]
    for condition in rows:
        with subtests.test(str(condition)):
            case = Airport(condition)
            assert case()
            case.end(condition.get("actor", "AA"))
            assert not case()
    for condition in [
        {"type": "separation_below", "actors": PAIR, "horizontal_nm": 99.0, "vertical_ft": 9e3},
        {"type": "predicted_loss_of_separation", "actors": PAIR, "within_s": 1200.0},
        {"type": "bound_for_altitude", "actor": "AA", "altitude_ft": 35_000},
    ]:
        with subtests.test(str(condition)):
            en_route = Case(condition)
            assert en_route()
            en_route.end()
            assert not en_route()


# --- what an aircraft reaches, passes and leaves -------------------------------------------------

CLIMBING = Straight(altitude_ft=2_000.0, east_m_s=100.0, rate_fpm=3_000.0)


@pytest.mark.parametrize(
    ("condition", "holds_after_s"),
    [
        ({"type": "height_above", "height_ft": 2_500.0}, 10),
        ({"type": "altitude_reached", "altitude_ft": 5_000.0}, 58),
        ({"type": "altitude_reached", "altitude_ft": 1_500.0}, 10),
        ({"type": "airspeed_reached", "cas_kt": 270.0}, 0),
        ({"type": "track_reached", "track_deg": 88.0}, 0),
        ({"type": "fix_passed", "fix": "LAM"}, 190),
    ],
)
def test_an_aircraft_reaches_or_passes_something(condition: Any, holds_after_s: int) -> None:
    case = Case(condition | {"actor": "AA"}, replace(CLIMBING), Straight(15_000.0))
    held = [case()] + [case.after(1.0) for _ in range(230)]
    assert held.index(True) == pytest.approx(holds_after_s, abs=2)


@pytest.mark.parametrize(
    ("altitude_ft", "wanders_fpm"), [(36_000.0, -30.0), (36_000.0, 30.0), (3_000.0, 30.0)]
)
def test_a_level_aircraft_has_not_passed_another_altitude(
    altitude_ft: float, wanders_fpm: float
) -> None:
    level = Straight(8_000.0, rate_fpm=wanders_fpm)
    case = Case({"type": "altitude_reached", "actor": "AA", "altitude_ft": altitude_ft}, level)
    assert not any(case.after(1.0) for _ in range(60))


def test_a_fix_that_nobody_knows_is_never_passed() -> None:
    with pytest.raises(ScenarioError, match="there is no fix ZUPEK"):
        Case({"type": "fix_passed", "actor": "AA", "fix": "ZUPEK"})
