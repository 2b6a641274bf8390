"""A channel that a user has trained himself."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from airhilt.errors import SpeechError
from airhilt.host import onnx
from airhilt.sensors.radio.channel import Other, active
from airhilt.sensors.radio.learned_channel import LearnedChannel
from large_networks import write_large, write_long
from paths import DATA

CHANNELS = DATA / "channels"


def speech() -> np.ndarray:
    times = np.arange(24_000) / 16_000
    return (0.3 * np.sin(2 * np.pi * 700 * times) * (times % 0.5 < 0.35)).astype(np.float32)


def echo() -> LearnedChannel:
    return LearnedChannel(CHANNELS / "echo.onnx")


def test_a_model_that_never_ends_is_stopped() -> None:
    with pytest.raises(SpeechError, match=r"endless\.onnx: the model does not end within 0\.5 s"):
        LearnedChannel(CHANNELS / "endless.onnx", limit_s=0.5)


def test_a_model_that_takes_too_much_memory_is_refused(tmp_path: Path) -> None:
    write_large(tmp_path / "large.onnx", numbers=100_000_000_000)
    with pytest.raises(SpeechError, match=r"large\.onnx: .*(no ONNX model|fails).*memory"):
        LearnedChannel(tmp_path / "large.onnx")


def test_a_model_that_takes_too_long_to_load_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(onnx, "LONGEST_LOAD_S", 0.05)
    write_long(tmp_path / "long.onnx", nodes=20_000)
    with pytest.raises(SpeechError, match=r"long\.onnx: no ONNX model .* canceled"):
        LearnedChannel(tmp_path / "long.onnx")


def test_a_model_in_a_file_that_is_too_large_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "large.onnx"
    path.touch()
    os.truncate(path, onnx.LARGEST_FILE_BYTES + 1)
    with pytest.raises(SpeechError, match=r"large\.onnx: has over 500,000,000 bytes"):
        LearnedChannel(path)


def test_what_is_heard_went_through_the_model() -> None:
    heard = echo().transmit(speech(), None, np.random.default_rng(0))
    assert echo().name == "echo"
    assert heard.shape == speech().shape
    assert heard.dtype == np.float32
    assert abs(np.corrcoef(heard, speech())[0, 1]) > 0.9
    assert not np.allclose(
        heard / np.abs(heard).max(), speech() / np.abs(speech()).max(), atol=0.01
    )


@pytest.mark.parametrize("snr_db", [-3.0, 10.0, 30.0])
def test_noise_is_at_the_ratio_asked_for(snr_db: float) -> None:
    channel = echo()
    speaks = active(speech())
    noise = channel.transmit(speech(), snr_db, np.random.default_rng(1)) - channel.transmit(
        speech(), None, np.random.default_rng(1)
    )
    clean = channel.transmit(speech(), None, np.random.default_rng(1))
    measured_db = 10 * np.log10(np.mean(clean[speaks] ** 2) / np.mean(noise[speaks] ** 2))
    assert measured_db == pytest.approx(snr_db, abs=0.5)


def test_the_voice_itself_may_be_mixed_in() -> None:
    dry = echo().transmit(speech(), 0.0, np.random.default_rng(0), wet=0.0)
    assert np.corrcoef(dry, speech())[0, 1] > 0.999


def test_the_same_seed_gives_the_same_bytes() -> None:
    first, second = (echo().transmit(speech(), 5.0, np.random.default_rng(3)) for _ in range(2))
    assert first.tobytes() == second.tobytes()


def test_who_talks_at_the_same_time_is_heard() -> None:
    alone = echo().transmit(speech(), None, np.random.default_rng(0))
    both = echo().transmit(
        speech(), None, np.random.default_rng(0), [Other(speech(), 8_000, 800.0)]
    )
    assert np.array_equal(alone[:8_000], both[:8_000])
    assert np.abs(both[8_000:] - alone[8_000:]).max() > 0.05


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("twice_as_long.onnx", "makes [1, 3200] of [1, 1600]"),
        ("one_second.onnx", "fails on 1600 samples"),
        ("whole_numbers.onnx", "int64"),
        ("no_numbers.onnx", "no numbers (NaN)"),
        ("absent.onnx", "no such file"),
    ],
)
def test_a_model_of_another_kind_is_refused_by_name(name: str, said: str) -> None:
    with pytest.raises(SpeechError) as refused:
        LearnedChannel(CHANNELS / name)
    for text in (name, said, "expected"):
        assert text in str(refused.value)


def test_a_file_that_is_no_model_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "channel.onnx"
    path.write_bytes(b"these are no weights")
    with pytest.raises(SpeechError, match=r"channel\.onnx: no ONNX model"):
        LearnedChannel(path)


def test_speech_that_is_no_number_is_refused() -> None:
    bad = speech()
    bad[100] = np.nan
    with pytest.raises(SpeechError, match="NaN"):
        echo().transmit(bad, None, np.random.default_rng(0))


def test_a_stuck_microphone_is_only_noise() -> None:
    silence = np.zeros(16_000, np.float32)
    assert not echo().transmit(silence, None, np.random.default_rng(0)).any()
    assert echo().transmit(silence, 10.0, np.random.default_rng(0)).any()
