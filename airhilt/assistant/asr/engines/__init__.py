"""The speech recognisers: one file an engine, each with its `ENGINE`.

A recogniser of another package is found by an entry point of the group ``airhilt.asr`` that names
its `airhilt.engines.Engine`, such as ``mine = "my_package.asr:ENGINE"``.
"""

from __future__ import annotations

from airhilt.assistant.asr.engine import AsrEngine
from airhilt.engine_families import RECOGNISERS
from airhilt.engines import EngineFamily

FAMILY: EngineFamily[AsrEngine] = RECOGNISERS


def asr_engine(name: str) -> AsrEngine:
    """Return the recogniser of a name such as ``embedded`` or ``whisper:models/base.en``.

    Raises
    ------
    SpeechError
        There is none of that name, or it cannot be loaded.
    """
    return FAMILY.create(name)
