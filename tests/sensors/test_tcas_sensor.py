"""Active interrogation by aircraft with TCAS II: who replies, how often, and how exactly."""

from __future__ import annotations

import itertools
import json
import math
from typing import Any

import numpy as np
import pytest

from airhilt import load
from airhilt.errors import ScenarioError
from airhilt.messages import TcasReply
from airhilt.scenario.models import Transponder
from airhilt.sensors.tcas import SENSOR, must_carry
from airhilt.surveillance.radar import Antenna
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, SECOND_NS
from airhilt.world.loading import load_text
from airhilt.world.mover import SurfaceState
from airhilt.world.site import ScenarioSite
from sensed import Acting, Body, sense

EARTH_RADIUS_M = 6_371_000.0
OWN, OTHER = "AAL123", "DAL456"


class Sky:
    """An own aircraft at rest over the centre, heading east, and another one some way off."""

    def __init__(
        self, distance_nm: float = 10.0, *, tcas: tuple[str, ...] = (OWN,),
        altitude_ft: float = 35_030.0, **transponder: Any,
    ) -> None:  # fmt: skip
        given = load("s02a_headon")
        own, other = given.actors
        other = other.model_copy(update={"transponder": Transponder(**transponder)})
        self.scenario = given.model_copy(update={"actors": (own, other), "tcas": tcas})
        self.site = ScenarioSite.of(self.scenario)
        self.own = Acting(own, Body(self.state(0.0, 35_000.0)))
        self.other = Acting(other, Body(self.state(distance_nm, altitude_ft)))
        self.subscribed: frozenset[str] = frozenset()
        self.age_ns = 0
        self.replies: list[TcasReply] = []

    def state(self, north_nm: float, altitude_ft: float) -> SurfaceState:
        latitude, longitude = self.site.place(self.site.centre)
        latitude += north_nm * NAUTICAL_MILE / EARTH_RADIUS_M
        altitude_m = altitude_ft * FOOT
        height_m = altitude_m - self.site.ground_m
        east_rad = 90.0 * DEGREE
        return SurfaceState(latitude, longitude, altitude_m, height_m, 0.0, 0.0, 0.0, east_rad)

    def publish(self, key: str, message: Any, *, raw: bytes | None = None) -> None:
        assert raw is None
        assert key == f"tcas/{message.callsign}"
        self.replies.append(message)

    def go(self, seconds: float = 200.0, seed: int = 1) -> list[TcasReply]:
        actors = {OWN: self.own, OTHER: self.other}
        sense(
            SENSOR, self.scenario, self.site, actors, self.publish, seconds,
            seed=seed, age_ns=self.age_ns, subscribed=self.subscribed,
        )  # fmt: skip
        return self.replies


def test_a_transponder_replies_once_a_second_and_one_reply_in_twenty_is_lost() -> None:
    replies = Sky().go(400.0)
    times = [reply.t_ns for reply in replies]
    assert {(b - a) % SECOND_NS for a, b in itertools.pairwise(times)} == {0}
    assert 0.92 < len(replies) / 400.0 < 0.98


def test_range_and_bearing_have_the_errors_of_tcas() -> None:
    sky = Sky()
    true_m = Antenna(*sky.own.body.state[:3]).to(sky.other.body.state).range_m
    replies = sky.go(1000.0)
    ranges = np.array([reply.range_m - true_m for reply in replies])
    assert abs(ranges.mean()) < 40.0
    assert ranges.std() == pytest.approx(50 * FOOT, rel=0.1)
    # The other one is to the north, the own nose points east.
    bearings = [(reply.bearing_deg - 270.0 + 180.0) % 360.0 - 180.0 for reply in replies]
    assert np.mean(bearings) == pytest.approx(0.0, abs=1.0)
    assert np.std(bearings) == pytest.approx(9.0, rel=0.1)


def test_ranges_and_bearings_come_in_tenths() -> None:
    for reply in Sky().go(100.0):
        for value in (10.0 * reply.range_m, 10.0 * reply.bearing_deg):
            assert value == pytest.approx(round(value), abs=1e-6)
    assert any(reply.range_m % 1.0 for reply in Sky().go())
    assert any(reply.bearing_deg % 1.0 for reply in Sky().go())


def test_a_range_is_that_of_the_instant_and_not_that_of_the_tick_before() -> None:
    """With 200 m/s, four tenths of a second are 80 m."""
    ranges = []
    for age_ns in (0, 400_000_000):
        sky = Sky()
        sky.age_ns = age_ns
        sky.other.body.state = sky.other.body.state._replace(velocity_north_m_s=200.0)
        ranges.append([reply.range_m for reply in sky.go(20.0)])
    assert np.array(ranges[1]) - np.array(ranges[0]) == pytest.approx(80.0, abs=1.0)


def test_wheels_below_the_elevation_of_the_ground_are_on_it() -> None:
    sky = Sky(2.0)
    sky.other.body.state = sky.state(2.0, sky.site.ground_m / FOOT - 3.0)
    assert sky.go(20.0)


