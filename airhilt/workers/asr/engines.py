"""The recognisers by the names that the command line gives them."""

from __future__ import annotations

from pathlib import Path

from airhilt.errors import SpeechError
from airhilt.service import is_service
from airhilt.workers.asr.engine import AsrEngine

EXPECTED = "embedded, embedded:FOLDER, whisper:FOLDER_OR_NAME, or the address of a service"


def asr_engine(name: str) -> AsrEngine:
    """Return the recogniser of a name such as ``embedded`` or ``whisper:models/base.en``.

    Raises
    ------
    SpeechError
        There is none of that name, or it cannot be loaded.
    """
    kind, _, argument = name.partition(":")
    if kind == "embedded":
        from airhilt.workers.asr.ctc import Ctc

        return Ctc(Path(argument) if argument else None)
    if kind == "whisper" and argument:
        from airhilt.workers.asr.whisper import Whisper

        return Whisper(argument)
    if is_service(name):
        from airhilt.workers.asr.http import HttpAsr

        return HttpAsr(name)
    raise SpeechError(f"recogniser {name!r}: there is none of that name; expected {EXPECTED}")
