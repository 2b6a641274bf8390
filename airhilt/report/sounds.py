"""Puts the sound of a run into its report, as far as there is room."""

from __future__ import annotations

import base64
import io
import os
import wave
from pathlib import Path
from urllib.parse import quote

from airhilt.audio.wav import SAMPLE_BYTES, from_pcm, to_pcm
from airhilt.errors import RunFolderError
from airhilt.messages import AdvisoryAudio, Transmission
from airhilt.record.audio import audio_file, recorded_pcm
from airhilt.voices.engine import SAMPLE_RATE_HZ, Audio

RATE_HZ = 8_000
"""In the page. Aeronautical VHF carries 300 to 3400 Hz (ETSI EN 300 676-1), which this leaves."""
MOST_CHARACTERS = 6_000_000
"""Of all sound in a page: more than four minutes."""

Sound = dict[str, str]
"""``src`` of a sound in the page, or ``href`` of its file."""


class Sounds:
    """Gives the sounds of a run folder to its page.

    Attributes
    ----------
    linked
        How many had no room, and are linked to.
    missing
        How many have no file, or one that is not what the log says.
    """

    def __init__(self, folder: Path, page: Path) -> None:
        self.linked = 0
        self.missing = 0
        self._folder = folder
        self._page = page
        self._room = MOST_CHARACTERS

    def of(self, message: Transmission | AdvisoryAudio) -> Sound | None:
        """Return the sound of a message, None if it has none."""
        if not message.samples:
            return None
        try:
            audio = from_pcm(recorded_pcm(self._folder, message))
        except RunFolderError:
            self.missing += 1
            return None
        size = 4 * -(-len(audio) * SAMPLE_BYTES * RATE_HZ // SAMPLE_RATE_HZ // 3)
        if size > self._room:
            self.linked += 1
            path = os.path.relpath(audio_file(self._folder, message), self._page.parent)
            return {"href": quote(path.replace(os.sep, "/"))}
        source = "data:audio/wav;base64," + base64.b64encode(_small_wav(audio)).decode()
        self._room -= len(source)
        return {"src": source}


def _small_wav(audio: Audio) -> bytes:
    # Not at the top: most reports have no sound, and this takes long to import.
    from scipy.signal import resample_poly

    stream = io.BytesIO()
    with wave.open(stream, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(SAMPLE_BYTES)
        file.setframerate(RATE_HZ)
        file.writeframes(to_pcm(resample_poly(audio, RATE_HZ, SAMPLE_RATE_HZ)))
    return stream.getvalue()
