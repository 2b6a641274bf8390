"""SVOX Pico, the small synthesiser of early Android: two women, a process for each call."""

from __future__ import annotations

import tempfile
from pathlib import Path

from airhilt.audio.pcm import Audio
from airhilt.audio.wav import read_wav
from airhilt.engines import Command
from airhilt.voices.engine import VoiceSpec
from synthesisers.synthesiser import Synthesiser, Voice, run


class Pico:
    """Speaks with the command ``pico2wave``."""

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech."""
        marked = (
            f'<speed level="{round(100 * voice.rate)}"><pitch level="{round(100 * voice.pitch)}">'
            f"{text}</pitch></speed>"
        )
        with tempfile.TemporaryDirectory(prefix="airhilt-pico-") as folder:
            path = Path(folder) / "speech.wav"
            run("pico", ["pico2wave", "-l", voice.name, "-w", path, marked])
            return read_wav(path)


SYNTHESISER = Synthesiser(
    "pico",
    "Apache-2.0, program and voices (the voices without their sources)",
    (
        Voice("en-US", "pico", "pico lh0", 175.0),
        Voice("en-GB", "pico", "pico kh0", 160.0),
    ),
    create=Pico,
    requires=(Command("pico2wave", debian="libttspico-utils  # of the component non-free"),),
)
