"""A cache of synthesised speech in files.

A sweep speaks the same lines a thousand times. The name of a file is a hash of everything that
determines its samples. So nothing in the cache is ever out of date, several processes may share it,
and it may be deleted at any time.
"""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from contextlib import suppress
from dataclasses import astuple
from pathlib import Path

from airhilt.audio.pcm import Audio, from_pcm, to_pcm
from airhilt.voices.engine import TtsEngine, VoiceSpec

FORMAT = 1
"""Version of the file format; it is part of the names."""
MAXIMUM_BYTES = 512_000_000
"""Size of all files together, about 5,000 calls; the least recently used ones are deleted."""
_DIGEST_BYTES = hashlib.sha256().digest_size


def user_cache_folder() -> Path:
    """Return the folder for voices in the user's cache (XDG Base Directory Specification)."""
    named = os.environ.get("XDG_CACHE_HOME", "")
    base = Path(named) if Path(named).is_absolute() else Path.home() / ".cache"
    return base / "airhilt" / "voices"


class CachedTts:
    """A `TtsEngine` that asks another one only for texts that are not in the cache.

    Samples are rounded to 16 bits, from the cache or not. If the folder cannot be written, speech
    is synthesised every time.

    Parameters
    ----------
    folder
        Folder of the files; None takes `user_cache_folder`.
    maximum_bytes
        Size to which the cache is reduced when it is opened.
    """

    def __init__(
        self, engine: TtsEngine, folder: Path | None = None, maximum_bytes: int = MAXIMUM_BYTES
    ) -> None:
        self._engine = engine
        self._folder = folder or user_cache_folder()
        with suppress(OSError):
            self._folder.mkdir(parents=True, exist_ok=True)
            self._shrink(maximum_bytes)

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
        path = self._path(text, voice)
        pcm = _read(path)
        if pcm is None:
            pcm = to_pcm(self._engine.synthesise(text, voice))
            _write(path, pcm)
        return from_pcm(pcm)

    def _path(self, text: str, voice: VoiceSpec) -> Path:
        key = json.dumps([FORMAT, self.name, self.version, astuple(voice), text])
        return self._folder / f"{hashlib.sha256(key.encode()).hexdigest()}.pcm"

    def _shrink(self, maximum_bytes: int) -> None:
        with os.scandir(self._folder) as entries:
            files = [(entry.stat(), entry.path) for entry in entries if entry.is_file()]
        excess = sum(stat.st_size for stat, _ in files) - maximum_bytes
        for stat, path in sorted(files, key=lambda file: file[0].st_mtime_ns):
            if excess <= 0:
                return
            Path(path).unlink(missing_ok=True)
            excess -= stat.st_size


def _read(path: Path) -> bytes | None:
    """Return the PCM of a file and mark it as used; None if it is missing or damaged."""
    try:
        data = path.read_bytes()
    except OSError:
        return None
    digest, pcm = data[:_DIGEST_BYTES], data[_DIGEST_BYTES:]
    if hashlib.sha256(pcm).digest() != digest:
        return None
    with suppress(OSError):
        os.utime(path)
    return pcm


def _write(path: Path, pcm: bytes) -> None:
    """Write a file all or nothing; other processes never see a part of it."""
    with suppress(OSError):
        number, partial = tempfile.mkstemp(".partial", path.stem, path.parent)
        try:
            with os.fdopen(number, "wb") as stream:
                stream.write(hashlib.sha256(pcm).digest() + pcm)
            Path(partial).replace(path)
        except OSError:
            Path(partial).unlink(missing_ok=True)
