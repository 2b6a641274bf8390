"""The sound of a transmission of a recorded run."""

from __future__ import annotations

from airhilt.messages import Transmission
from airhilt.record import Run
from airhilt.record.audio import audio_file, recorded_pcm


def recorded_sound(run: Run, transmission: Transmission) -> bytes:
    """Return the PCM of a transmission; empty if it has none, or the run kept no voices.

    It raises `RunFolderError` if the sound is not what the run wrote.
    """
    folder = run.paths.audio_path
    if not transmission.samples or not audio_file(folder, transmission).exists():
        return b""
    return recorded_pcm(folder, transmission)
