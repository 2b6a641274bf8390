"""The way from nothing to the recogniser that ships."""

from __future__ import annotations

import argparse
from pathlib import Path

import pytest

import make_recogniser
from synthesisers import FAMILY
from training import add_options, options_of


def test_no_voice_that_is_for_tests_alone_is_trained() -> None:
    for spoken in make_recogniser.SPOKEN:
        voices = FAMILY.load(spoken.synthesiser).choose(spoken.voices)
        assert voices
        assert not any(voice.is_test_only for voice in voices)


def test_every_lineage_that_may_be_trained_is() -> None:
    def lineages(names: list[str]) -> set[str]:
        voices = (voice for name in names for voice in FAMILY.load(name).voices)
        return {voice.lineage for voice in voices if not voice.is_test_only}

    assert lineages([each.synthesiser for each in make_recogniser.SPOKEN]) == lineages(
        list(FAMILY.names())
    )


@pytest.mark.parametrize(
    "arguments", ["", "--bfloat16 --device cuda --seed 7", "--minutes 3.5 --steps 10 --adamw"]
)
def test_the_training_gets_the_options_that_were_given(arguments: str) -> None:
    parser = argparse.ArgumentParser()
    add_options(parser, 9_000, rate=2e-3)
    given = parser.parse_args(arguments.split())
    assert parser.parse_args(options_of(vars(given))) == given


def test_speech_that_was_made_is_kept_and_all_else_is_made(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    ran: list[tuple[str, ...]] = []
    monkeypatch.setattr(make_recogniser, "run", lambda *arguments: ran.append(arguments))
    (tmp_path / "train").mkdir()
    (tmp_path / "train" / "espeak-all-103-000.npy").touch()
    (tmp_path / "train" / "espeak-all-104-000.jsonl").touch()
    make_recogniser.Maker(tmp_path, 0.01).speak(2)
    spoken = {(call[2], call[6]) for call in ran if call[0] == "asr_speech.py"}
    assert ("espeak", 103) not in spoken
    assert {("espeak", 104), ("piper", 200), ("flite", make_recogniser.DEV_SEED)} <= spoken
    assert len((tmp_path / "second_exam.jsonl").read_text().splitlines()) == 4


def test_no_more_is_spoken_when_a_synthesiser_fails(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    ran: list[str] = []

    def fail(tool: str, *_: object) -> None:
        ran.append(tool)
        raise SystemExit(f"{tool} failed")

    monkeypatch.setattr(make_recogniser, "run", fail)
    with pytest.raises(SystemExit, match="failed"):
        make_recogniser.Maker(tmp_path, 0.01).speak(1)
    assert len(ran) == 1


def test_it_ends_at_a_tool_that_fails(capfd: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match=r"mel_shards\.py failed"):
        make_recogniser.run("mel_shards.py", "--no-such-option", tmp_path)
    printed = capfd.readouterr().out
    assert printed.startswith("$ python tools/asr/mel_shards.py --no-such-option")
