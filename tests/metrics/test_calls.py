"""The numbers of the radio of a run."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import pytest

from airhilt.messages import HearingTruth, SpokenTruth, Transcript, Transmission
from airhilt.metrics.calls import CallRecords
from airhilt.metrics.summary import RadioStatistics
from airhilt.units import SECOND_NS

ROSTER = ("AAL123", "DAL456")
LANDING = "American one two three, runway zero one, cleared to land"


class OnTheAir:
    """Calls, one after the other."""

    def __init__(self) -> None:
        self.calls = CallRecords()
        self.count = 0

    def say(
        self,
        text: str,
        *heard: str,
        name: str | None = None,
        snr_db: float | None = None,
        blocked_by: tuple[Any, ...] = (),
        samples: int | None = 16_000,
        engine: str = "embedded",
        outcome: str | None = None,
    ) -> OnTheAir:
        self.count += 1
        name = name or f"call{self.count}"
        end_ns = self.count * 10 * SECOND_NS
        times = {
            "id": name, "frequency_khz": 119_100, "t_tx_ns": end_ns - SECOND_NS, "t_end_ns": end_ns,
        }  # fmt: skip
        said = SpokenTruth(
            **times, speaker="Tower", addressed="AAL123", text=text, snr_db=snr_db,
            blocked_by=blocked_by,
        )  # fmt: skip
        self.calls.take(said)
        if samples is not None:
            self.calls.take(Transmission(**times, snr_db=snr_db, samples=samples))
        for words in heard:
            transcript = Transcript(**times, text=words, confidence=0.9, engine=engine)
            self.calls.take(transcript)
        if outcome:
            hearing = HearingTruth(
                id=name, actor="AAL123", outcome=outcome, text=text, source="ear"
            )
            self.calls.take(hearing)
        return self

    def numbers(self, is_recognised: bool = True) -> RadioStatistics:
        return self.calls.statistics(ROSTER, is_recognised=is_recognised)


def test_text_that_nobody_recognised_measures_no_recognition() -> None:
    numbers = OnTheAir().say(LANDING, LANDING, engine="text", samples=0).numbers(False)
    assert numbers.transmissions == 1
    assert numbers.calls == 0
    assert numbers.wer is numbers.slot_accuracy is numbers.transcripts_missing is None


@pytest.mark.parametrize("engine", ["embedded", "whisper"])
def test_recognised_calls_are_compared_with_what_was_said(engine: str) -> None:
    right, wrong = LANDING.lower().replace(",", ""), "delta runway zero one cleared for takeoff"
    air = OnTheAir().say(LANDING, right, engine=engine).say(LANDING, wrong, engine=engine)
    numbers = air.numbers()
    assert (numbers.calls, numbers.words) == (2, 20)
    assert numbers.wer == pytest.approx(6 / 20)
    assert (numbers.callsign_accuracy, numbers.slot_accuracy) == (0.5, 0.75)
    assert numbers.false_slots == 1
    assert (numbers.snr_db, numbers.by_snr, numbers.transcripts_missing) == (None, [], 0)


def test_blocked_calls_are_counted_and_not_compared() -> None:
    air = OnTheAir().say(LANDING, "mumble", name="one", blocked_by=("two",))
    numbers = air.say(LANDING, name="two", blocked_by=("one",)).numbers()
    assert (numbers.transmissions, numbers.blocked, numbers.calls) == (2, 2, 0)
    assert numbers.transcripts_missing is None


def test_a_call_without_a_transcript_is_missing_unless_nobody_could_have_made_one() -> None:
    air = OnTheAir().say(LANDING, LANDING).say(LANDING).say(LANDING, samples=None)
    assert air.numbers().transcripts_missing == 1
    assert air.numbers(is_recognised=False).transcripts_missing is None


def test_words_of_a_stuck_microphone_are_hallucinated() -> None:
    silent = OnTheAir().say("", "").numbers()
    assert (silent.stuck_microphone, silent.hallucinated, silent.calls) == (1, 0, 0)
    assert OnTheAir().say("", "").say("", "cleared to land").numbers().hallucinated == 1
    assert OnTheAir().say("").numbers().hallucinated is None
    assert OnTheAir().say("", "cleared", blocked_by=("other",)).numbers().hallucinated is None


def test_outcomes_of_hearing_say_agains_and_repeats_are_counted() -> None:
    air = OnTheAir().say(LANDING, outcome="unsure", name="landing")
    air.say("Say again for American one two three", outcome="understood")
    air.say(LANDING, outcome="understood", name="landing.repeat-1")
    numbers = air.numbers()
    assert numbers.hearing == {"understood": 2, "unsure": 1}
    assert (numbers.say_agains, numbers.repeats) == (1, 1)


def test_one_ratio_is_that_of_all_and_several_are_told_apart() -> None:
    wrong = "delta four five six"
    same = OnTheAir().say(LANDING, LANDING, snr_db=5.0).say(LANDING, wrong, snr_db=5.0).numbers()
    assert (same.snr_db, same.by_snr) == (5.0, [])
    air = OnTheAir().say(LANDING, LANDING, snr_db=20.0).say(LANDING, wrong, snr_db=0.0)
    numbers = air.say(LANDING, LANDING).numbers()
    assert numbers.snr_db is None
    assert [(one.snr_db, one.calls) for one in numbers.by_snr] == [(0.0, 1), (20.0, 1), (None, 1)]
    assert [one.callsign_accuracy for one in numbers.by_snr] == [0.0, 1.0, 1.0]


def test_a_transcript_of_a_call_that_nobody_made_counts_for_nothing() -> None:
    air = OnTheAir()
    stray = Transcript(
        id="stray", frequency_khz=119_100, t_tx_ns=0, t_end_ns=0, text="hello", confidence=1.0,
        engine="embedded",
    )  # fmt: skip
    air.calls.take(stray)
    assert (air.numbers().transmissions, air.numbers().calls) == (0, 0)


def test_a_run_without_speech_does_not_load_what_compares_words() -> None:
    code = "import sys, airhilt.cosim.simulation; sys.exit('jiwer' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
