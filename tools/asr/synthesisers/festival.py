"""Festival's diphone voices, spoken by one Festival that stays."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path
from weakref import finalize

from airhilt.audio.pcm import Audio
from airhilt.audio.wav import read_wav
from airhilt.engines import Command
from airhilt.errors import SpeechError
from airhilt.voices.engine import VoiceSpec
from synthesisers.synthesiser import InstalledFile, Synthesiser, Voice

VOICES = Path("/usr/share/festival/voices")
OWN_PITCH_HZ = 105.0
"""`target_f0_mean` of these voices (kal_diphone.scm, ked_diphone.scm, rab_diphone.scm)."""
_DONE = "airhilt: done"
_SPEAK = """
 (voice_{voice})
 (Parameter.set 'Duration_Stretch {stretch:.4f})
 (set! int_lr_params (cons (list 'target_f0_mean {pitch_hz:.2f}) (cdr int_lr_params)))
 (set! said (utt.synth (Utterance Text {text})))
 (utt.save.wave said "{path}" 'riff)
"""


class FestivalProcess:
    """A process of Festival, which does what it is asked to and stays."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            ["festival", "--pipe"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        finalize(self, _end, self._process)

    def ask(self, expressions: str) -> None:
        """Wait until Festival has done it.

        Raises
        ------
        SpeechError
            It has complained, or has ended.
        """
        process = self._process
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(f'(begin {expressions} (format t "{_DONE}\\n") (fflush nil))\n')
        process.stdin.flush()
        lines = []
        for line in process.stdout:
            lines.append(line.strip())
            if lines[-1] == _DONE:
                return
            if "ERROR" in line:
                break
        raise SpeechError(f"synthesiser festival: {' '.join(lines) or 'it has ended'}")


class Festival:
    """Speaks with Festival's diphones; each call sets all that it needs."""

    def __init__(self) -> None:
        self._process = FestivalProcess()

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech."""
        with tempfile.TemporaryDirectory(prefix="airhilt-festival-") as folder:
            path = Path(folder) / "speech.wav"
            expression = _SPEAK.format(
                voice=voice.name,
                stretch=1.0 / voice.rate,
                pitch_hz=OWN_PITCH_HZ * voice.pitch,
                text=quoted(text),
                path=path,
            )
            self._process.ask(expression)
            return read_wav(path)


def quoted(text: str) -> str:
    """Return a text as a string of Scheme.

    Raises
    ------
    SpeechError
        It has a quote or a backslash.
    """
    if '"' in text or "\\" in text:
        raise SpeechError(f"synthesiser festival: {text!r}; expected no quotes or backslashes")
    return f'"{text}"'


def _end(process: subprocess.Popen[str]) -> None:
    """End Festival, which stops where its input ends."""
    with process:
        process.kill()


def voice_files(name: str, debian: str) -> InstalledFile:
    """Return the folder of a voice, as a requirement."""
    return InstalledFile(VOICES / name, debian)


SYNTHESISER = Synthesiser(
    "festival",
    "BSD-like (Edinburgh, CMU), program and voices",
    (
        Voice("kal_diphone", "festvox", "kal", 185.0),
        Voice("ked_diphone", "festvox", "ked", 185.0),
    ),
    create=Festival,
    requires=(
        Command("festival", debian="festival"),
        voice_files("english/kal_diphone", "festvox-kallpc16k"),
        voice_files("english/ked_diphone", "festvox-kdlpc16k"),
    ),
)
