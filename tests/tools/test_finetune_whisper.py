"""A Whisper of random weights is fine-tuned on generated calls, converted, and hears in a run."""

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

import asr_speech
from airhilt.errors import SpeechError
from convert_whisper import convert
from eval_asr import spoken
from finetune_whisper import CARD, Settings, finetune

from ..conftest import Cli

PACKAGES = ("torch", "transformers", "faster_whisper")
INSTALLED = all(importlib.util.find_spec(name) is not None for name in PACKAGES)
SETTINGS = Settings(steps=80, batch=4, rate=5e-3, seed=1, held_out=0.2, scored_calls=3)
WORD = "wilco"
"""All that there is to learn for so small a model in so few steps."""

pytestmark = [
    pytest.mark.finetune,
    pytest.mark.skipif(not INSTALLED, reason="no transformers: pip install airhilt[finetune]"),
    pytest.mark.filterwarnings("default::DeprecationWarning"),  # torch's and transformers' own
]


@pytest.fixture(scope="module")
def work(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("whisper")


@pytest.fixture(scope="module")
def model(work: Path) -> Path:
    """A Whisper of random weights, as transformers saves it."""
    import tiny_whisper

    made = tiny_whisper.tokenizer()
    random = tiny_whisper.random_model(
        made, tiny_whisper.UNTRAINED_WIDTH, tiny_whisper.UNTRAINED_LAYERS
    )
    tiny_whisper.save(random, made, work / "untrained")
    return work / "untrained"


@pytest.fixture(scope="module")
def speech(work: Path) -> Path:
    """Generated calls, of the tool that makes them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["", str(work / "speech"), "espeak", "--count", "24"])
        asr_speech.main()
    return work / "speech"


@pytest.fixture(scope="module")
def tuned(work: Path, model: Path, speech: Path) -> Path:
    """A model that has learned that all calls are one word."""
    one_word = Path(shutil.copytree(speech, work / "one word"))
    (shard,) = one_word.glob("*.jsonl")
    calls = [json.loads(line) | {"text": WORD} for line in shard.read_text().splitlines()]
    shard.write_text("\n".join(map(json.dumps, calls)))
    finetune(model, one_word, work / "tuned", SETTINGS)
    return work / "tuned"


@pytest.fixture(scope="module")
def converted(work: Path, tuned: Path) -> Path:
    convert(tuned, work / "converted")
    return work / "converted"


def weights(folder: Path) -> bytes:
    return (folder / "model.safetensors").read_bytes()


def test_the_loss_falls_and_the_recogniser_of_a_run_hears_what_was_learned(tuned: Path) -> None:
    card = json.loads((tuned / CARD).read_text())
    assert card["last_loss"] < 0.3 * card["first_loss"]
    before, after = (card[name]["word_error_rate"] for name in ("score_before", "score_after"))
    assert before >= 1.0
    assert after < 0.5


def test_the_card_says_what_was_trained_on_for_how_long_and_from_which_seed(
    tuned: Path, speech: Path
) -> None:
    card = json.loads((tuned / CARD).read_text())
    calls = [each for path in speech.glob("*.jsonl") for each in spoken(path)]
    assert card["base"] == "untrained"
    assert card["settings"]["seed"] == 1
    assert card["examples_drawn"] == 80 * 4
    assert card["minutes"] > 0.0
    assert card["shards"] == ["espeak-0-000"]
    assert 0 < card["held_out"]["calls"] < card["training"]["calls"] < len(calls) + 1
    assert card["scored"] == {"calls": 3, "snr_db": 10.0}


def test_the_same_seed_gives_the_same_model_and_another_seed_another(
    work: Path, model: Path, speech: Path
) -> None:
    made = []
    for number, seed in enumerate((5, 5, 6)):
        few = Settings(steps=2, batch=2, rate=1e-3, seed=seed, scored_calls=1)
        finetune(model, speech, work / f"few-{number}", few)
        made.append(weights(work / f"few-{number}"))
    assert made[0] == made[1]
    assert made[0] != made[2]


def test_it_is_converted_and_hears_in_a_run(
    converted: Path, encounter_file: Path, airhilt_command: Cli
) -> None:
    done = airhilt_command(
        "cosim", "--scenario", encounter_file, "--asr", f"whisper:{converted}", "--out", "run",
        "--no-cameras", "--latency", "fixed", "--json",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    heard = airhilt_command("listen", "run", "--frequency", "134325").stdout
    assert f"{WORD}  [whisper:converted, " in heard


def test_calls_of_another_format_of_features_are_converted_too(tuned: Path, tmp_path: Path) -> None:
    other = Path(shutil.copytree(tuned, tmp_path / "other"))
    features = json.loads((other / "preprocessor_config.json").read_text())
    (other / "preprocessor_config.json").unlink()
    (other / "processor_config.json").write_text(json.dumps({"feature_extractor": features}))
    convert(other, tmp_path / "out", "float32")
    kept = json.loads((tmp_path / "out" / "preprocessor_config.json").read_text())
    assert kept["chunk_length"] == features["chunk_length"] == 10


def test_features_of_another_model_are_refused_after_the_conversion(
    tuned: Path, tmp_path: Path
) -> None:
    other = Path(shutil.copytree(tuned, tmp_path / "other"))
    path = other / "preprocessor_config.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"feature_size": 128}))
    with pytest.raises(SpeechError, match="takes 80 mel bands, and not the 128"):
        convert(other, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_nothing_asks_the_network(
    model: Path, speech: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: Any, **__: Any) -> None:
        raise AssertionError("the network was asked")

    monkeypatch.setattr(socket, "getaddrinfo", refuse)
    monkeypatch.setattr(socket.socket, "connect", refuse)
    finetune(model, speech, tmp_path / "out", Settings(steps=1, batch=1, scored_calls=1))
    convert(tmp_path / "out", tmp_path / "converted")


@pytest.mark.parametrize(
    ("settings", "problem"),
    [
        (Settings(steps=0), "steps is 0; expected at least 1"),
        (Settings(held_out=1.0), "held_out is 1; expected a share"),
        (Settings(device="abacus"), "device 'abacus' cannot be used: RuntimeError: "),
    ],
)
def test_settings_without_sense_are_refused(
    settings: Settings, problem: str, model: Path, speech: Path, tmp_path: Path
) -> None:
    with pytest.raises(SpeechError, match=problem):
        finetune(model, speech, tmp_path / "out", settings)


def test_calls_longer_than_a_window_are_left_out(model: Path, speech: Path, tmp_path: Path) -> None:
    long = Path(shutil.copytree(speech, tmp_path / "long"))
    (shard,) = long.glob("*.jsonl")
    samples = np.load(shard.with_suffix(".npy"))
    about = {"text": "roger", "callsign": None, "voice": "long", "samples": 11 * 16_000}
    np.save(shard.with_suffix(".npy"), np.concatenate([samples, np.zeros(11 * 16_000, np.int16)]))
    shard.write_text(f"{shard.read_text()}{json.dumps(about)}\n")
    card = finetune(model, long, tmp_path / "out", Settings(steps=1, batch=1, scored_calls=1))
    calls = [each for path in long.glob("*.jsonl") for each in spoken(path)]
    fitting = [each for each in calls if len(each.pcm) < 9.5 * 16_000]
    assert card["training"]["calls"] + card["held_out"]["calls"] == len(fitting) < len(calls)
