"""Assistants that know nothing are worth nothing by the measures."""

from __future__ import annotations

from pathlib import Path

import pytest

import airhilt
from airhilt.errors import AirhiltError
from airhilt.metrics.summary import Summary


def summary(scenario: str, assistant: str, out: Path) -> Summary:
    result = airhilt.run(
        scenario, out=out, assistant=assistant, latency="fixed", cameras=False, speech=False,
        report=False,
    )  # fmt: skip
    return result.summary


def test_who_warns_everybody_before_anything_shows_has_warned_nobody_of_the_conflict(
    tmp_path: Path,
) -> None:
    told = summary("s01a_bad_readback", "cry_wolf", tmp_path / "run")
    assert told.t_first_warning_s is None
    assert {each.nuisance_to for each in told.advisories} == {("AAL123", "DAL456")}


def test_in_nominal_traffic_a_false_warning_is_a_nuisance_to_each_whom_it_names(
    tmp_path: Path,
) -> None:
    told = summary("s01a_nominal", "cry_wolf:5", tmp_path / "run")
    assert told.nuisance_alerts == sum(len(each.traffic) for each in told.advisories) >= 2


def test_the_silent_one_warns_nobody(tmp_path: Path) -> None:
    told = summary("s01a_bad_readback", "silent", tmp_path / "run")
    assert (told.advisories, told.nuisance_alerts, told.avoided) == ([], 0, False)


@pytest.mark.parametrize("delay", ["soon", "-1", "1e9"])
def test_a_delay_that_is_none_is_refused(delay: str, tmp_path: Path) -> None:
    with pytest.raises(AirhiltError, match="expected a delay in s from 0 to 3600"):
        summary("s01a_nominal", f"cry_wolf:{delay}", tmp_path / "run")
