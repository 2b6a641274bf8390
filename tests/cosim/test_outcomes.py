"""What comes of the shipped scenarios, with and without an assistant."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import pytest

from airhilt import load, run
from airhilt.messages import ConflictTruth
from airhilt.metrics.summary import Summary
from airhilt.record import read_log
from airhilt.units import SECOND_NS
from breadth import mostly_slow
from nominal import nominal

CONFLICTS = ("s02a_headon", "s02a_in_trail", "s02a_vertical", "s02a_converging")
PASSED_S = 200.0
"""Time at which all have passed each other in the nominal traffic."""
TCAS_TOLERANCE_S = 1.0
"""TCAS runs once a second."""
TCAS_TOLERANCE_IN_CLIMB_S = 5.0
"""The projection keeps ground speed; an aircraft that climbs 4000 ft on the way gains 4 s."""


@pytest.fixture(scope="module", params=mostly_slow(CONFLICTS, "s02a_headon"))
def pair_of_runs(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Summary, Summary, Path]:
    """One scenario with the reference assistant, without one, and the latter's folder."""
    scenario = nominal(request.param)
    folder = tmp_path_factory.mktemp(request.param)
    options: dict[str, Any] = {
        "latency": "fixed", "cameras": False, "speech": False, "report": False,
    }  # fmt: skip
    warned = run(scenario, out=folder / "warned", **options).summary
    alone = run(scenario, out=folder / "alone", assistant="none", **options)
    return warned, alone.summary, alone.folder


def test_without_an_assistant_separation_is_lost(
    pair_of_runs: tuple[Summary, Summary, Path],
) -> None:
    _, alone, _ = pair_of_runs
    assert alone.loss_of_separation
    assert alone.avoided is False
    assert alone.t_first_warning_s is None
    assert alone.modalities["decision"] == "off"


def test_with_the_assistant_it_is_kept(pair_of_runs: tuple[Summary, Summary, Path]) -> None:
    warned, _, _ = pair_of_runs
    assert warned.avoided is True
    assert not warned.loss_of_separation
    assert warned.nuisance_alerts == 0
    assert warned.t_first_warning_s is not None
    assert warned.t_window_s is not None
    assert warned.t_first_warning_s - warned.t_window_s < 10.0
    assert warned.lead_before_closest_approach_s is not None
    assert warned.lead_before_closest_approach_s > 60.0


def test_the_margin_over_tcas_is_what_the_run_without_assistant_shows(
    pair_of_runs: tuple[Summary, Summary, Path],
) -> None:
    warned, _, folder = pair_of_runs
    spoken = {
        truth.phase: truth.t_ns / SECOND_NS
        for truth in (
            ConflictTruth.model_validate_json(logged.data)
            for logged in read_log(folder / "log.mcap")
            if logged.key == "truth/conflict"
        )
    }
    assert warned.t_first_warning_s is not None
    climbs = warned.scenario == "s02a_vertical"
    tolerance = TCAS_TOLERANCE_IN_CLIMB_S if climbs else TCAS_TOLERANCE_S
    for phase, margin in (
        ("tcas_ta", warned.margin_over_tcas_ta_s),
        ("tcas_ra", warned.margin_over_tcas_ra_s),
    ):
        expected = spoken[cast(Any, phase)] - warned.t_first_warning_s
        assert margin == pytest.approx(expected, abs=tolerance)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "speech", "duration_s"),
    [(0, False, PASSED_S), (0, True, 300.0), (1, True, 300.0), (2, True, 300.0)],
)
def test_nothing_is_said_about_nominal_traffic(
    tmp_path: Path, seed: int, speech: bool, duration_s: float
) -> None:
    traffic = load("s02a_nominal").model_copy(update={"duration_s": duration_s})
    summary = run(
        traffic, out=tmp_path / "run", latency="fixed", cameras=False, seed=seed, speech=speech,
        report=False,
    ).summary  # fmt: skip
    assert summary.nuisance_alerts == 0
    assert summary.avoided is None
    assert not summary.loss_of_separation


@pytest.mark.parametrize("seed", mostly_slow(range(1, 4), 1))
def test_a_wrong_readback_is_noticed_as_soon_as_it_was_said(tmp_path: Path, seed: int) -> None:
    scenario = nominal("s02a_vertical").model_copy(update={"duration_s": 40.0})
    summary = run(scenario, out=tmp_path / "run", latency="fixed", cameras=False, seed=seed).summary
    assert [told.kind for told in summary.advisories][:1] == ["readback_mismatch"]
    assert summary.time_to_first_warning_after_call_s is not None
    assert 0.0 < summary.time_to_first_warning_after_call_s < 1.0
    assert summary.first_warning_parts is not None
    assert summary.first_warning_parts.speech_s > 3.0
