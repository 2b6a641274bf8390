"""Conditions on the true state, each when it is true and when it is not."""

import pytest
from fakes import Performing, Straight, Watch
from pydantic import TypeAdapter

from airhilt.metrics.conditions import ConditionCompiler
from airhilt.scenario.models import Condition
from airhilt.units import SECOND_NS


class Case:
    """A condition on two aircraft, A and B, that meet after a minute if nobody says otherwise."""

    def __init__(self, condition, *aircraft):
        pair = aircraft or (
            Straight(-15_000.0, east_m_s=250.0),
            Straight(15_000.0, east_m_s=-250.0),
        )
        self.watch = Watch(*pair, names=("AA", "BB"))
        self.ended_lines = set()
        self.cast = {name: Performing(body) for name, body in self.watch.aircraft.items()}
        compiler = ConditionCompiler(self.cast, self.watch.monitor, None, self.ended_lines)
        self.test = compiler.compile(TypeAdapter(Condition).validate_python(condition))

    def __call__(self):
        return self.test(self.watch.now_ns)

    def after(self, seconds):
        for craft in self.watch.aircraft.values():
            craft.advance(seconds)
        self.watch.now_ns += round(seconds * SECOND_NS)
        return self()

    def end(self, callsign="AA"):
        self.watch.aircraft[callsign].ended = "ground_contact"


PAIR = ["AA", "BB"]


def test_time_is_reached_from_then_on():
    case = Case({"type": "time", "at_s": 10.0})
    assert [case(), case.after(9.9), case.after(0.1), case.after(50.0)] == [
        False,
        False,
        True,
        True,
    ]


def test_a_line_has_ended_once_it_has():
    case = Case({"type": "line_ended", "line": "readback"})
    assert not case()
    case.ended_lines.add("clearance")
    assert not case()
    case.ended_lines.add("readback")
    assert case()


def test_separation_is_below_both_distances_at_once():
    def below(**second):
        condition = {"type": "separation_below", "actors": PAIR, "horizontal_nm": 5.0,
                     "vertical_ft": 1000.0}  # fmt: skip
        return Case(condition, Straight(), Straight(**second))()

    assert below(east_m=9_000.0, altitude_ft=35_900.0)
    assert not below(east_m=9_500.0)
    assert not below(altitude_ft=36_100.0)


@pytest.mark.parametrize(("within_s", "true_at_start"), [(41.0, False), (42.0, True)])
def test_a_loss_is_predicted_within_a_time(within_s, true_at_start):
    """5 NM apart at 500 m/s of closure is 18.5 s before the two meet after 60 s."""
    case = Case({"type": "predicted_loss_of_separation", "actors": PAIR, "within_s": within_s})
    assert case() == true_at_start
    assert case.after(2.0)


def test_no_loss_is_predicted_of_two_that_have_passed_or_keep_apart():
    condition = {"type": "predicted_loss_of_separation", "actors": PAIR, "within_s": 1200.0}
    apart = (Straight(-15_000.0, east_m_s=-250.0), Straight(15_000.0, east_m_s=250.0))
    assert not Case(condition, *apart)()
    above = (Straight(-15_000.0, east_m_s=250.0), Straight(15_000.0, altitude_ft=37_000.0))
    assert not Case(condition, *above)()


def test_a_closest_approach_has_passed_when_the_two_have_drawn_apart_for_a_while():
    case = Case({"type": "closest_approach_passed", "actors": PAIR, "for_s": 20.0})
    assert not case()
    assert not case.after(59.0)
    assert not case.after(2.0)
    assert not case.after(19.0)
    assert case.after(1.1)


def test_drawing_apart_must_not_be_broken_off():
    case = Case({"type": "closest_approach_passed", "actors": PAIR, "for_s": 20.0})
    case.after(61.0)
    case.after(15.0)
    for craft in case.watch.aircraft.values():
        craft.state = craft.state._replace(velocity_east_m_s=-craft.state.velocity_east_m_s)
    assert not case.after(1.0)
    assert not case.after(30.0)
    assert not case.after(10.0)


@pytest.mark.parametrize(
    ("altitude_ft", "target_ft", "true"),
    [(31_000, 35_000, True), (31_000, 35_040, True), (31_000, 35_060, False),
     (35_000, 31_000, False), (35_000, None, True)],
)  # fmt: skip
def test_bound_for_an_altitude_is_where_an_aircraft_flies_to_and_not_where_it_is(
    altitude_ft, target_ft, true
):
    condition = {"type": "bound_for_altitude", "actor": "AA", "altitude_ft": 35_000}
    first = Straight(altitude_ft=altitude_ft, target_ft=target_ft)
    assert Case(condition, first, Straight())() == true


@pytest.mark.parametrize(
    "condition",
    [
        {"type": "separation_below", "actors": PAIR, "horizontal_nm": 99.0, "vertical_ft": 9e3},
        {"type": "predicted_loss_of_separation", "actors": PAIR, "within_s": 1200.0},
        {"type": "bound_for_altitude", "actor": "AA", "altitude_ft": 35_000},
    ],
    ids=lambda condition: condition["type"],
)
def test_of_an_aircraft_that_has_ended_nothing_is_true(condition):
    case = Case(condition)
    assert case()
    case.end()
    assert not case()


LATE, EARLY = {"type": "time", "at_s": 20.0}, {"type": "time", "at_s": 10.0}


def test_all_of_them_are_true_when_the_last_is_and_any_of_them_when_the_first_is():
    everything = Case({"type": "all_of", "conditions": [EARLY, LATE]})
    anything = Case({"type": "any_of", "conditions": [LATE, EARLY]})
    assert [everything(), everything.after(10.0), everything.after(10.0)] == [False, False, True]
    assert [anything(), anything.after(10.0), anything.after(10.0)] == [False, True, True]


def test_a_condition_that_keeps_time_keeps_it_while_another_is_not_yet_true():
    passed = {"type": "closest_approach_passed", "actors": PAIR, "for_s": 20.0}
    case = Case({"type": "all_of", "conditions": [{"type": "time", "at_s": 90.0}, passed]})
    for _ in range(89):
        assert not case.after(1.0)
    assert case.after(1.0)
