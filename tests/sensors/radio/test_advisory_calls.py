"""Advisories on a frequency take turns, and reach whoever is in reach."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from airhilt.messages import Advisory, AdvisoryAudio, Evidence, HearingTruth, Severity, Turn
from airhilt.sensors.radio.advisory_calls import AdvisoryCalls, AdvisoryChannel
from airhilt.sensors.radio.frequency_arbiter import FrequencyArbiter
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sensors.radio.transmissions import Transmissions
from airhilt.sim import Director, Virtual
from airhilt.units import SECOND_NS
from airhilt.world.actors.advisory_delivery import AdvisoryDelivery
from conversations import radio_context


def advisory(
    identity: str, recipient: str = "AAL123", revision: int = 0,
    severity: Severity = Severity.CAUTION, active: bool = True,
) -> Advisory:  # fmt: skip
    return Advisory(
        id=identity, revision=revision, recipient=recipient, recipients=(recipient,),
        kind="runway_conflict", severity=severity, active=active, traffic=(recipient,),
        message=f"{recipient} {identity}", evidence=Evidence(sources=("adsb",)), t_ready_ns=0,
    )  # fmt: skip


def audio(revision: int = 0) -> AdvisoryAudio:
    return AdvisoryAudio(
        id="a", revision=revision, recipient="AAL123", text="spoken", t_dec_ns=0, engine="x",
        samples=2, sha256="",
    )  # fmt: skip


class Frequency:
    """Advisory calls on one frequency, each of which takes a second once it is let on the air."""

    def __init__(self, is_voiced: bool = False) -> None:
        self.director = Director(Virtual())
        self.said: list[Utterance] = []
        self.heard: list[tuple[Any, ...]] = []
        """Advisories that were heard, each with the time in s from the beginning of its words."""
        self.hearings: list[Any] = []
        self.in_reach = True
        delivery = SimpleNamespace(begin=self._begin)
        transmissions = SimpleNamespace(reaches=lambda on_air, listener: self.in_reach)
        context = radio_context(
            director=self.director,
            stations=SimpleNamespace(frequency_of=lambda name: 119_100),
            publish=lambda key, message, **_: self.hearings.append(message),
        )
        self.calls = AdvisoryCalls(
            context,
            {"AAL123": "AAL123", "a1b2c3": "AAL123", "DAL456": "DAL456"},
            AdvisoryChannel(is_voiced, Severity.CAUTION, cast(AdvisoryDelivery, delivery)),
            cast(FrequencyArbiter, SimpleNamespace(say=self.said.append)),
            cast(Transmissions, transmissions),
        )

    def _begin(self, advisory: Advisory, after_s: float, is_heard: Any) -> None:
        if is_heard():
            self.heard.append((advisory.id, advisory.revision, advisory.recipient, after_s))

    def end(self) -> None:
        """Let the last one begin and end, and the pause after it pass."""
        now_ns = self.director.now_ns
        on_air = OnAir(self.said[-1], now_ns, now_ns + SECOND_NS, None)
        self.calls.began(on_air)
        self.calls.ended(on_air)
        self.director.run()

    @property
    def texts(self) -> list[str]:
        return [said.text for said in self.said]


def test_the_next_one_waits_for_its_turn_and_the_most_urgent_comes_first() -> None:
    frequency = Frequency()
    for one in (advisory("a"), advisory("b"), advisory("c", "DAL456", severity=Severity.WARNING)):
        frequency.calls.take(one, b"")
    assert frequency.texts == ["AAL123 a"]
    frequency.end()
    frequency.end()
    assert frequency.texts == ["AAL123 a", "DAL456 c", "AAL123 b"]


def test_what_is_outdated_at_its_turn_is_not_said() -> None:
    frequency = Frequency()
    messages = (advisory("a"), advisory("b"), advisory("c"), advisory("c", revision=1),
                advisory("b", revision=1, active=False))  # fmt: skip
    for one in messages:
        frequency.calls.take(one, b"")
    frequency.end()
    frequency.end()
    assert [said.id for said in frequency.said] == ["advisory.a.0.AAL123", "advisory.c.1.AAL123"]


def test_its_recipient_has_heard_it_when_it_has_ended_if_it_is_in_reach() -> None:
    frequency = Frequency()
    frequency.calls.take(advisory("a", "a1b2c3"), b"")
    assert frequency.heard == []
    frequency.end()
    assert frequency.heard == [("a", 0, "a1b2c3", 1.0)]
    frequency.in_reach = False
    frequency.calls.take(advisory("b"), b"")
    frequency.end()
    assert len(frequency.heard) == 1
    hearings = [(one.actor, one.outcome) for one in frequency.hearings]
    assert hearings == [("AAL123", "understood"), ("AAL123", "missed")]
    assert all(isinstance(one, HearingTruth) for one in frequency.hearings)


def test_its_recipient_gets_it_once_callsign_and_instruction_have_been_said() -> None:
    for text, after_s in (
        ("AAL123 turn left 20 degrees", 1.0),
        ("AAL123 turn left 20 degrees. " + 26 * "x", 0.5),
        ("turn left 20 degrees, AAL123 " + 27 * "x", 0.5),
    ):
        frequency = Frequency()
        turn = {"message": text, "recommendation": Turn(degrees=-20.0)}
        frequency.calls.take(advisory("a").model_copy(update=turn), b"")
        frequency.end()
        assert frequency.heard == [("a", 0, "AAL123", pytest.approx(after_s, abs=0.02))]


def test_nothing_is_said_to_the_controller_or_below_a_caution() -> None:
    frequency = Frequency()
    frequency.calls.take(advisory("a", "ATC"), b"")
    frequency.calls.take(advisory("b", severity=Severity.ADVISORY), b"")
    assert frequency.said == []


def test_a_voice_is_transmitted_as_it_was_spoken() -> None:
    frequency = Frequency(is_voiced=True)
    frequency.calls.take(advisory("a"), b"")
    assert frequency.said == []
    frequency.calls.take(audio(), b"\x00\x40\x00\x40")
    (said,) = frequency.said
    assert said.text == "spoken"
    assert said.speech is not None
    assert len(said.speech) == 2


def test_the_voice_of_an_older_revision_is_not_transmitted() -> None:
    frequency = Frequency(is_voiced=True)
    frequency.calls.take(advisory("a"), b"")
    frequency.calls.take(advisory("a", revision=1), b"")
    frequency.calls.take(audio(), b"\x00\x40\x00\x40")
    assert frequency.said == []
