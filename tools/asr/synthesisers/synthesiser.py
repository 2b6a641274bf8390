"""Voices and synthesisers: what a file of this package describes."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from airhilt.audio.pcm import Audio, to_pcm
from airhilt.engines import Requirement
from airhilt.errors import SpeechError
from airhilt.voices.engine import VoiceSpec

TIMEOUT_S = 60.0
"""Longest time in which a program speaks a call, in s."""
CHOICES = ("seen", "unseen", "all", "test-only")
"""Choices of voices that have a name."""


@dataclass(frozen=True)
class Voice:
    """A voice of a synthesiser.

    Attributes
    ----------
    lineage
        Family of synthesisers that share programs or rules of pronunciation.
    speaker
        Person whose recordings the voice was made from, or the timbre if there was none. Two voices
        of a speaker are never on both sides of a test, even if their lineages differ.
    words_per_minute
        Words of calls that it speaks in a minute at its own rate, without silence at the ends, as
        `tools/asr/measure_synthesisers.py` gives them.
    is_held_out
        True if the model that ships was not trained on it.
    is_test_only
        True if its licence does not allow training on what it says.
    """

    name: str
    lineage: str
    speaker: str
    words_per_minute: float
    is_held_out: bool = False
    is_test_only: bool = False


class Talker(Protocol):
    """A synthesiser that runs. The same text and voice give the same samples every time."""

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech."""
        ...


@dataclass(frozen=True)
class InstalledFile:
    """A file or folder of a Debian package."""

    path: Path
    debian: str

    def found(self) -> str:
        """Return its path; empty if there is none."""
        return str(self.path) if self.path.exists() else ""

    def remedy(self) -> str:
        """Return the command that installs it."""
        return f"apt install {self.debian}"


@dataclass(frozen=True)
class Synthesiser:
    """A program that speaks, and its voices.

    Attributes
    ----------
    licence
        Licences of program and voices, in a few words.
    create
        Starts it.
    requires
        Programs and files that must be installed.
    pitches
        Range of the pitch of calls, relative to a voice's own.
    """

    name: str
    licence: str
    voices: tuple[Voice, ...]
    create: Callable[[], Talker]
    requires: tuple[Requirement, ...] = ()
    pitches: tuple[float, float] = (0.85, 1.2)

    def lacks(self) -> str:
        """Return the command that installs what is missing; empty if nothing is."""
        return next((each.remedy() for each in self.requires if not each.found()), "")

    def choose(self, which: str) -> tuple[Voice, ...]:
        """Return voices: ``seen``, ``unseen``, ``all``, ``test-only``, or names between commas.

        Raises
        ------
        SpeechError
            There is no such voice.
        """
        free = [voice for voice in self.voices if not voice.is_test_only]
        seen = [voice for voice in free if not voice.is_held_out]
        unseen = [voice for voice in free if voice.is_held_out]
        test_only = [voice for voice in self.voices if voice.is_test_only]
        groups = dict(zip(CHOICES, (seen, unseen, free, test_only), strict=True))
        named = [voice for voice in self.voices if voice.name in which.split(",")]
        if chosen := groups.get(which, named):
            return tuple(chosen)
        expected = ", ".join([*(group for group, of in groups.items() if of), self.voices[0].name])
        raise SpeechError(f"synthesiser {self.name}: no voices {which!r}; expected {expected}, ...")


def speak(
    talker: Talker, voice: Voice, text: str, words_per_minute: float, pitch: float = 1.0
) -> NDArray[np.int16]:
    """Return a text as speech at a rate, with a pitch relative to the voice's own."""
    spec = VoiceSpec(voice.name, words_per_minute / voice.words_per_minute, pitch)
    return np.frombuffer(to_pcm(talker.synthesise(text, spec)), np.int16)


def run(synthesiser: str, command: Sequence[str | Path]) -> None:
    """Run the program of a synthesiser.

    Raises
    ------
    SpeechError
        It fails.
    """
    done = subprocess.run(command, capture_output=True, check=False, timeout=TIMEOUT_S)
    if done.returncode:
        said = done.stderr.decode("utf-8", "replace").strip()
        raise SpeechError(f"synthesiser {synthesiser}: exit code {done.returncode}: {said}")