class Extreme:
    """Draws the middle of whatever is random, but an end of what has two."""

    def __init__(self, *, is_least: bool = False) -> None:
        self.is_least = is_least

    def random(self) -> float:
        return 0.5

    def standard_normal(self, count: int) -> np.ndarray:
        return np.zeros(count)

    def uniform(self, least: float, greatest: float) -> float:
        assert least in (0.0, -greatest)
        return least if self.is_least else greatest


def test_the_range_to_one_transponder_is_wrong_by_125_ft_at_most(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The bias of RTCA DO-185B."""
    sky = Sky()
    true_m = Antenna(*sky.own.body.state[:3]).to(sky.other.body.state).range_m
    monkeypatch.setattr("airhilt.sensors.tcas.stream", lambda *_: Extreme())
    assert sky.go(3.0)[0].range_m - true_m == pytest.approx(125.0 * FOOT, abs=0.06)


def test_no_range_is_less_than_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("airhilt.sensors.tcas.stream", lambda *_: Extreme(is_least=True))
    assert Sky(0.0).go(3.0)[0].range_m == 0.0


def test_mode_s_says_who_replies_and_its_altitude_in_steps_of_25_ft() -> None:
    reply = Sky().go()[0]
    assert (reply.mode, reply.icao24, reply.altitude_ft) == ("S", "a4d5e6", 35_025)


def test_mode_c_does_not_say_who_replies_and_has_steps_of_100_ft() -> None:
    replies = Sky(mode="C", tcas=(OWN, OTHER)).go()
    reply = next(each for each in replies if each.callsign == OWN)
    assert (reply.mode, reply.icao24, reply.altitude_ft) == ("C", None, 35_000)
    assert not reply.has_tcas


def test_mode_c_reaches_less_far_than_mode_s() -> None:
    """30 NM and 14 NM."""
    for reach_nm, mode in ((30.0, "S"), (14.0, "C")):
        assert Sky(reach_nm - 0.2, mode=mode).go(20.0)
        assert not Sky(reach_nm + 0.2, mode=mode).go(20.0)


def test_an_aircraft_without_a_transponder_does_not_reply() -> None:
    assert Sky(equipped=False).go() == []


def test_an_aircraft_on_the_ground_says_so_and_does_not_interrogate() -> None:
    sky = Sky(2.0, altitude_ft=100.0)
    sky.other.body.on_ground = True
    assert {reply.on_ground for reply in sky.go()} == {True}
    sky = Sky()
    sky.own.body.on_ground = True
    assert sky.go() == []


def test_an_aircraft_below_the_horizon_does_not_reply() -> None:
    sky = Sky(25.0, altitude_ft=300.0)
    sky.own.body.state = sky.state(0.0, 400.0)
    sky.site.__dict__.update(ground_m=290 * FOOT)
    assert sky.go() == []


def test_a_reply_says_whether_its_sender_coordinates() -> None:
    assert {reply.has_tcas for reply in Sky(tcas=(OWN,)).go()} == {False}
    assert {reply.has_tcas for reply in Sky(tcas=(OWN, OTHER)).go()} == {True}


def test_nobody_interrogates_unless_the_scenario_or_a_worker_asks_for_it() -> None:
    sky = Sky(tcas=())
    assert sky.go() == []
    sky.subscribed = frozenset({"tcas"})
    assert {reply.callsign for reply in sky.go()} == {OWN, OTHER}


def test_light_aircraft_need_not_carry_it() -> None:
    sky = Sky()
    sky.other.emitter_category = "A1"
    assert must_carry([sky.own, sky.other]) == (OWN,)  # type: ignore[list-item]


def test_the_same_seed_gives_the_same_replies_and_another_seed_others() -> None:
    assert Sky().go(seed=4) == Sky().go(seed=4) != Sky().go(seed=5)


def test_a_lost_reply_does_not_change_those_after_it() -> None:
    """A target that ends and one that is out of range draw no differently for the other."""
    near, far = Sky().go(50.0), Sky(20.0).go(50.0)
    assert [reply.t_ns for reply in near] == [reply.t_ns for reply in far]
    assert all(math.isclose(a.bearing_deg, b.bearing_deg) for a, b in zip(near, far, strict=True))


def refused(**changes: Any) -> str:
    document = load("s02a_headon").model_dump(mode="json") | changes
    with pytest.raises(ScenarioError) as refusal:
        load_text(json.dumps(document), "refused")
    return str(refusal.value)


def test_only_aircraft_of_the_scenario_with_mode_s_carry_it() -> None:
    assert "no aircraft 'AAL999'" in refused(tcas=["AAL999"])
    actors = load("s02a_headon").model_dump(mode="json")["actors"]
    actors[0]["transponder"] = {"mode": "C"}
    assert "'AAL123' has no Mode S transponder" in refused(tcas=["AAL123"], actors=actors)


def test_mode_c_transmits_no_adsb() -> None:
    assert Transponder().has_adsb
    assert not Transponder(mode="C").has_adsb
    assert not Transponder(equipped=False).has_adsb
