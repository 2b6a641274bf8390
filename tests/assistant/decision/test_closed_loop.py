"""Advice to crews that act: what is safe without it stays safe with it, whatever the other does."""

from __future__ import annotations

import numpy as np
import pytest

from airhilt.assistant.decision.engine import Decision
from airhilt.assistant.decision.engines.reference import ReferenceEngine
from airhilt.assistant.decision.engines.tcas import TcasEngine
from airhilt.messages import Climb
from breadth import mostly_slow
from pairs.closed_loop import Crews, Manner, fly, fly_on
from pairs.geometry import draw_close

LEAST_S = 35.0
"""Time to the closest approach, in s, in which a crew can be told, respond, and move 100 ft."""
MANNERS: list[tuple[Manner, Manner]] = [
    ("follows", "follows"), ("follows", "ignores"), ("follows", "opposite"),
    ("opposite", "follows"),
]  # fmt: skip


@pytest.mark.parametrize("number", mostly_slow(range(60), *range(6)))
@pytest.mark.parametrize("manners", MANNERS)
def test_no_pass_that_is_safe_without_advice_becomes_a_near_collision(
    manners: tuple[Manner, Manner], number: int
) -> None:
    encounter = draw_close(np.random.default_rng((43, number)))
    flown = fly(encounter, ReferenceEngine(), Crews("icao", manners), number)
    assert fly_on(encounter).is_nmac or not flown.is_nmac


@pytest.mark.parametrize("number", mostly_slow(range(60), *range(12)))
def test_who_follows_gets_past_in_time_even_if_the_other_does_nothing(number: int) -> None:
    encounter = draw_close(np.random.default_rng((44, number)))
    if encounter.first.closest_s < LEAST_S:
        pytest.skip("There is no time left.")
    flown = fly(encounter, ReferenceEngine(), Crews("icao", ("follows", "ignores")), number)
    assert not flown.is_nmac


class WatchedTcas(TcasEngine):
    """TCAS II that fails as soon as it sends both the same way."""

    def __init__(self) -> None:
        super().__init__()
        self.senses: dict[str, str] = {}

    def decide(self, t_ns: int) -> Decision:
        """Return what the units decide."""
        decision = super().decide(t_ns)
        for alert in decision.alerts:
            callsign = alert.recipients[0]
            told = alert.recommendations.get(callsign)
            if isinstance(told, Climb):
                self.senses[callsign] = told.sense
            elif not alert.active:
                self.senses.pop(callsign, None)
        assert len(set(self.senses.values())) == len(self.senses)
        return decision


@pytest.mark.parametrize("number", mostly_slow(range(60), *range(12)))
@pytest.mark.parametrize("manners", MANNERS)
def test_tcas_sends_two_opposite_ways_whatever_they_do(
    manners: tuple[Manner, Manner], number: int
) -> None:
    encounter = draw_close(np.random.default_rng((45, number)))
    flown = fly(encounter, WatchedTcas(), Crews("icao", manners), number)
    if manners == ("follows", "follows"):
        assert fly_on(encounter).is_nmac or not flown.is_nmac
