"""A voice for tests: a tone for each text."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np

from airhilt.audio.pcm import Audio
from airhilt.host.caches import CacheFolder
from airhilt.voices.cache import CachedTts
from airhilt.voices.engine import VoiceSpec


class Tone:
    """A `TtsEngine` that notes what it was asked for."""

    name = "tone"

    def __init__(self, version: str = "1") -> None:
        self.version = version
        self.asked: list[tuple[str, VoiceSpec]] = []

    def voice_of(self, speaker: str) -> VoiceSpec:
        return VoiceSpec(speaker)

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        self.asked.append((text, voice))
        number = hashlib.sha256(f"{text}{voice}".encode()).digest()[0]
        tone: Audio = np.sin(np.arange(200 * len(text)) * (0.05 + number / 1000)).astype(np.float32)
        return tone


def cached_tone(base: Path, engine: Tone) -> CachedTts:
    """Return a voice with a cache in a folder."""
    return CachedTts(engine, CacheFolder("voices", base))


def say_lines(folder: Path) -> list[bytes]:
    """Say seven lines ten times each with a cache; here, where another process can import it."""
    cached = cached_tone(folder, Tone())
    pilot = VoiceSpec("pilot")
    return [cached.synthesise(f"line {i % 7}", pilot).tobytes() for i in range(70)]
