"""The synthesisers that speak training calls; those that are not installed are skipped."""

from __future__ import annotations

import json
import random
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import asr_speech
from airhilt.errors import SpeechError
from synthesisers import FAMILY, synthesiser
from synthesisers.synthesiser import InstalledFile, Synthesiser, Voice, speak

TEXT = "delta four five six turn left heading two seven zero."
NAMES = FAMILY.names()


def installed(name: str) -> Synthesiser:
    found: Synthesiser = FAMILY.load(name)
    if lacks := found.lacks():
        pytest.skip(lacks)
    return found


def seconds(samples: np.ndarray) -> float:
    """Return the length of speech without the silence at its ends."""
    audible = np.flatnonzero(np.abs(samples) > 0.01 * np.abs(samples).max())
    return float(audible[-1] - audible[0]) / 16_000


@pytest.mark.parametrize("name", NAMES)
def test_every_voice_names_its_lineage_and_speaker(name: str) -> None:
    member: Synthesiser = FAMILY.load(name)
    assert member.licence
    assert all(voice.lineage and voice.speaker for voice in member.voices)
    assert len({voice.name for voice in member.voices}) == len(member.voices)


def test_voices_of_a_speaker_have_that_speaker_in_every_synthesiser() -> None:
    of: dict[str, set[str]] = {}
    for name in NAMES:
        for voice in FAMILY.load(name).voices:
            of.setdefault(voice.speaker, set()).add(name)
    assert of["kal"] >= {"flite", "festival"}
    assert of["slt"] >= {"flite", "rhvoice"}
    assert of["awb"] >= {"flite", "rhvoice"}


@pytest.mark.parametrize("name", NAMES)
def test_rate_changes_the_duration(name: str) -> None:
    made_by = installed(name)
    talker = made_by.create()
    for voice in made_by.voices[:2]:
        slow, fast = (seconds(speak(talker, voice, TEXT, rate)) for rate in (120.0, 220.0))
        assert slow / fast == pytest.approx(220.0 / 120.0, rel=0.2), voice.name


@pytest.mark.parametrize("name", NAMES)
def test_a_call_sounds_the_same_whatever_was_said_before(name: str) -> None:
    made_by = installed(name)
    first, last = made_by.voices[0], made_by.voices[-1]
    talker = made_by.create()
    said = speak(talker, first, TEXT, 170.0, 1.1)
    speak(talker, last, "tower, runway two six left.", 210.0, 0.9)
    assert np.array_equal(speak(talker, first, TEXT, 170.0, 1.1), said)
    assert np.array_equal(speak(made_by.create(), first, TEXT, 170.0, 1.1), said)


def test_timbres_of_noise_sound_the_same_every_time() -> None:
    made_by = synthesiser("espeak")
    talker = made_by.create()
    for voice in made_by.choose("en-us+Reed,en-us+caleb"):
        first, again = (speak(talker, voice, TEXT, 170.0) for _ in range(2))
        assert np.array_equal(first, again), voice.name


def spoken(
    made_by: Synthesiser, voices: Sequence[Voice], count: int, *, held_out_names: bool = False
) -> list[tuple[dict[str, Any], NDArray[np.int16]]]:
    rng = random.Random(5)
    calls = asr_speech.made_up(count, rng, held_out_names=held_out_names)
    return list(asr_speech.speech(made_by, voices, calls, rng))


def test_the_same_seed_gives_the_same_calls() -> None:
    made_by = synthesiser("espeak")
    first, again = (spoken(made_by, made_by.voices, 3) for _ in range(2))
    assert [about for about, _ in first] == [about for about, _ in again]
    assert all(np.array_equal(one[1], other[1]) for one, other in zip(first, again, strict=True))


def test_voices_take_turns() -> None:
    made_by = synthesiser("espeak")
    voices = made_by.voices[:3]
    said = [about["voice"] for about, _ in spoken(made_by, voices, 6)]
    assert sorted(said) == sorted(voice.name for voice in voices for _ in range(2))


def test_shards_say_who_speaks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        sys, "argv", ["", str(tmp_path), "espeak", "--voices", "unseen", "--count", "2"]
    )
    asr_speech.main()
    shard = tmp_path / "espeak-unseen-0-000.jsonl"
    lines = [json.loads(line) for line in shard.read_text().splitlines()]
    assert {line["engine"] for line in lines} == {"espeak"}
    assert {line["lineage"] for line in lines} == {"espeak"}
    assert all(120.0 <= line["words_per_minute"] <= 220.0 for line in lines)
    samples = np.load(tmp_path / "espeak-unseen-0-000.npy")
    assert samples.dtype == np.int16
    assert len(samples) == sum(line["samples"] for line in lines)


def test_calls_of_a_file_are_spoken_and_keep_what_they_mean(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[dict[str, Any]] = [
        {"text": "delta two roger", "callsign": "DAL2", "items": []},
        {"text": "wind calm", "callsign": None, "items": [{"kind": "wind"}]},
    ]
    exam = tmp_path / "exam.jsonl"
    exam.write_text("".join(f"{json.dumps(call)}\n" for call in calls))
    monkeypatch.setattr(sys, "argv", ["", str(tmp_path / "out"), "espeak", "--calls", str(exam)])
    asr_speech.main()
    lines = (tmp_path / "out" / "espeak-exam-0-000.jsonl").read_text().splitlines()
    assert len(lines) == 2
    for call, line in zip(calls, lines, strict=True):
        about = json.loads(line)
        assert {name: about[name] for name in call} == call


def test_held_out_names_are_in_a_set_of_their_own() -> None:
    made_by = synthesiser("espeak")
    words = [
        {
            word
            for about, _ in spoken(made_by, made_by.voices[:1], 12, held_out_names=held_out)
            for word in about["text"].split()
        }
        for held_out in (False, True)
    ]
    assert words[0] != words[1]
    assert asr_speech.stem("espeak", "all", "names") == "espeak-all-names"


def test_unseen_voices_are_no_seen_ones() -> None:
    made_by = synthesiser("espeak")
    seen, unseen = set(made_by.choose("seen")), set(made_by.choose("unseen"))
    assert seen
    assert unseen
    assert not seen & unseen
    assert seen | unseen == set(made_by.choose("all"))


def test_voices_for_tests_only_are_not_among_all() -> None:
    for name in NAMES:
        member: Synthesiser = FAMILY.load(name)
        free = [voice for voice in member.voices if not voice.is_test_only]
        if free:
            assert list(member.choose("all")) == free
        else:
            with pytest.raises(SpeechError, match="test-only"):
                member.choose("all")


def test_a_missing_synthesiser_says_how_to_install_it(tmp_path: Path) -> None:
    absent = Synthesiser(
        "absent",
        "free",
        (Voice("one", "none", "nobody", 100.0),),
        create=lambda: pytest.fail("it was started"),
        requires=(InstalledFile(tmp_path / "voice", "absent-voices"),),
    )
    assert absent.lacks() == "apt install absent-voices"


def test_an_unknown_voice_is_an_error_that_names_known_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["", str(tmp_path), "espeak", "--voices", "nobody"])
    with pytest.raises(SystemExit) as ended:
        asr_speech.main()
    assert ended.value.code == 2
    assert "nobody" in capsys.readouterr().err
