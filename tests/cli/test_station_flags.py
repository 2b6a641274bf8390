"""`--agreed` says of a seat, by any name that `--seat` takes, to what its person has agreed."""

from __future__ import annotations

import click
import pytest

from airhilt.cli.station_flags import Agreed, agreed_by_seat

SEATS = {
    "tower": "Washington Tower",
    "Washington Tower": "Washington Tower",
    "AAL123": "AAL123",
}
"""Seats of a run, by the names that stand for them."""


def test_a_seat_is_named_by_its_role_or_by_its_unit() -> None:
    for name in ("tower", "Washington Tower"):
        given: list[Agreed] = [(name, "voice"), ("AAL123", "words")]
        assert agreed_by_seat(given, SEATS) == {"Washington Tower": "voice", "AAL123": "words"}


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ([("ground", "voice")], "'ground': expected a seat that --seat names: tower, Washington"),
        (
            [("tower", "voice"), ("Washington Tower", "words")],
            "'Washington Tower': its seat is there twice",
        ),
    ],
)
def test_a_seat_that_nobody_may_take_or_that_is_there_twice_is_refused(
    given: list[Agreed], told: str
) -> None:
    with pytest.raises(click.UsageError, match=f"--agreed {told}"):
        agreed_by_seat(given, SEATS)
