"""``audio/``: what was on the air and what the assistant said, a WAV file each.

The files are named after the messages that they belong to, whose SHA-256 is in the log, so that
the log vouches for them.
"""

from __future__ import annotations

from pathlib import Path

from airhilt.errors import RunFolderError
from airhilt.messages import AdvisoryAudio, Message, Transmission
from airhilt.radio.voices.wav import from_pcm, write_wav


def audio_file(folder: Path, message: Transmission | AdvisoryAudio) -> Path:
    """Return where the sound of a message lies in the ``audio`` folder of a run."""
    match message:
        case Transmission(id=name):
            stem = name
        case AdvisoryAudio(id=name, revision=revision):
            stem = f"advisory-{name}-{revision}"
    return folder / f"{''.join(c if c.isalnum() or c in '._-' else '_' for c in stem)}.wav"


class AudioRecorder:
    """Writes the sound of each message that has any, as it is published."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def take(self, key: str, message: Message, payload: bytes) -> None:  # noqa: ARG002
        """Write the sound of a message.

        Raises
        ------
        RunFolderError
            The disk takes no more.
        """
        if not isinstance(message, (Transmission, AdvisoryAudio)) or not payload:
            return
        try:
            self._folder.mkdir(exist_ok=True)
        except OSError as error:
            raise RunFolderError(f"{self._folder}: cannot be made: {error.strerror}") from None
        write_wav(audio_file(self._folder, message), from_pcm(payload))
