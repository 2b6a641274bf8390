"""What a run costs the people in it."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.commands import AltitudeCommand, Command, LandCommand
from airhilt.geodesy.wgs84 import displaced
from airhilt.messages import (
    ADVISORY_CALL,
    ActorTruth,
    Advisory,
    AdvisoryAudio,
    Climb,
    Evidence,
    Severity,
    SpokenTruth,
)
from airhilt.metrics.collector import Collector
from airhilt.metrics.plans import Plans, Start
from airhilt.metrics.summary import Summary
from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import RadioLine, ScriptedCommand
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE, SECOND_NS
from airhilt.world.loading import load
from straight import Straight, Watch

SCENARIO = load("s02a_headon")
FIRST, SECOND = (actor.callsign for actor in SCENARIO.actors[:2])
RUN = {"seed": 1, "assistant": "reference", "outcome": "finished", "inputs_dropped": {},
       "real_time_factor": 1.0, "cpu_s": 1.0}  # fmt: skip
HOME = (40.0 * DEGREE, -75.0 * DEGREE)
SPEED_M_S = 480.0 * KNOT
DURATION_S = 300.0


def line(at_s: float, command: Command) -> EffectiveLine:
    """A line that ends at a time, upon which the first aircraft does something."""
    scripted = ScriptedCommand(actor=FIRST, delay_s=0.0, command=command)
    said = RadioLine(
        id=f"line{at_s:g}", at_s=at_s, speaker="Center", frequency_khz=134_325,
        text="one", commands=(scripted,),
    )  # fmt: skip
    return EffectiveLine(said, said, 0.0, (), frozenset())


def advisory(name: str, revision: int, recipient: str, told: Any = None) -> Advisory:
    return Advisory(
        t_ns=SECOND_NS, id=name, revision=revision, recipient=recipient, recipients=(recipient,),
        kind="loss_of_separation", severity=Severity.CAUTION, traffic=(FIRST, SECOND),
        message="", evidence=Evidence(sources=("adsb",)), t_ready_ns=0, recommendation=told,
    )  # fmt: skip


class Flown:
    """A run of true states, with a script."""

    def __init__(self, *lines: EffectiveLine, channel: bool = False, **start: Any) -> None:
        ends_ns = {one.declared.id: round(one.declared.at_s * SECOND_NS) for one in lines}
        starts = dict.fromkeys((FIRST, SECOND), Start(1_500 * FOOT_PER_MINUTE, **start))
        watch = Watch(Straight(), Straight(90_000.0), always=False, names=(FIRST, SECOND))
        plans = Plans(lines, ends_ns, starts)
        self.collector = Collector(SCENARIO, 0.0, watch.monitor, None, plans, channel)

    def state(
        self, t_s: float, phase: str = "en_route", altitude_ft: float = 31_000.0,
        right_nm: float = 0.0, actor: str = FIRST, along_m: float | None = None,
    ) -> Flown:  # fmt: skip
        """Take a state on a track of 90 degrees, unless the aircraft is right of it."""
        along_m = SPEED_M_S * t_s if along_m is None else along_m
        latitude, longitude = displaced(HOME, -right_nm * NAUTICAL_MILE, along_m)
        truth = ActorTruth(
            t_ns=round(t_s * SECOND_NS), actor=actor, category="aircraft", phase=phase,
            on_ground=False, latitude_deg=latitude / DEGREE, longitude_deg=longitude / DEGREE,
            altitude_m=altitude_ft * FOOT, height_agl_m=altitude_ft * FOOT,
            velocity_north_m_s=0.0, velocity_east_m_s=SPEED_M_S, velocity_down_m_s=0.0,
            heading_deg=90.0, target_altitude_m=31_000.0 * FOOT,
        )  # fmt: skip
        return self.take(truth)

    def fly(self, *phases: str, actor: str = FIRST) -> Flown:
        for t_s, phase in enumerate(phases):
            self.state(float(t_s), phase, actor=actor)
        return self

    def take(self, message: Any) -> Flown:
        self.collector.take("", message, b"")
        return self

    def summary(self) -> Summary:
        return self.collector.summary(RUN, round(DURATION_S * SECOND_NS))


def climbing_ft(t_s: float) -> float:
    """Altitude of a climb from FL310 to FL330 at 2,000 ft/min that begins at 60 s."""
    return 31_000.0 + min(max(t_s - 60.0, 0.0) * 2_000.0 / 60.0, 2_000.0)


CLIMB = line(60.0, AltitudeCommand(action="altitude", altitude_ft=33_000, vertical_rate_fpm=2_000))
LANDING = line(150.0, LandCommand(action="land", runway="01"))


def test_go_arounds_and_rejected_takeoffs_count_once_an_aircraft_and_occurrence() -> None:
    flown = Flown().fly("glide", "go_around", "go_around", "en_route", "glide", "go_around")
    flown.fly("takeoff_roll", "rejected_takeoff", "rejected_takeoff", "standing", actor=SECOND)
    costs = flown.summary().costs
    assert (costs.go_arounds, costs.rejected_takeoffs) == (2, 1)


def test_a_reversal_is_a_climb_after_a_descent_told_to_one_crew_by_one_advisory() -> None:
    flown = Flown()
    told = [
        ("a", FIRST, "climb"), ("a", SECOND, "descend"), ("a", FIRST, "climb"),
        ("a", FIRST, "descend"), ("a", FIRST, None), ("a", FIRST, "climb"), ("b", FIRST, "descend"),
    ]  # fmt: skip
    for revision, (name, crew, sense) in enumerate(told):
        climb = sense and Climb(sense=sense, altitude_ft=31_000.0, vertical_rate_fpm=1_500.0)
        flown.take(advisory(name, revision, crew, climb))
    assert flown.summary().costs.reversals == 2


def test_who_flies_as_the_script_plans_deviates_in_nothing() -> None:
    flown = Flown(CLIMB)
    for t_s in range(301):
        flown.state(t_s, altitude_ft=climbing_ft(t_s))
    costs = flown.summary().costs
    assert costs.level_deviation_ft_s == pytest.approx(0.0, abs=0.1)
    assert costs.path_deviation_nm_s == pytest.approx(0.0, abs=0.5)


def test_the_distance_from_the_planned_level_and_path_is_integrated_over_time() -> None:
    """From 100 s on 500 ft and 2 NM off for 50 s, each on its side of the plan."""
    flown = Flown(CLIMB)
    for t_s in range(301):
        is_off, side = 100 < t_s <= 150, (-1) ** t_s
        flown.state(
            t_s,
            altitude_ft=climbing_ft(t_s) + 500.0 * side * is_off,
            right_nm=2.0 * side * is_off,
        )
    costs = flown.summary().costs
    assert costs.level_deviation_ft_s == pytest.approx(25_000.0, rel=1e-3)
    assert costs.path_deviation_nm_s == pytest.approx(100.0, rel=0.01)


def test_an_aircraft_without_its_own_plan_any_more_or_not_en_route_does_not_count() -> None:
    flown = Flown(LANDING)
    for t_s in range(301):
        phase = "glide" if 100 < t_s <= 150 else "en_route"
        flown.state(t_s, phase, altitude_ft=31_000.0 + 1_000.0 * (t_s > 100))
        flown.state(t_s, "climb_out" if t_s == 0 else "en_route", right_nm=t_s, actor=SECOND)
    costs = flown.summary().costs
    assert (costs.level_deviation_ft_s, costs.path_deviation_nm_s) == (0.0, pytest.approx(0, abs=1))


def test_the_planned_path_of_a_route_turns_with_it_and_goes_on_behind_its_end() -> None:
    """The route is 50 km to the east, then 50 km to the south."""
    corner = displaced(HOME, 0.0, 50_000.0)
    end = displaced(corner, -50_000.0, 0.0)
    onward = Flown(route=(corner, end))
    for t_s, along_m in enumerate(range(0, 50_000, 1_000)):
        onward.state(t_s, along_m=along_m)
    for t_s, south_m in enumerate(range(0, 80_000, 1_000), 50):
        onward.state(t_s, along_m=50_000.0, right_nm=south_m / NAUTICAL_MILE)
    assert onward.summary().costs.path_deviation_nm_s == pytest.approx(0.0, abs=20.0)
    straight_on = Flown(route=(corner, end))
    for t_s, along_m in enumerate(range(0, 150_000, 1_000)):
        straight_on.state(t_s, along_m=along_m)
    found = straight_on.summary().costs.path_deviation_nm_s
    assert found == pytest.approx(sum(range(100)) * 1_000.0 / NAUTICAL_MILE, rel=0.02)


def spoken(name: str, from_s: float, to_s: float, frequency_khz: int = 134_325) -> SpokenTruth:
    return SpokenTruth(
        id=name, speaker="Center", addressed=FIRST, frequency_khz=frequency_khz,
        text="say again", t_tx_ns=round(from_s * SECOND_NS), t_end_ns=round(to_s * SECOND_NS),
    )  # fmt: skip


def voice(recipient: str, duration_s: float) -> AdvisoryAudio:
    return AdvisoryAudio(
        t_ns=0, id="a", revision=0, recipient=recipient, text="", t_dec_ns=0, engine="x",
        samples=round(16_000 * duration_s), sha256="",
    )  # fmt: skip


def test_a_frequency_is_occupied_once_however_many_speak_on_it() -> None:
    flown = Flown().take(spoken("one", 10.0, 14.0)).take(spoken("two", 12.0, 15.0))
    flown.take(spoken("three", 12.0, 13.0)).take(spoken("other", 12.0, 15.0, 121_500))
    assert flown.summary().radio.occupied_s == pytest.approx(8.0)


@pytest.mark.parametrize(("on_frequency", "spoken_s"), [(False, 5.0 + 2.0), (True, 4.0 + 2.0)])
def test_advice_is_spoken_on_the_frequency_or_aside_from_it(
    on_frequency: bool, spoken_s: float
) -> None:
    """A crew hears its advisory from a voice of 5 s, or in a call of 4 s; the controller aside."""
    flown = Flown(channel=on_frequency).take(voice(FIRST, 5.0)).take(voice("ATC", 2.0))
    if on_frequency:
        flown.take(spoken(f"{ADVISORY_CALL}a.0.{FIRST}", 10.0, 14.0))
    assert flown.summary().costs.advice_spoken_s == pytest.approx(spoken_s)


def test_calls_that_ask_again_or_for_confirmation_are_clarifications() -> None:
    flown = Flown()
    texts = {
        "again": f"Say again for {FIRST}",
        "confirm": f"{FIRST}, confirm flight level three one zero",
        "answer": f"{FIRST}, climb flight level three three zero",
    }
    for number, (name, words) in enumerate(texts.items()):
        call = spoken(name, 10.0 * number, 10.0 * number + 3.0)
        flown.take(call.model_copy(update={"text": words}))
    radio = flown.summary().radio
    assert (radio.clarifications, radio.say_agains) == (2, 1)


def test_advisories_an_hour_are_counted_over_the_simulated_time() -> None:
    """Two in 300 s are 24 in an hour; a revision is no other advisory."""
    flown = Flown()
    for name, revision in (("a", 0), ("a", 1), ("b", 0)):
        flown.take(advisory(name, revision, "ATC"))
    assert flown.summary().costs.advisories_per_hour == pytest.approx(24.0)
