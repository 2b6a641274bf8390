"""The seats of a scenario by the names that stand for them."""

from __future__ import annotations

import pytest

from airhilt import load
from airhilt.errors import ScenarioError
from airhilt.scenario.seats import seats_of


@pytest.mark.parametrize("asked", [["tower"], ["Washington Tower"], ["tower", "Washington Tower"]])
def test_a_seat_is_asked_for_by_its_name_or_its_role(asked: list[str]) -> None:
    assert seats_of([*asked, "AAL123"], load("s01b_nominal")) == ("Washington Tower", "AAL123")


def test_a_seat_that_nobody_has_is_refused() -> None:
    with pytest.raises(ScenarioError, match="--seat 'nobody'"):
        seats_of(["nobody"], load("s01b_nominal"))
