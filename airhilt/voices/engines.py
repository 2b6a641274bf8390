"""The voices by the names that the command line gives them."""

from __future__ import annotations

from pathlib import Path

from airhilt.errors import SpeechError
from airhilt.services import is_service
from airhilt.voices.cache import CachedTts
from airhilt.voices.engine import TtsEngine

EXPECTED = "espeak, flite, coqui:FOLDER, or the address of a service"


def tts_engine(name: str) -> TtsEngine:
    """Return the voices of a name such as ``espeak``, with the cache of this user.

    Raises
    ------
    SpeechError
        There are none of that name, or they cannot be loaded.
    """
    return CachedTts(_engine(name))


def _engine(name: str) -> TtsEngine:
    kind, _, argument = name.partition(":")
    if name == "espeak":
        from airhilt.voices.espeak import Espeak

        return Espeak()
    if name == "flite":
        from airhilt.voices.flite import Flite

        return Flite()
    if kind == "coqui" and argument:
        from airhilt.voices.coqui import Coqui

        return Coqui(Path(argument))
    if is_service(name):
        from airhilt.voices.http import HttpTts

        return HttpTts(name)
    raise SpeechError(f"voices {name!r}: there are none of that name; expected {EXPECTED}")
