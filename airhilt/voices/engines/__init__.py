"""The voices: one file an engine, each with its `ENGINE`.

Voices of another package are found by an entry point of the group ``airhilt.tts`` that names their
`airhilt.engines.Engine`, such as ``mine = "my_package.tts:ENGINE"``.
"""

from __future__ import annotations

from airhilt.engine_families import VOICES
from airhilt.voices.cache import CachedTts
from airhilt.voices.engine import TtsEngine


def tts_engine(name: str) -> TtsEngine:
    """Return the voices of a name such as ``espeak``, with the cache of this user.

    Raises
    ------
    SpeechError
        There are none of that name, or they cannot be loaded.
    """
    return CachedTts(VOICES.create(name))
