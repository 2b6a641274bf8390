"""Offers of commands at a seat, one after another."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from airhilt.commands import TrackCommand
from airhilt.messages import CommandOffer, Message
from airhilt.sensors.radio.offers import MOST_OFFERS, Offers


@pytest.fixture
def told() -> list[CommandOffer]:
    return []


@pytest.fixture
def make(told: list[CommandOffer]) -> Callable[[str, float], None]:
    """Offer the person at a seat a track in degrees."""

    def publish(key: str, message: Message, *, raw: bytes | None = None) -> None:
        assert raw is None
        assert isinstance(message, CommandOffer)
        assert key == f"offer/{message.seat}"
        told.append(message)

    offers = Offers(publish, lambda: 0)

    def offer(seat: str, track_deg: float) -> None:
        offers.make(seat, "a-call", TrackCommand(action="track", track_deg=track_deg))

    return offer


def still_open(told: list[CommandOffer], seat: str) -> list[int]:
    """Return the numbers of the offers at a seat that are not over."""
    newest = {one.number: one for one in told if one.seat == seat}
    return [number for number, one in newest.items() if not one.is_over]


def test_the_newest_commands_are_offered_and_the_oldest_gives_way_at_its_own_seat_alone(
    told: list[CommandOffer], make: Callable[[str, float], None]
) -> None:
    make("OPS2", 0.0)
    for track_deg in range(MOST_OFFERS + 1):
        make("OPS1", float(track_deg))
    assert still_open(told, "OPS1") == list(range(3, 3 + MOST_OFFERS))
    assert still_open(told, "OPS2") == [1]


def test_a_command_that_another_call_has_as_well_is_offered_once(
    told: list[CommandOffer], make: Callable[[str, float], None]
) -> None:
    for track_deg in (90.0, 180.0, 90.0):
        make("OPS1", track_deg)
    assert still_open(told, "OPS1") == [2, 3]
