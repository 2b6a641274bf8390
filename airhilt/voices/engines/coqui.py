"""Coqui XTTS-v2, from a folder with its model: natural, slow without a GPU."""

from __future__ import annotations

import hashlib
import importlib.metadata
from pathlib import Path
from typing import Any

import numpy as np

from airhilt.audio.pcm import Audio
from airhilt.audio.resampling import resampled
from airhilt.engines import Engine, Package
from airhilt.errors import SpeechError, first_line
from airhilt.voices.engine import VoiceSpec

MODEL_FILES = ("config.json", "model.pth", "vocab.json", "speakers_xtts.pth")
"""Files of XTTS-v2, as its publisher names them."""
RATE_HZ = 24_000
"""Sample rate of XTTS-v2 (``output_sample_rate`` in its config.json)."""
LANGUAGE = "en"


class Coqui:
    """Speaks with XTTS-v2, which ignores the pitch of a voice.

    Parameters
    ----------
    folder
        Folder with `MODEL_FILES`.

    Raises
    ------
    SpeechError
        The package or files of the model are missing, or do not load.
    """

    name = "coqui"

    def __init__(self, folder: Path) -> None:
        missing = [name for name in MODEL_FILES if not (folder / name).is_file()]
        if missing:
            raise SpeechError(
                f"voice coqui: {folder}: without {', '.join(missing)}; expected the files of "
                f"XTTS-v2: {', '.join(MODEL_FILES)}"
            )
        try:
            import torch
            from TTS.tts.configs.xtts_config import XttsConfig
            from TTS.tts.models.xtts import Xtts
        except (ImportError, OSError, RuntimeError) as error:  # of libraries that do not match
            raise SpeechError(
                "voice coqui: the package coqui-tts is missing or does not load "
                f"({first_line(error)}); install it with `pip install airhilt[coqui]`, see "
                "docs/voices.md"
            ) from None
        try:
            config = XttsConfig()
            config.load_json(str(folder / "config.json"))
            self._model: Any = Xtts(config)
            self._model.load_checkpoint(config, checkpoint_dir=str(folder), eval=True)
            if torch.cuda.is_available():
                self._model.cuda()
            self._speakers: dict[str, tuple[Any, Any]] = {
                name: (latent, embedding)
                for name, parts in self._model.speaker_manager.speakers.items()
                for latent, embedding in [parts.values()]
            }
        except Exception as error:  # anything may come out of a file that is no model
            raise SpeechError(
                f"voice coqui: {folder}: does not load as XTTS-v2: {first_line(error)}"
            ) from None
        self._torch: Any = torch
        self.version = f"{importlib.metadata.version('coqui-tts')} {_fingerprint(folder)}"

    def voice_of(self, speaker: str) -> VoiceSpec:
        """Return the voice of a speaker: one of the model's own, and a rate of speaking."""
        digest = hashlib.sha256(speaker.encode()).digest()
        names = sorted(self._speakers)
        rate = 0.95 + 0.2 * digest[2] / 255.0
        return VoiceSpec(names[int.from_bytes(digest[:2]) % len(names)], round(rate, 3))

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech; the seed of the model comes from text and voice."""
        # Seven bytes: torch's generators take 64 bits with a sign.
        seed = hashlib.sha256(f"{voice}{text}".encode()).digest()[:7]
        with self._torch.random.fork_rng():
            self._torch.manual_seed(int.from_bytes(seed))
            try:
                speaker = self._speakers[voice.name]
                spoken = self._model.inference(text, LANGUAGE, *speaker, speed=voice.rate)
            except Exception as error:  # whatever torch raises
                raise SpeechError(
                    f"voice coqui: cannot speak {text[:60]!r}: {first_line(error)}"
                ) from None
        samples = np.asarray(spoken["wav"], np.float32).reshape(-1)
        return resampled(samples, RATE_HZ)


def _fingerprint(folder: Path) -> str:
    """Return a hash of the sizes and times of a model's files, which are too large to read."""
    stats = [(folder / name).stat() for name in MODEL_FILES]
    text = repr([(stat.st_size, stat.st_mtime_ns) for stat in stats])
    return hashlib.sha256(text.encode()).hexdigest()[:12]


ENGINE = Engine(
    name="coqui",
    summary="Coqui XTTS-v2, natural; slow without a GPU",
    create=lambda folder: Coqui(Path(folder)),
    argument="FOLDER",
    is_argument_required=True,
    takes=lambda text: (Path(text) / "model.pth").is_file(),
    requires=tuple(
        Package(name, extra="coqui") for name in ("coqui-tts", "torch", "torchaudio", "torchcodec")
    ),
)
