"""MBROLA with the phonemes of espeak-ng: recorded diphones of three men, a process for each call.

The licences of the voices forbid their use with another program than MBROLA, so that they are for
tests alone.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from airhilt.audio.pcm import Audio
from airhilt.audio.wav import read_wav
from airhilt.engines import Command
from airhilt.voices.engine import VoiceSpec
from synthesisers.synthesiser import InstalledFile, Synthesiser, Voice, run

WORDS_PER_MINUTE, NORMAL_PITCH = 175, 50
"""Rate in words a minute, and pitch from 0 to 99, of a call that is not to be faster or higher."""
VOICES = Path("/usr/share/mbrola")


class Mbrola:
    """Speaks with the command ``espeak-ng`` and a voice of MBROLA."""

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech."""
        with tempfile.TemporaryDirectory(prefix="airhilt-mbrola-") as folder:
            path = Path(folder) / "speech.wav"
            rate = str(round(WORDS_PER_MINUTE * voice.rate))
            pitch = str(min(round(NORMAL_PITCH * voice.pitch), 99))
            run(
                "mbrola",
                ["espeak-ng", "-v", voice.name, "-s", rate, "-p", pitch, "-w", path, "--", text],
            )
            return read_wav(path)


SYNTHESISER = Synthesiser(
    "mbrola",
    "AGPL-3.0 (MBROLA), GPL-3.0-or-later (espeak-ng); voices for use with MBROLA alone",
    tuple(
        Voice(name, "mbrola", f"mbrola {name[3:]}", 231.0, is_test_only=True)
        for name in ("mb-us2", "mb-us3", "mb-en1")
    ),
    create=Mbrola,
    requires=(
        Command("espeak-ng", debian="espeak-ng"),
        *(
            InstalledFile(VOICES / name, f"mbrola-{name}  # of the component non-free")
            for name in ("us2", "us3", "en1")
        ),
    ),
)
