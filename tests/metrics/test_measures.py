"""Numbers over the runs of a table: which runs count, and by how much time."""

from __future__ import annotations

import pandas as pd
import pytest

from airhilt.metrics.measures import AVOIDED, NOMINAL_NUISANCE, NUISANCE

RUNS = pd.DataFrame(
    {
        "nominal": pd.array([True, False, None, True], "boolean"),
        "nuisance_alerts": pd.array([1, 5, 7, None], "Int64"),
        "duration_s": [1800.0, 1800.0, 3600.0, 7200.0],
        "avoided": pd.array([True, False, None, True], "boolean"),
    }
)


def test_nuisance_in_nominal_traffic_is_that_of_runs_without_a_conflict() -> None:
    assert NOMINAL_NUISANCE.estimate(RUNS).value == pytest.approx(1 / 0.5)


def test_the_time_of_a_run_whose_alerts_nobody_counted_is_not_counted_either() -> None:
    assert NUISANCE.estimate(RUNS).value == pytest.approx(13 / 2.0)


def test_a_share_is_one_of_the_runs_that_have_a_value() -> None:
    found = AVOIDED.estimate(RUNS)
    assert (found.n, found.value) == (3, pytest.approx(200 / 3))
