"""A call that goes on may warn before its end, and is believed only as far as it is certain."""

from __future__ import annotations

import pytest

from airfield import BRIEFING
from airhilt.messages import Advisory, PartialTranscript, Word
from airhilt.sim import Input
from airhilt.units import SECOND_NS
from decisions import UNSURE, reference, transcript

KHZ = 119_100
HALF_SECOND_NS = SECOND_NS // 2
BEGINS_NS = 20 * SECOND_NS
LANDING = "American 123, runway one niner, cleared to land."
TAKEOFF = "Delta 456, runway zero one, cleared for takeoff"


class Frequency:
    """A worker that has heard AAL123 being cleared to land on runway 19, and hears a call to DAL456
    word for word."""

    def __init__(self) -> None:
        self.worker = reference()
        self.told: list[Advisory] = []
        self.t_ns = 10 * SECOND_NS
        self._give("briefing", BRIEFING.model_dump_json())
        landing = transcript("landing", KHZ, 7 * SECOND_NS, self.t_ns, LANDING)
        self._give(f"asr/{KHZ}", landing.model_dump_json())
        self.t_ns = BEGINS_NS

    def part(self, text: str, name: str = "takeoff") -> list[Advisory]:
        """Hear half a second more of a call; return what is told because of that."""
        self.t_ns += HALF_SECOND_NS
        partial = PartialTranscript(
            id=name,
            frequency_khz=KHZ,
            t_tx_ns=BEGINS_NS,
            t_heard_ns=self.t_ns,
            text=text.replace("?", ""),
            words=tuple(
                Word(text=word.replace("?", ""), confidence=UNSURE if "?" in word else 1.0)
                for word in text.split()
            ),
            confidence=1.0,
            stable_words=0,
            engine="text",
        )
        return self._give(f"asr/{KHZ}/partial", partial.model_dump_json())

    def whole(self, text: str) -> list[Advisory]:
        """Hear the whole call; return what is told because of that."""
        self.t_ns += HALF_SECOND_NS
        heard = transcript("takeoff", KHZ, BEGINS_NS, self.t_ns, text)
        return self._give(f"asr/{KHZ}", heard.model_dump_json())

    def passes(self, seconds: float) -> list[Advisory]:
        """Let time pass; return what is told because of that."""
        self.t_ns += round(seconds * SECOND_NS)
        return self._told([])

    def _give(self, key: str, payload: str) -> list[Advisory]:
        return self._told([Input(key, self.t_ns, payload.encode())])

    def _told(self, inputs: list[Input]) -> list[Advisory]:
        outputs = self.worker.step(self.t_ns, inputs).outputs
        return [
            advisory
            for output in outputs
            if (advisory := Advisory.model_validate_json(output.payload)).recipient == "ATC"
        ]


def test_an_instruction_that_is_certain_in_two_parts_of_a_call_warns_before_its_end() -> None:
    frequency = Frequency()
    assert frequency.part("Delta 456, runway zero one") == []
    assert frequency.part(TAKEOFF) == []
    (advisory,) = frequency.part(f"{TAKEOFF}, wind")
    assert (advisory.severity, advisory.active) == ("CAUTION", True)
    assert advisory.evidence.rules == ("opposed_clearances", "provisional_instruction")
    assert set(advisory.evidence.radio_ids) == {"landing", "takeoff"}


def test_the_whole_call_confirms_it_and_nothing_is_said_twice() -> None:
    frequency = Frequency()
    frequency.part(TAKEOFF)
    assert frequency.part(TAKEOFF)
    assert frequency.whole(f"{TAKEOFF}, wind calm.") == []
    assert frequency.passes(1.0) == []
    whole = Frequency().whole(TAKEOFF)
    assert [advisory.evidence.rules for advisory in whole] == [("opposed_clearances",)]


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
