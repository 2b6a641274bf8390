"""Voices of the command ``flite``."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from airhilt.errors import SpeechError
from airhilt.voices.engine import VoiceSpec
from airhilt.voices.engines.flite import VOICES, Flite

needs_flite = pytest.mark.skipif(
    shutil.which("flite") is None, reason="no flite on PATH: apt install flite"
)


def test_without_the_command_the_error_says_how_to_get_it() -> None:
    with pytest.raises(SpeechError, match="apt install flite"):
        Flite("flite-that-is-not-installed")


@needs_flite
@pytest.mark.parametrize("name", VOICES)
def test_each_voice_speaks_the_same_every_time(name: str) -> None:
    first, second = (Flite().synthesise("hello tower", VoiceSpec(name)) for _ in range(2))
    assert first.dtype == np.float32
    assert 0.3 < len(first) / 16_000 < 3.0
    assert first.tobytes() == second.tobytes()


@needs_flite
def test_speakers_have_voices_that_stay_theirs() -> None:
    speakers = [f"AAL{number}" for number in range(20)]
    voices = [Flite().voice_of(speaker) for speaker in speakers]
    assert voices == [Flite().voice_of(speaker) for speaker in speakers]
    assert len(set(voices)) == len(voices)


@needs_flite
def test_rate_and_pitch_are_followed() -> None:
    engine = Flite()
    normal, fast, high = (
        engine.synthesise("cleared to land", voice)
        for voice in (VoiceSpec("slt"), VoiceSpec("slt", rate=1.3), VoiceSpec("slt", pitch=1.2))
    )
    assert len(fast) < 0.9 * len(normal)
    assert len(high) == len(normal)
    assert not np.array_equal(high, normal)


@needs_flite
def test_text_is_text_whatever_it_looks_like(tmp_path: Path) -> None:
    engine = Flite()
    for text in ("-o /dev/null", "$(touch x); hello", "/etc/hostname", "a\nb"):
        assert len(engine.synthesise(text, VoiceSpec("slt"))) > 1_600


def test_a_command_that_fails_is_named_with_what_it_said(tmp_path: Path) -> None:
    command = tmp_path / "flite"
    command.write_text("#!/bin/sh\necho 'out of voices' >&2\nexit 3\n")
    command.chmod(0o755)
    with pytest.raises(SpeechError, match=r"exit code 3: out of voices"):
        Flite(str(command)).synthesise("hello", VoiceSpec("slt"))
