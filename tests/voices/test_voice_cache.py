"""Lines are synthesised once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from airhilt.voices.engine import VoiceSpec
from tone import Tone, cached_tone

PILOT = VoiceSpec("pilot")


def test_a_line_is_synthesised_once_for_all_runs(tmp_path: Path) -> None:
    first, second = Tone(), Tone()
    said = cached_tone(tmp_path, first).synthesise("hello", PILOT)
    again = cached_tone(tmp_path, second).synthesise("hello", PILOT)
    assert said.tobytes() == again.tobytes()
    assert len(first.asked) == 1
    assert second.asked == []


def test_samples_are_the_same_with_and_without_a_cache(tmp_path: Path) -> None:
    cached = cached_tone(tmp_path, Tone())
    first, second = (cached.synthesise("hello", PILOT) for _ in range(2))
    assert first.dtype == second.dtype == np.float32
    assert np.array_equal(first, second)


@pytest.mark.parametrize(
    ("text", "voice", "version"),
    [
        ("good bye", PILOT, "1"),
        ("hello", VoiceSpec("tower"), "1"),
        ("hello", VoiceSpec("pilot", rate=1.1), "1"),
        ("hello", VoiceSpec("pilot", pitch=1.1), "1"),
        ("hello", PILOT, "2"),
    ],
)
def test_another_line_voice_or_version_is_another_sound(
    text: str, voice: VoiceSpec, version: str, tmp_path: Path
) -> None:
    cached_tone(tmp_path, Tone()).synthesise("hello", PILOT)
    engine = Tone(version)
    cached_tone(tmp_path, engine).synthesise(text, voice)
    assert len(engine.asked) == 1
