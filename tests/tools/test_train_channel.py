"""A channel is trained from speech and recordings of other words, and is heard in a run."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest

from airhilt.audio.wav import write_wav
from airhilt.errors import SpeechError
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.channel import VhfChannel
from airhilt.sensors.radio.learned_channel import LearnedChannel
from airhilt.voices.engines.espeak import Espeak
from train_channel import Settings, train_channel

from ..conftest import Cli

INSTALLED = all(importlib.util.find_spec(name) is not None for name in ("torch", "onnx"))
CLEAN = (
    "American one two three, runway zero one, cleared to land.",
    "Cleared to land runway zero one, American one two three.",
    "Delta four five six, contact departure, one two four decimal seven.",
    "Speedbird nine, descend flight level one hundred.",
    "Taxi to holding point bravo one, runway two seven.",
    "Wind two four zero degrees, eight knots.",
)
RECORDED = (
    "Lufthansa four alpha, climb to five thousand feet.",
    "Line up and wait runway three three, United six one.",
    "Turn left heading three six zero, reduce speed two one zero knots.",
    "Hold short of runway one five, traffic on final.",
    "Good morning tower, request push and start, stand two.",
    "Going around, Cactus five five.",
)
SETTINGS = Settings(steps=150, batch=4, rate=1e-3, seed=1)

pytestmark = [
    pytest.mark.finetune,
    pytest.mark.skipif(not INSTALLED, reason="no torch or onnx: pip install torch onnx"),
    pytest.mark.filterwarnings("default"),  # torch's own
]


@pytest.fixture(scope="module")
def speech(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folders of clean speech, and of other words through a narrow channel without noise."""
    folder = tmp_path_factory.mktemp("channel")
    voices, channel = Espeak(), VhfChannel(PROFILES["vhf_833"])
    for name, texts in (("clean", CLEAN), ("recorded", RECORDED)):
        (folder / name).mkdir()
        for number, text in enumerate(texts):
            said = voices.synthesise(text, voices.voice_of(f"{name} {number}"))
            if name == "recorded":
                said = channel.transmit(said, None, np.random.default_rng(number))
            write_wav(folder / name / f"{number}.wav", said)
    return folder


@pytest.fixture(scope="module")
def trained(speech: Path) -> Path:
    train_channel(speech / "clean", speech / "recorded", speech / "learned.onnx", SETTINGS)
    return speech / "learned.onnx"


def test_speech_comes_to_sound_like_the_recordings(trained: Path) -> None:
    card = json.loads(trained.with_suffix(".json").read_text())
    assert card["distance_after_db"] < 0.7 * card["distance_before_db"]
    assert card["clean"]["calls"] == card["channel"]["calls"] == 5
    assert card["settings"]["seed"] == 1


def test_the_channel_narrows_the_band_and_keeps_the_length(trained: Path) -> None:
    learned, voices = LearnedChannel(trained), Espeak()
    said = voices.synthesise("Cleared for takeoff.", voices.voice_of("AAL123"))
    heard = learned.transmit(said, None, np.random.default_rng(0))
    assert heard.shape == said.shape

    def high_share(audio: np.ndarray) -> float:
        power = np.abs(np.fft.rfft(audio)) ** 2
        return float(power[len(power) // 2 :].sum() / power.sum())

    assert high_share(heard) < 0.3 * high_share(said)


def test_it_is_the_radio_of_a_run(
    trained: Path, encounter_file: Path, airhilt_command: Cli
) -> None:
    done = airhilt_command(
        "cosim", "--scenario", encounter_file, "--radio-profile", trained, "--out", "run",
        "--no-cameras", "--latency", "fixed", "--json",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


def test_what_is_missing_is_named(speech: Path, tmp_path: Path) -> None:
    with pytest.raises(SpeechError, match="0 WAV files with more than 1 s of speech"):
        train_channel(tmp_path, speech / "recorded", tmp_path / "a.onnx", SETTINGS)
    (tmp_path / "a.json").touch()
    with pytest.raises(SpeechError, match=r"a\.json: is there"):
        train_channel(speech / "clean", speech / "recorded", tmp_path / "a.onnx", SETTINGS)
