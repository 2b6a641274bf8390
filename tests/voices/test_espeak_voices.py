"""The embedded voices."""

import hashlib
import subprocess
import sys

import pytest

from airhilt.errors import SpeechError
from airhilt.voices.engine import VoiceSpec
from airhilt.voices.engines.espeak import Espeak

CALL = "American one two three, runway zero one, cleared to land."


@pytest.fixture(scope="module")
def espeak() -> Espeak:
    return Espeak()


def test_the_same_words_give_the_same_samples_whatever_was_said_before(espeak: Espeak) -> None:
    voice = espeak.voice_of("DAL456")
    first = espeak.synthesise(CALL, voice)
    espeak.synthesise("Go around, I say again, go around.", espeak.voice_of("AAL123"))
    assert espeak.synthesise(CALL, voice).tobytes() == first.tobytes()


@pytest.mark.slow
def test_another_process_gives_the_same_samples(espeak: Espeak) -> None:
    program = (
        "import hashlib; from airhilt.voices.engines.espeak import Espeak; e = Espeak(); "
        f"print(hashlib.sha256(e.synthesise({CALL!r}, e.voice_of('DAL456')).tobytes()).hexdigest())"
    )
    there = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    here = hashlib.sha256(espeak.synthesise(CALL, espeak.voice_of("DAL456")).tobytes())
    assert there.stdout.strip() == here.hexdigest()


def test_speakers_keep_their_voices_and_have_different_ones(espeak: Espeak) -> None:
    speakers = ["Washington Tower", "AAL123", "DAL456", "OPS1", "N172SP", "assistant"]
    voices = [espeak.voice_of(speaker) for speaker in speakers]
    assert voices == [Espeak().voice_of(speaker) for speaker in speakers]
    assert len(set(voices)) == len(speakers)


def test_a_voice_that_is_not_there_is_named(espeak: Espeak) -> None:
    with pytest.raises(SpeechError, match="no-such-voice"):
        espeak.synthesise(CALL, VoiceSpec("no-such-voice"))
