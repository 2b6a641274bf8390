"""The benchmarks measure what they say."""

from __future__ import annotations

import sys

import pytest

from airhilt.scenario.seats import seats_of
from airhilt.world.checks import check
from benchmarks import peers, published_flight
from benchmarks.process_tree import cpu_s
from benchmarks.seat import sector_scenario
from benchmarks.soak import soak_scenario
from benchmarks.traffic import crowd_scenario, fifty_scenario
from breadth import mostly_slow


def test_the_scenario_of_a_crowd_is_one_that_flies() -> None:
    check(crowd_scenario(30, 1.0), "crowd")


def test_the_scenario_of_fifty_is_one_that_flies() -> None:
    scenario = fifty_scenario()
    check(scenario, "fifty")
    assert len(scenario.actors) == 50


def test_the_scenario_of_the_soak_has_calls_to_its_end() -> None:
    scenario = soak_scenario(120.0)
    check(scenario, "soak")
    assert [line.at_s for line in scenario.radio.lines] == [3.0, 23.0, 43.0, 63.0, 83.0, 103.0]


def test_the_scenario_of_the_seat_has_twenty_aircraft_and_a_controller() -> None:
    scenario = sector_scenario(1200.0)
    check(scenario, "sector")
    assert len(scenario.actors) == 20
    assert seats_of(["tower"], scenario) == ("Potomac Approach",)


def test_a_simulator_that_is_not_installed_is_named() -> None:
    found = peers.timed(sys.executable, "jsbgym", 2, 1.0)
    row = peers.row_of("jsbgym", 2, [found])
    assert str(row).endswith("2 aircraft: not installed (pip install jsbgym)")


def test_the_cpu_time_of_a_command_is_also_that_of_what_outlives_it() -> None:
    busy = "import time\nwhile time.process_time() < 0.4: pass"
    leaves = f"import subprocess, sys; subprocess.Popen([sys.executable, '-c', {busy!r}])"
    waits = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {busy!r}])"
    assert cpu_s([sys.executable, "-c", leaves]) > 0.4
    assert cpu_s([sys.executable, "-c", waits]) > 0.4


@pytest.mark.parametrize("name", mostly_slow([*published_flight.PUBLISHED], "737"))
def test_climbs_and_go_arounds_are_flown_as_they_are_published(name: str) -> None:
    assert [str(row) for row in published_flight.rows([name]) if row.is_failed] == []
