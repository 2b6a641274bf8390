"""Runs that take the same pictures are not done by two workers at once."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.sweep.engine import apart
from airhilt.sweep.outcome import Request


def request(number: int, **options: Any) -> Request:
    scenario = {"name": "meeting", "radio": {"snr_db": float(number)}}
    return Request(key=str(number), scenario=scenario, options=options, keep="none", folder="")


def grid(*, shares: bool) -> list[Request]:
    """Return two visibilities, each with three levels of noise, as a grid has them."""
    return [
        request(3 * index + noise, visibility_m=visibility_m, snr_db=noise, share_pictures=shares)
        for index, visibility_m in enumerate((800.0, 5000.0))
        for noise in range(3)
    ]


def keys(requests: list[Request], workers: int) -> str:
    return "".join(each.key for each in apart(requests, workers))


@pytest.mark.parametrize(("workers", "order"), [(1, "012345"), (2, "031425")])
def test_each_worker_begins_with_pictures_of_its_own(workers: int, order: str) -> None:
    assert keys(grid(shares=True), workers) == order


def test_runs_that_share_nothing_keep_their_order() -> None:
    assert keys(grid(shares=False), 2) == "012345"
