"""WAV: the sound of each frequency of a run, with its transcript."""

from __future__ import annotations

from pathlib import Path

from airhilt.errors import SpeechError
from airhilt.metrics.result import Result
from airhilt.report.frequency import read_frequencies, write_recording


def write(run: Result, out: Path) -> list[Path]:
    """Write the sound of each frequency with the timing of the run, and its transcript."""
    files = []
    for recording in read_frequencies(run):
        wav = out / f"frequency-{recording.frequency_khz}.wav"
        files += [wav, write_recording(recording, wav)]
    if not files:
        raise SpeechError(
            f"{run.folder}: a run without sound; expected one that was made without --no-speech"
        )
    return files
