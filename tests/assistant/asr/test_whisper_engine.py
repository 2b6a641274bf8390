"""faster-whisper on a folder of CTranslate2's, here one that has learned a single sentence."""

from __future__ import annotations

import importlib.util
import json
import shutil
import socket
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.signal import butter, sosfilt

from airhilt.assistant.asr.engines.whisper import Whisper, WhisperSettings
from airhilt.assistant.asr.whisper_models import MODEL_FILES
from airhilt.engine_families import RECOGNISERS
from airhilt.errors import AirhiltError, SpeechError
from airhilt.voices.engines.espeak import Espeak
from paths import DATA
from tiny_models import write_looping_whisper

MODEL = DATA / "tiny_whisper"
UNGUARDED = WhisperSettings(
    temperatures=(0.0,), compression_ratio_threshold=1e9, no_repeat_ngram_size=0
)
"""As Whisper is without what keeps it from loops."""
INSTALLED = importlib.util.find_spec("faster_whisper") is not None


def call() -> np.ndarray:
    voice = Espeak()
    return voice.synthesise(
        "American one two three, runway zero one left, cleared to land.", voice.voice_of("TOWER")
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(MODEL, tmp_path / "model"))


@pytest.mark.parametrize("name", MODEL_FILES)
def test_an_incomplete_folder_is_refused_by_the_file_that_it_lacks(name: str, folder: Path) -> None:
    (folder / name).unlink()
    with pytest.raises(SpeechError, match=rf"model: without {name}; expected") as refused:
        Whisper(str(folder))
    assert "--copy_files" in str(refused.value)


@pytest.mark.parametrize("model", ["/no/such/folder", "./model", __file__])
def test_a_path_that_is_no_folder_is_not_looked_for_on_the_network(model: str) -> None:
    with pytest.raises(SpeechError, match="no folder; expected a folder with config"):
        Whisper(model)


def test_without_the_package_the_error_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "faster_whisper", None)
    monkeypatch.setitem(sys.modules, "faster_whisper.vad", None)
    with pytest.raises(SpeechError, match=r"pip install airhilt\[whisper\]"):
        Whisper(str(MODEL))


@pytest.mark.whisper
@pytest.mark.skipif(not INSTALLED, reason="no faster-whisper: pip install airhilt[whisper]")
class TestWithFasterWhisper:
    def test_a_call_gives_words_in_the_form_of_transcripts(self) -> None:
        engine = Whisper(str(MODEL))
        recognised = engine.recognise(call(), ["AAL123", "SPEEDBIRD"])
        assert engine.name == "whisper:tiny_whisper"
        assert recognised.text == "tower runway zero one left cleared to land"
        assert [word for word, _ in recognised.words] == recognised.text.split()
        assert all(0.0 <= confidence <= 1.0 for _, confidence in recognised.words)
        assert 0.1 < recognised.confidence < 1.0

    def test_a_call_longer_than_a_window_is_heard_to_its_end(self) -> None:
        audio = np.tile(call(), 6)
        assert len(audio) > 2 * 10 * 16_000
        heard = Whisper(str(MODEL)).recognise(audio, ["AAL123"])
        assert heard.text.count("cleared to land") >= 2

    @pytest.mark.parametrize("level", [0.0, 0.01, 0.1, 0.5])
    def test_noise_alone_gives_nothing(self, level: float) -> None:
        band = butter(6, [300, 3_400], "band", fs=16_000, output="sos")
        noise = sosfilt(band, np.random.default_rng(1).normal(0.0, level, 10 * 16_000))
        assert Whisper(str(MODEL)).recognise(noise.astype(np.float32), ["AAL123"]).text == ""

    def test_a_folder_needs_no_network(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def refuse(*_: Any, **__: Any) -> None:
            raise AssertionError("the network was asked")

        monkeypatch.setattr(socket, "getaddrinfo", refuse)
        monkeypatch.setattr(socket.socket, "connect", refuse)
        assert Whisper(str(MODEL)).recognise(call(), []).text

    @pytest.mark.parametrize("name", ["model.bin", "tokenizer.json"])
    def test_a_damaged_file_is_an_error_about_that_model(self, name: str, folder: Path) -> None:
        (folder / name).write_bytes(b"damaged")
        with pytest.raises(SpeechError, match=f"{folder}: does not load"):
            Whisper(str(folder))

    def test_features_of_another_model_are_refused(self, folder: Path) -> None:
        path = folder / "preprocessor_config.json"
        path.write_text(json.dumps(json.loads(path.read_text()) | {"feature_size": 128}))
        with pytest.raises(SpeechError, match="takes 80 mel bands, and not the 128"):
            Whisper(str(folder))

    def test_what_loops_is_rejected_and_not_told_as_sure(self, folder: Path) -> None:
        write_looping_whisper(folder)
        looped = Whisper(str(folder), UNGUARDED).recognise(call(), ["AAL123"])
        rejected = Whisper(str(folder)).recognise(call(), ["AAL123"])
        assert looped.text.count("tower") > 100
        assert looped.confidence > 0.9
        assert (rejected.text, rejected.words) == ("", ())
        assert rejected.confidence < 0.1

    def test_a_limit_on_repetition_makes_a_loop_short_and_still_seen(self, folder: Path) -> None:
        write_looping_whisper(folder)
        limited = WhisperSettings(temperatures=(0.0,))
        unseen = limited.model_copy(update={"compression_ratio_threshold": 1e9})
        words = Whisper(str(folder), unseen).recognise(call(), []).text.split()
        assert 16 <= len(words) < 100
        assert Whisper(str(folder), limited).recognise(call(), []).text == ""

    def test_what_is_drawn_at_a_temperature_is_drawn_again_in_another_run(
        self, folder: Path
    ) -> None:
        write_looping_whisper(folder)
        drawing = UNGUARDED.model_copy(update={"temperatures": (1.0,)})
        first, second = (Whisper(str(folder), drawing) for _ in range(2))
        audio = call()
        heard = [first.recognise(audio, []) for _ in range(2)]
        assert heard[0] != heard[1]
        assert heard == [second.recognise(audio, []) for _ in range(2)]

    def test_its_settings_are_checked_by_name_and_limit(self) -> None:
        made = RECOGNISERS.create(f"whisper:{MODEL}", {"beam_size": 1})
        assert made.recognise(call(), []).text
        with pytest.raises(AirhiltError, match="did you mean 'beam_size'"):
            RECOGNISERS.create(f"whisper:{MODEL}", {"beam_sise": 1})
