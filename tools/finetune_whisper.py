"""Fine-tunes a Whisper of Hugging Face on radio calls that this project generates.

    pip install '.[finetune]'
    python tools/asr/asr_speech.py build/speech espeak --count 22000 --seed 1
    python tools/finetune_whisper.py HF_FOLDER build/speech OUT --steps 4000
    python tools/asr/convert_whisper.py OUT FOLDER
    airhilt cosim --scenario s01a_nominal --asr whisper:FOLDER

HF_FOLDER is any Whisper as transformers saves it. The calls of some speakers are held out. The
recogniser of a run is scored on them before and after, at 10 dB. OUT is a folder of Hugging Face
with ``card.json``: the calls, the settings, the time, the losses and both scores. Nothing is
downloaded. The same model, calls, seed and versions give the same model on a CPU.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.errors import SpeechError, first_line

sys.path.append(str(Path(__file__).parent / "asr"))

from convert_whisper import FEATURES, TOKENIZER, convert, require_whisper
from eval_asr import SpokenCall, score, spoken
from whisper_examples import (
    IGNORED,
    PROFILE_NAMES,
    PROMPTED_SHARE,
    SILENT_SHARE,
    SNR_DB,
    Example,
    Examples,
    split,
)

CARD = "card.json"
COPIED = (
    TOKENIZER, *FEATURES, "tokenizer_config.json", "vocab.json", "merges.txt", "normalizer.json",
    "special_tokens_map.json", "added_tokens.json",
)  # fmt: skip
"""Files that fine-tuning does not change; the model need not have all of them."""
ENGLISH_ONLY = 51_864
"""Tokens of Whisper's models for English only, which have no languages (openai/whisper,
`Whisper.is_multilingual`)."""
SCORED_DB = 10.0
TAIL_S = 0.5
"""Longest addition of the channel to a call, in s: the squelch tail (assumed)."""
LARGEST_GRADIENT = 1.0
WARM_UP_SHARE = 0.1
"""Share of the steps in which the learning rate rises; it falls to zero over the others."""
REPORT = 10
"""Steps from one line on the terminal to the next, and those whose mean loss the card has."""


@dataclass(frozen=True)
class Settings:
    """Settings of the training."""

    steps: int = 4_000
    batch: int = 16
    rate: float = 1e-5
    seed: int = 0
    held_out: float = 0.05
    """Share of the calls that are held out."""
    scored_calls: int = 300
    """Most held-out calls that are scored."""
    device: str = "cpu"
    workers: int = 0
    """Processes that make examples beside the training; 0 makes them in it."""


def finetune(model_folder: Path, speech: Path, out: Path, settings: Settings) -> dict[str, Any]:
    """Fine-tune a model, write it with its card, and return the card.

    Raises
    ------
    SpeechError
        Files or packages are missing, or there is nothing to learn from.
    """
    require_whisper(model_folder)
    if out.exists():
        raise SpeechError(f"{out}: is there; expected the name of a new folder")
    _require_sense(settings)
    model, tokenizer, features = _load(model_folder)
    _move(model, settings.device)
    calls = _calls(speech, features.chunk_length - TAIL_S)
    try:
        training, held_out = split(calls, settings.held_out, settings.seed)
    except ValueError as error:
        raise SpeechError(f"{speech}: {error}") from None
    scored = held_out[: settings.scored_calls]
    before = _scores(model_folder, scored)
    examples = Examples(
        training, tokenizer, features, settings.steps * settings.batch, settings.seed
    )
    begun = time.monotonic()
    losses = _train(model, examples, settings)
    minutes = (time.monotonic() - begun) / 60.0
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=out.parent) as scratch:
        made = Path(scratch) / out.name
        model.cpu().save_pretrained(made)
        for name in COPIED:
            if (model_folder / name).is_file():
                shutil.copy(model_folder / name, made / name)
        card = {
            "made_by": "tools/finetune_whisper.py",
            "base": model_folder.resolve().name,
            "parameters": model.num_parameters(),
            "shards": sorted(path.stem for path in speech.glob("*.jsonl")),
            "training": _summary(training),
            "held_out": _summary(held_out),
            **_recipe(settings),
            "minutes": round(minutes, 2),
            "first_loss": _mean(losses[:REPORT]),
            "last_loss": _mean(losses[-REPORT:]),
            "scored": {"calls": len(scored), "snr_db": SCORED_DB},
            "score_before": before,
            "score_after": _scores(made, scored),
        }
        (made / CARD).write_text(json.dumps(card, indent=2) + "\n")
        made.rename(out)
    return card


def _require_sense(settings: Settings) -> None:
    for name in ("steps", "batch", "scored_calls"):
        if getattr(settings, name) < 1:
            raise SpeechError(f"{name} is {getattr(settings, name)}; expected at least 1")
    if not 0.0 < settings.held_out < 1.0:
        raise SpeechError(f"held_out is {settings.held_out:g}; expected a share between 0 and 1")


def _move(model: Any, device: str) -> None:
    try:
        model.to(device)
    except (AssertionError, RuntimeError) as error:  # torch has both for a device that it lacks
        raise SpeechError(f"device {device!r} cannot be used: {first_line(error)}") from None


def _recipe(settings: Settings) -> dict[str, Any]:
    """Return what was done, apart from to which model and with which calls."""
    return {
        "settings": asdict(settings),
        "examples_drawn": settings.steps * settings.batch,
        "channel": {"profiles": sorted(set(PROFILE_NAMES)), "snr_db": SNR_DB},
        "share_of_silence": SILENT_SHARE,
        "share_with_hot_words": PROMPTED_SHARE,
        "versions": {name: version(name) for name in ("airhilt", "torch", "transformers")},
    }


def _load(folder: Path) -> tuple[Any, Any, Any]:
    """Return model, tokenizer and feature extractor."""
    try:
        import tokenizers
        from faster_whisper.tokenizer import Tokenizer
        from transformers import WhisperFeatureExtractor, WhisperForConditionalGeneration
    except ImportError as error:
        raise SpeechError(
            f"fine-tuning needs torch, transformers and faster-whisper ({first_line(error)}); "
            "install them with `pip install '.[finetune]'`"
        ) from None
    try:
        model = WhisperForConditionalGeneration.from_pretrained(folder, local_files_only=True)
        features = WhisperFeatureExtractor.from_pretrained(folder, local_files_only=True)
        words = tokenizers.Tokenizer.from_file(str(folder / TOKENIZER))
    except Exception as error:  # each library has its own
        raise SpeechError(f"{folder}: does not load: {first_line(error)}") from None
    is_multilingual = model.config.vocab_size != ENGLISH_ONLY
    tokenizer = Tokenizer(words, is_multilingual, task="transcribe", language="en")
    return model.float(), tokenizer, features


def _calls(speech: Path, longest_s: float) -> list[SpokenCall]:
    paths = sorted(speech.glob("*.jsonl"))
    calls = [each for path in paths if path.with_suffix(".npy").is_file() for each in spoken(path)]
    if not calls:
        raise SpeechError(f"{speech}: no calls; expected shards of tools/asr/asr_speech.py")
    return [each for each in calls if len(each.pcm) <= longest_s * SAMPLE_RATE_HZ]


def _scores(folder: Path, calls: list[SpokenCall]) -> dict[str, float | None]:
    """Return word error rate and share of right callsigns of the recogniser of a run."""
    with tempfile.TemporaryDirectory() as scratch:
        converted = Path(scratch) / folder.name
        convert(folder, converted, "float32")
        got, _ = score(calls, f"whisper:{converted}", SCORED_DB)
    return {"word_error_rate": got.word_error_rate, "callsigns_right": _mean(got.callsigns)}


def _train(model: Any, examples: Examples, settings: Settings) -> list[float]:
    """Train a model, and return the loss of each step."""
    import torch

    torch.manual_seed(settings.seed)
    model.train()
    optimiser = torch.optim.AdamW(model.parameters(), settings.rate, weight_decay=0.01)
    schedule = torch.optim.lr_scheduler.LambdaLR(
        optimiser, lambda step: _share_of_rate(step, settings.steps)
    )
    batches = torch.utils.data.DataLoader(
        examples,  # type: ignore[arg-type,unused-ignore]
        settings.batch,
        num_workers=settings.workers,
        collate_fn=together,
    )
    losses = []
    for step, batch in enumerate(batches, 1):
        inputs = {
            name: torch.from_numpy(array).to(settings.device) for name, array in batch.items()
        }
        with torch.autocast(
            torch.device(settings.device).type, torch.bfloat16, settings.device != "cpu"
        ):
            loss = model(**inputs).loss
        optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(model.parameters(), LARGEST_GRADIENT)
        optimiser.step()
        schedule.step()
        losses.append(loss.item())
        if step % REPORT == 0:
            print(
                f"step {step} of {settings.steps}, loss {_mean(losses[-REPORT:]):.3f}", flush=True
            )
    model.eval()
    return losses


def together(examples: Sequence[Example]) -> dict[str, np.ndarray]:
    """Return a batch, under the names that transformers has for its parts."""
    longest = max(len(each.given) for each in examples)
    given = np.zeros((len(examples), longest), np.int64)
    wanted = np.full((len(examples), longest), IGNORED, np.int64)
    for row, each in enumerate(examples):
        given[row, : len(each.given)] = each.given
        wanted[row, : len(each.wanted)] = each.wanted
    features = np.stack([each.features for each in examples])
    return {"input_features": features, "decoder_input_ids": given, "labels": wanted}


def _share_of_rate(step: int, steps: int) -> float:
    rising = max(1, round(WARM_UP_SHARE * steps))
    return min((step + 1) / rising, (steps - step) / max(1, steps - rising))


def _summary(calls: list[SpokenCall]) -> dict[str, Any]:
    seconds = sum(len(each.pcm) for each in calls) / SAMPLE_RATE_HZ
    voices = len({each.voice for each in calls})
    return {"calls": len(calls), "voices": voices, "hours": round(seconds / 3600.0, 3)}


def _mean(numbers: Sequence[float]) -> float | None:
    return round(float(np.mean(numbers)), 4) if numbers else None


def main() -> None:
    """Read the command line, and fine-tune."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", type=Path, help="a Whisper as transformers saves it")
    parser.add_argument("speech", type=Path, help="shards of tools/asr/asr_speech.py")
    parser.add_argument("out", type=Path, help="a new folder")
    for name, value in asdict(Settings()).items():
        option = f"--{name.replace('_', '-')}"
        parser.add_argument(option, type=type(value), default=value, help=f"default: {value}")
    given = vars(parser.parse_args())
    model, speech, out = (given.pop(name) for name in ("model", "speech", "out"))
    try:
        card = finetune(model, speech, out, Settings(**given))
    except SpeechError as error:
        parser.error(str(error))
    for name in ("first_loss", "last_loss", "score_before", "score_after"):
        print(f"{name}: {card[name]}")


if __name__ == "__main__":
    main()
