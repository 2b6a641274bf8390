"""Audio as PCM and as WAV files."""

from __future__ import annotations

import io
import wave
from pathlib import Path

import numpy as np
import pytest

from airhilt.audio.pcm import from_pcm, to_pcm
from airhilt.audio.wav import read_wav, write_wav
from airhilt.errors import SpeechError

TONE = np.sin(np.arange(1_600) / 5).astype(np.float32) * np.float32(0.5)


def wav(rate: int = 16_000, channels: int = 1, width: int = 2, frames: int = 100) -> bytes:
    stream = io.BytesIO()
    with wave.open(stream, "wb") as file:
        file.setparams((channels, width, rate, frames, "NONE", ""))
        file.writeframes(bytes(frames * channels * width))
    return stream.getvalue()


def test_a_file_gives_back_what_was_written(tmp_path: Path) -> None:
    write_wav(tmp_path / "a.wav", TONE)
    assert np.abs(read_wav(tmp_path / "a.wav") - TONE).max() <= 0.5 / 32_768


def test_pcm_survives_being_read_and_written() -> None:
    pcm = np.arange(-32_768, 32_768, dtype="<i2").tobytes()
    assert to_pcm(from_pcm(pcm)) == pcm


def test_what_is_too_loud_is_clipped_and_not_wrapped() -> None:
    assert from_pcm(to_pcm(np.array([2.0, -2.0], np.float32))).tolist() == [32_767 / 32_768, -1.0]


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_samples_that_are_no_numbers_are_refused(bad: float, tmp_path: Path) -> None:
    audio = TONE.copy()
    audio[7] = bad
    with pytest.raises(SpeechError, match=f"audio with {bad} at sample 7"):
        write_wav(tmp_path / "a.wav", audio)
    assert not (tmp_path / "a.wav").exists()


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (wav(rate=44_100), "44100 Hz, mono, 16 bits; expected 16000 Hz, mono, 16 bits"),
        (wav(channels=2), "16000 Hz, 2 channels, 16 bits"),
        (wav(width=1), "16000 Hz, mono, 8 bits"),
        (wav(frames=0), "without samples"),
        (wav()[:-20], "truncated: 90 samples; its header promises 100"),
        (wav()[:30], "no WAV file"),
        (wav()[:17] + b"\x01" + wav()[18:], "no WAV file"),
        (b"", "no WAV file"),
        (b"ID3\x03 this is an mp3", "no WAV file"),
    ],
)
def test_another_file_is_refused_with_what_it_is(data: bytes, said: str, tmp_path: Path) -> None:
    path = tmp_path / "other.wav"
    path.write_bytes(data)
    with pytest.raises(SpeechError) as refused:
        read_wav(path)
    assert str(path) in str(refused.value)
    assert said in str(refused.value)


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(SpeechError, match=r"gone\.wav: cannot be read"):
        read_wav(tmp_path / "gone.wav")


def test_a_place_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(SpeechError, match=r"a\.wav: cannot be written"):
        write_wav(tmp_path / "no" / "folder" / "a.wav", TONE)
