"""Puts the sound of a run into its report, as far as there is room."""

from __future__ import annotations

import base64
import io
import wave

import numpy as np

from airhilt.audio.pcm import SAMPLE_BYTES, SAMPLE_RATE_HZ, Audio, from_pcm, to_pcm
from airhilt.audio.spectrum import fast_size
from airhilt.errors import RunFolderError
from airhilt.messages import AdvisoryAudio, Transmission
from airhilt.record.audio import audio_file, recorded_pcm
from airhilt.report.data import RunData

RATE_HZ = 8_000
"""Sample rate in the page, in Hz: enough for the 300 to 3400 Hz that aeronautical VHF carries
(ETSI EN 300 676-1)."""
MOST_CHARACTERS = 6_000_000
"""Greatest length of all sound in a page: more than four minutes."""

Sound = dict[str, str]
"""``src`` of a sound in the page, or ``href`` of its file."""


class Sounds:
    """Gives the sounds of a run folder to its page."""

    def __init__(self, run: RunData) -> None:
        self._run = run
        self._linked = 0
        self._missing = 0
        self._room = MOST_CHARACTERS

    def of(self, message: Transmission | AdvisoryAudio) -> Sound | None:
        """Return the sound of a message, None if it has none."""
        if not message.samples:
            return None
        folder = self._run.folder.audio_path
        try:
            audio = from_pcm(recorded_pcm(folder, message))
        except RunFolderError:
            self._missing += 1
            return None
        size = 4 * -(-len(audio) * SAMPLE_BYTES * RATE_HZ // SAMPLE_RATE_HZ // 3)
        if size > self._room:
            self._linked += 1
            return {"href": self._run.link(audio_file(folder, message))}
        source = "data:audio/wav;base64," + base64.b64encode(_small_wav(audio)).decode()
        self._room -= len(source)
        return {"src": source}

    def notes(self) -> list[str]:
        """Return a sentence on the sounds that are not in the page."""
        notes = []
        if self._linked:
            notes.append(
                f"There was no room in this file for the sound of {self._linked} calls and "
                "advisories: they are links to the audio folder of the run."
            )
        if self._missing:
            notes.append(
                f"The sound of {self._missing} calls and advisories is missing in the audio "
                "folder, or is not that of this run."
            )
        return notes


def _small_wav(audio: Audio) -> bytes:
    stream = io.BytesIO()
    with wave.open(stream, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(SAMPLE_BYTES)
        file.setframerate(RATE_HZ)
        file.writeframes(to_pcm(_slower(audio)))
    return stream.getvalue()


def _slower(audio: Audio) -> Audio:
    """Return audio at `RATE_HZ`, by the part of its spectrum that this rate has."""
    step = SAMPLE_RATE_HZ // RATE_HZ
    samples = -(-len(audio) // step)
    size = fast_size(samples)
    spectrum = np.fft.rfft(audio, size * step)[: size // 2 + 1]
    return np.asarray(np.fft.irfft(spectrum, size)[:samples] / step, np.float32)
