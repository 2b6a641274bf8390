"""The recognisers by the names that the command line gives them."""

from __future__ import annotations

from pathlib import Path

from airhilt.assistant.asr.engine import AsrEngine
from airhilt.errors import SpeechError
from airhilt.services import is_service

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
        from airhilt.assistant.asr.ctc import Ctc

        return Ctc(Path(argument) if argument else None)
    if kind == "whisper" and argument:
        from airhilt.assistant.asr.whisper import Whisper

        return Whisper(argument)
    if is_service(name):
        from airhilt.assistant.asr.http import HttpAsr

        return HttpAsr(name)
    raise SpeechError(f"recogniser {name!r}: there is none of that name; expected {EXPECTED}")
