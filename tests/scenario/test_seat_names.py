"""The seats of a scenario by the names that stand for them."""

from __future__ import annotations

import pytest

from airhilt import load
from airhilt.errors import ScenarioError
from airhilt.scenario.seats import named_seats


@pytest.mark.parametrize("asked", ["tower", "Washington Tower"])
def test_a_seat_has_its_own_name_and_that_of_its_role_however_it_is_asked_for(asked: str) -> None:
    assert named_seats([asked, "AAL123"], load("s01b_nominal")) == {
        "Washington Tower": "Washington Tower",
        "tower": "Washington Tower",
        "AAL123": "AAL123",
    }


def test_a_seat_that_nobody_has_is_refused() -> None:
    with pytest.raises(ScenarioError, match="--seat 'nobody'"):
        named_seats(["nobody"], load("s01b_nominal"))
