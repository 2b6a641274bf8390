"""The true state of an actor as a message."""

from __future__ import annotations

import math
from typing import Any

import pytest

from airhilt.scenario import Scenario
from airhilt.scenario.models import Separation
from airhilt.units import FOOT
from airhilt.world.actors import build_actors
from airhilt.world.loading import draw, load
from airhilt.world.site import ScenarioSite
from airhilt.world.truth.states import minima_of, truth_of, zone_of


def test_the_truth_is_the_state_in_degrees_and_metres(encounter: Scenario) -> None:
    realised, _ = draw(encounter, 0)
    actor = build_actors(realised, ScenarioSite.of(realised), 0, 0.05)["AAL123"]
    body: Any = actor.body
    truth, state = truth_of(actor, 3), body.state
    assert (truth.t_ns, truth.actor) == (3, "AAL123")
    assert truth.latitude_deg == pytest.approx(math.degrees(state.latitude_rad))
    assert truth.longitude_deg == pytest.approx(math.degrees(state.longitude_rad))
    assert truth.heading_deg == pytest.approx(math.degrees(state.heading_rad) % 360.0)
    assert truth.roll_deg == pytest.approx(math.degrees(state.roll_rad))
    assert truth.pitch_deg == pytest.approx(math.degrees(state.pitch_rad))
    assert truth.altitude_m == pytest.approx(35_000.0 * FOOT, abs=1.0)
    for name in ("velocity_north_m_s", "velocity_east_m_s", "velocity_down_m_s"):
        assert getattr(truth, name) == getattr(state, name)


def test_the_zone_of_a_tower_is_round_the_middle_of_its_airport(encounter: Scenario) -> None:
    site = ScenarioSite.of(load("s01a_nominal"))
    zone = zone_of(site)
    assert zone is not None
    assert site.layout is not None
    middle = site.layout.local_frame.to_local((zone.latitude_rad, zone.longitude_rad))
    assert middle == pytest.approx((0.0, 0.0), abs=1e-3)
    assert zone.altitude_m == site.ground_m
    assert zone_of(ScenarioSite.of(encounter)) is None


def test_the_minima_have_the_tolerance_of_level_keeping_taken_off() -> None:
    separation = Separation(horizontal_nm=3.0, vertical_ft=1000.0, level_tolerance_ft=150.0)
    assert minima_of(separation) == pytest.approx((5556.0, 850.0 * 0.3048))
