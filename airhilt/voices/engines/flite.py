"""CMU Flite, by its command ``flite``: few voices, but more natural than espeak-ng."""

from __future__ import annotations

import hashlib
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from airhilt.audio.pcm import Audio
from airhilt.audio.wav import read_wav
from airhilt.engines import Command, Engine
from airhilt.errors import SpeechError
from airhilt.voices.engine import VoiceSpec

VOICES = ("slt", "rms", "awb", "kal16")
"""Voices in Debian's ``flite``, all of 16 kHz."""


class Flite:
    """Speaks with flite; each utterance is a process."""

    name = "flite"

    def __init__(self, command: str = "flite") -> None:
        found = shutil.which(command)
        if found is None:
            raise SpeechError(
                f"voice flite: there is no command {command!r} on PATH; install it with "
                "`apt install flite`, or choose another voice with --tts"
            )
        self._command = found
        version = re.search(rb"version: *(\S+)", self._run("--version").stdout)
        self.version = version.group(1).decode() if version else "unknown"

    def voice_of(self, speaker: str) -> VoiceSpec:
        """Return the voice of a speaker: timbre, rate and pitch drawn from the name."""
        digest = hashlib.sha256(speaker.encode()).digest()
        rate = 0.9 + 0.3 * digest[1] / 255.0
        pitch = 0.85 + 0.3 * digest[2] / 255.0
        return VoiceSpec(VOICES[digest[0] % len(VOICES)], round(rate, 3), round(pitch, 3))

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech."""
        with tempfile.TemporaryDirectory(prefix="airhilt-flite-") as folder:
            path = Path(folder) / "speech.wav"
            done = self._run(
                *("-voice", voice.name),
                *("--setf", f"duration_stretch={1.0 / voice.rate:.4f}"),
                *("--setf", f"f0_shift={voice.pitch:.4f}"),
                *("-o", str(path)),
                *("-t", text),
            )
            if done.returncode:
                error = SpeechError(
                    f"voice flite: {self._command} failed with exit code {done.returncode}: "
                    f"{done.stderr.decode('utf-8', 'replace').strip()}"
                )
                error.is_of_machine = done.returncode < 0  # A signal has ended it.
                raise error
            return read_wav(path)

    def _run(self, *arguments: str) -> subprocess.CompletedProcess[bytes]:
        return subprocess.run(  # noqa: S603  (arguments, not a shell's line)
            [self._command, *arguments], capture_output=True, check=False, stdin=subprocess.DEVNULL
        )


ENGINE = Engine(
    name="flite",
    summary="CMU Flite, more natural than espeak-ng",
    create=lambda _: Flite(),
    requires=(Command("flite", debian="flite"),),
)
