"""What comes of the scenarios at an airport and of the emergencies, with nobody to warn."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from airhilt import load, run
from airhilt.host import library
from airhilt.messages import SpokenTruth
from airhilt.metrics.summary import Summary
from airhilt.record import read_log
from airhilt.scenario.models import LineBegun, Scenario
from airhilt.units import SECOND_NS
from breadth import mostly_slow
from nominal import nominal

SCENARIOS = [name for name in library.names("scenarios") if not name.startswith("s02a")]
NOMINAL = [name for name in SCENARIOS if name.endswith("_nominal")]
CONFLICTS = [name for name in SCENARIOS if name not in NOMINAL]
CHEAPEST = ("s01a_tight_timing", "s02c_intruder_headon")
"""A conflict that begins with a call, and one in the air."""
WITH_AND_WITHOUT_SOUND = pytest.mark.parametrize(
    "speech", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["as text", "spoken"]
)


def alone(scenario: Scenario, out: Path, seed: int = 0, speech: bool = False) -> Summary:
    return run(
        scenario,
        out=out,
        latency="fixed",
        cameras=False,
        speech=speech,
        assistant="none",
        seed=seed,
        report=False,
    ).summary


def assisted(name: str, out: Path, speech: bool = False) -> Summary:
    return run(
        nominal(name), out=out, latency="fixed", cameras=False, speech=speech, report=False
    ).summary


@WITH_AND_WITHOUT_SOUND
@pytest.mark.parametrize("name", mostly_slow(CONFLICTS, *CHEAPEST))
def test_without_an_assistant_what_the_scenario_describes_comes_to_pass(
    name: str, speech: bool, tmp_path: Path
) -> None:
    summary = alone(load(name), tmp_path / "run", speech=speech)
    assert summary.t_conflict_s is not None
    assert summary.unassisted_as_declared
    assert summary.avoided is False
    assert summary.t_first_warning_s is None
    conflict = load(name).conflict
    if conflict is not None and isinstance(conflict.begins, LineBegun):
        assert summary.t_conflict_s == begin_s(tmp_path / "run", conflict.begins.line)


def begin_s(folder: Path, line: str) -> float:
    """Return when a line of the script began to be transmitted."""
    said = (
        SpokenTruth.model_validate_json(logged.data)
        for logged in read_log(folder / "log.mcap")
        if logged.key.startswith("truth/radio/")
    )
    return next(one.t_tx_ns / SECOND_NS for one in said if one.id == line)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [4, 10, 13])
def test_the_flock_is_met_whatever_the_birds_do_on_their_way(seed: int, tmp_path: Path) -> None:
    assert alone(nominal("s01c_flock_on_final"), tmp_path / "run", seed).collision


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_the_departure_strikes_the_birds_in_every_seed(seed: int, tmp_path: Path) -> None:
    summary = alone(load("s02b_bird_strike"), tmp_path / "run", seed)
    assert summary.t_conflict_s is not None
    assert summary.loss_of_separation


UNSEEN = ("s01b_dropped_hold",)
"""A silent vehicle, which only a camera could see."""
REPORTED = ("s01c_deer_delayed_warning", "s02b_engine_out_driftdown")
BEFORE_IT_BEGINS = ("s01a_tight_timing",)
"""All act on warnings that are over before the declared beginning of the conflict."""
SHORTEST = ("s01a_tight_timing", "s01c_deer_delayed_warning")
"""Prevented by what ADS-B shows, and by a report; what was said prevents one aloud."""
SEEN = [name for name in CONFLICTS if name.startswith(("s01a", "s01b")) and name not in UNSEEN]


@WITH_AND_WITHOUT_SOUND
@pytest.mark.parametrize("name", mostly_slow([*SEEN, *REPORTED], *SHORTEST))
def test_the_assistant_prevents_what_its_senses_show(
    name: str, speech: bool, tmp_path: Path
) -> None:
    prevented(name, tmp_path / "run", speech)


@pytest.mark.parametrize(
    "name", mostly_slow(["s01a_bad_readback", "s01b_delayed_hold"], "s01a_bad_readback")
)
def test_the_assistant_prevents_what_it_was_told_aloud(name: str, tmp_path: Path) -> None:
    prevented(name, tmp_path / "run", speech=True)


def prevented(name: str, out: Path, speech: bool) -> None:
    summary = assisted(name, out, speech)
    assert not summary.collision
    if name not in BEFORE_IT_BEGINS or speech:
        assert summary.avoided is True
        assert summary.t_first_warning_s is not None
    else:
        assert not summary.loss_of_separation
    assert summary.nuisance_alerts == 0


@pytest.mark.parametrize("name", mostly_slow(
    [name for name in CONFLICTS if name.startswith("s02c") or "undetected" in name],
    "s02c_intruder_headon",
))  # fmt: skip
def test_of_what_nobody_senses_it_says_nothing(name: str, tmp_path: Path) -> None:
    """Without a transponder, a report or a camera there is nothing to go by."""
    summary = assisted(name, tmp_path / "run")
    assert summary.advisories == []
    assert summary.avoided is False


@WITH_AND_WITHOUT_SOUND
@pytest.mark.parametrize("name", mostly_slow(NOMINAL, "s02c_nominal"))
def test_a_nominal_twin_ends_without_incident_and_the_assistant_keeps_quiet(
    name: str, speech: bool, tmp_path: Path
) -> None:
    summary = assisted(name, tmp_path / "run", speech)
    assert summary.nuisance_alerts == 0
    assert not summary.collision
    assert not summary.nmac
    assert not summary.loss_of_separation
    assert summary.runway_incursions == []
    assert summary.ended_actors == {}


def deaf_crews() -> Scenario:
    """A departure climbs out closely over a landing on a crossing runway, whatever is advised."""
    tower, frequency_khz = "San Francisco Tower", 120_500

    def airliner(callsign: str, icao24: str, **initial: Any) -> dict[str, Any]:
        return {
            "type": "aircraft", "callsign": callsign, "icao24": icao24, "aircraft": "737",
            "initial": initial, "pilot": {"compliance": 0.0},
        }  # fmt: skip

    def clearance(name: str, at_s: float, to: str, text: str, **command: Any) -> dict[str, Any]:
        return {
            "id": name, "at_s": at_s, "speaker": tower, "to": to, "frequency_khz": frequency_khz,
            "text": text, "commands": [{"actor": to, "command": command}],
        }  # fmt: skip

    pair = ("JBU7", "NKS5")
    return Scenario.model_validate({
        "name": "deaf_crews", "title": "Two on crossing runways", "family": "S01A",
        "scene": {"type": "airport", "airport": "KSFO"}, "duration_s": 120,
        "actors": [
            airliner("JBU7", "b00001", type="final", runway="28R", distance_nm=2),
            airliner("NKS5", "b00002", type="lined_up", runway="01R"),
        ],
        "radio": {"controller": tower, "lines": [
            clearance("land", 1, "JBU7", "JetBlue seven, runway two eight right, cleared to land.",
                      action="land", runway="28R"),
            clearance("go", 25.5, "NKS5",
                      "Spirit wings five, runway zero one right, cleared for takeoff.",
                      action="take_off", runway="01R"),
        ]},
        "conflict": {
            "actors": pair, "opens_when": {"type": "line_ended", "line": "go"},
            "unassisted": "runway_incursion",
        },
        "end_when": [{"type": "closest_approach_passed", "actors": pair, "for_s": 10}],
    })  # fmt: skip


def test_who_climbs_out_closely_over_a_landing_has_not_avoided_it(tmp_path: Path) -> None:
    options: dict[str, Any] = {"latency": "fixed", "cameras": False, "speech": False}
    summary = run(deaf_crews(), out=tmp_path / "run", report=False, **options).summary
    assert summary.t_first_warning_s is not None
    assert summary.nmac, "less than 100 ft between their outlines, though one is on the ground"
    assert summary.runway_incursion_category == "A"
    assert summary.avoided is False


def test_every_family_has_its_variants_and_a_nominal_twin() -> None:
    scenarios = {name: load(name) for name in SCENARIOS}
    families = {scenario.family for scenario in scenarios.values()} | {"S02A"}
    assert families == {"S01A", "S01B", "S01C", "S02A", "S02B", "S02C"}
    assert {scenarios[name].family for name in NOMINAL} | {"S02A"} == families
    assert all(scenario.perturbations for scenario in scenarios.values())


@pytest.mark.slow
@pytest.mark.parametrize("name", CONFLICTS)
def test_without_its_failures_a_conflict_does_not_arise(name: str, tmp_path: Path) -> None:
    """A departure that waits for its traffic leaves, and everybody comes to their end."""
    scenario = nominal(name)
    if not scenario.failures:
        pytest.skip("nothing fails in this scenario")
    scenario = scenario.model_copy(update={"failures": (), "end_when": ()})
    options: dict[str, Any] = {
        "latency": "fixed", "assistant": "none", "speech": False, "cameras": False,
    }  # fmt: skip
    summary = run(scenario, out=tmp_path / "run", **options).summary
    assert summary.avoided is not False
    assert summary.runway_incursion_category in (None, "C", "D")
    assert {actor for actor in summary.ended_actors if not actor.startswith("FLOCK")} == set()
