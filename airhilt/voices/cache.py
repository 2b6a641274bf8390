"""Synthesised speech, kept for all processes of a user: a sweep speaks the same lines again."""

from __future__ import annotations

import json
from dataclasses import astuple

from airhilt.audio.pcm import Audio, from_pcm, to_pcm
from airhilt.host.caches import CacheFolder
from airhilt.voices.engine import TtsEngine, VoiceSpec

FORMAT = 1
"""Version of what is kept of a line; it is part of the keys."""


class CachedTts:
    """A `TtsEngine` that asks another one only for texts that are not in the cache of the user.

    Samples are rounded to 16 bits, from the cache or not.
    """

    def __init__(self, engine: TtsEngine, cache: CacheFolder | None = None) -> None:
        self._engine = engine
        self._cache = cache or CacheFolder("voices")

    @property
    def name(self) -> str:
        """Name of the engine."""
        return self._engine.name

    @property
    def version(self) -> str:
        """Version of the engine."""
        return self._engine.version

    def voice_of(self, speaker: str) -> VoiceSpec:
        """Return the engine's voice of a speaker."""
        return self._engine.voice_of(speaker)

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech, synthesised once for all processes of this user."""
        key = json.dumps([FORMAT, self.name, self.version, astuple(voice), text])
        return from_pcm(self._cache.get(key, lambda: to_pcm(self._engine.synthesise(text, voice))))
