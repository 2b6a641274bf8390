"""A call that goes on may warn before its end, and is believed only as far as it is certain."""

from __future__ import annotations

import pytest

from airfield import BRIEFING
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import ReceivedMessage
from airhilt.assistant.decision.engines.reference import ReferenceEngine
from airhilt.messages import Message, PartialTranscript
from airhilt.units import SECOND_NS
from decisions import transcript

KHZ = 119_100
BEGINS_NS = 20 * SECOND_NS
LANDING = "American 123, runway one niner, cleared to land."
TAKEOFF = "Delta 456, runway zero one, cleared for takeoff"


class Frequency:
    """An engine that has heard AAL123 being cleared to land on runway 19, and hears a call to
    DAL456 word for word."""

    def __init__(self) -> None:
        self.engine = ReferenceEngine()
        self.t_ns = 10 * SECOND_NS
        self._told(BRIEFING, transcript("landing", KHZ, 7 * SECOND_NS, self.t_ns, LANDING))
        self.t_ns = BEGINS_NS

    def part(self, text: str, name: str = "takeoff") -> list[Alert]:
        """Hear half a second more of a call; return what is told because of that."""
        self.t_ns += SECOND_NS // 2
        heard = transcript(name, KHZ, BEGINS_NS, self.t_ns, text)
        same = {"id", "frequency_khz", "t_tx_ns", "text", "words", "confidence", "engine"}
        given = heard.model_dump(include=same) | {"t_heard_ns": self.t_ns, "stable_words": 0}
        return self._told(PartialTranscript.model_validate(given))

    def whole(self, text: str) -> list[Alert]:
        """Hear the whole call; return what is told because of that."""
        self.t_ns += SECOND_NS // 2
        return self._told(transcript("takeoff", KHZ, BEGINS_NS, self.t_ns, text))

    def passes(self, seconds: float) -> list[Alert]:
        """Let time pass; return what is told because of that."""
        self.t_ns += round(seconds * SECOND_NS)
        return self._told()

    def _told(self, *messages: Message) -> list[Alert]:
        for each in messages:
            self.engine.receive(ReceivedMessage(each, self.t_ns, self.t_ns))
        return list(self.engine.decide(self.t_ns).alerts)


def test_an_instruction_that_is_certain_in_two_parts_of_a_call_warns_before_its_end() -> None:
    frequency = Frequency()
    assert frequency.part("Delta 456, runway zero one") == []
    assert frequency.part(TAKEOFF) == []
    (alert,) = frequency.part(f"{TAKEOFF}, wind")
    assert (alert.severity, alert.active) == ("CAUTION", True)
    assert alert.evidence.rules == ("opposed_clearances", "provisional_instruction")
    assert set(alert.evidence.radio_ids) == {"landing", "takeoff"}


def test_the_whole_call_confirms_it_and_nothing_is_said_twice() -> None:
    frequency = Frequency()
    frequency.part(TAKEOFF)
    assert frequency.part(TAKEOFF)
    assert frequency.whole(f"{TAKEOFF}, wind calm.") == []
    assert frequency.passes(1.0) == []
    whole = Frequency().whole(TAKEOFF)
    assert [alert.evidence.rules for alert in whole] == [("opposed_clearances",)]


@pytest.mark.parametrize(
    "ending",
    ["correction, runway one niner, cleared for takeoff.", "negative, hold position.",
     "disregard."],
)  # fmt: skip
def test_a_call_that_takes_it_back_withdraws_the_advisory_at_once(ending: str) -> None:
    frequency = Frequency()
    frequency.part(TAKEOFF)
    (warned,) = frequency.part(TAKEOFF)
    (withdrawn,) = frequency.part(f"{TAKEOFF}, {ending.split()[0]}")
    assert (withdrawn.id, withdrawn.active) == (warned.id, False)
    frequency = Frequency()
    frequency.part(TAKEOFF)
    (warned,) = frequency.part(TAKEOFF)
    (withdrawn,) = frequency.whole(f"{TAKEOFF}, {ending}")
    assert (withdrawn.id, withdrawn.active) == (warned.id, False)


@pytest.mark.parametrize(
    "text",
    [
        "Delta? 456?, runway zero one, cleared for takeoff",
        "Delta 456, runway zero? one?, cleared for takeoff",
        "Delta 456, runway zero one, cleared? for? takeoff?",
        "runway zero one, cleared for takeoff",
        "Delta 456, correction, runway zero one, cleared for takeoff",
    ],
)
def test_what_is_in_doubt_or_has_no_callsign_is_not_believed_before_the_end(text: str) -> None:
    frequency = Frequency()
    assert [frequency.part(text) for _ in range(4)] == [[], [], [], []]


def test_a_value_that_changes_from_one_part_to_the_next_is_not_believed() -> None:
    frequency = Frequency()
    assert frequency.part("Delta 456, cleared for takeoff runway zero") == []
    assert frequency.part("Delta 456, cleared for takeoff runway zero one") == []
    assert frequency.part("Delta 456, cleared for takeoff runway one niner") == []
    assert frequency.part("Delta 456, cleared for takeoff runway one niner") == []


def test_an_instruction_whose_callsign_changes_is_not_believed() -> None:
    frequency = Frequency()
    assert frequency.part("Ops one, runway zero one, cleared for takeoff") == []
    assert frequency.part(TAKEOFF) == []


def test_a_call_that_goes_on_takes_no_threat_away() -> None:
    frequency = Frequency()
    assert frequency.whole(TAKEOFF)
    for _ in range(20):
        assert frequency.part("American 123, go around", "go_around") == []


def test_a_call_whose_whole_words_never_come_is_forgotten() -> None:
    frequency = Frequency()
    frequency.part(TAKEOFF)
    (warned,) = frequency.part(TAKEOFF)
    assert frequency.passes(9.0) == []
    (withdrawn,) = frequency.passes(2.0)
    assert (withdrawn.id, withdrawn.active) == (warned.id, False)


def test_a_part_that_comes_after_the_whole_call_says_nothing() -> None:
    frequency = Frequency()
    frequency.whole("Delta 456, runway zero one, line up and wait, correction, hold position.")
    assert [frequency.part(TAKEOFF) for _ in range(3)] == [[], [], []]
