"""``audio/``: what was on the air and what the assistant said, a WAV file each.

The files are named after the messages that they belong to, whose SHA-256 is in the log, so that
the log vouches for them.
"""

from __future__ import annotations

import hashlib
from contextlib import suppress
from pathlib import Path

from airhilt.audio.wav import encode_wav, from_pcm, read_wav, to_pcm
from airhilt.errors import RunFolderError, SpeechError, disk_failed
from airhilt.messages import AdvisoryAudio, Message, Transmission


def audio_file(folder: Path, message: Transmission | AdvisoryAudio) -> Path:
    """Return where the sound of a message lies in the ``audio`` folder of a run."""
    match message:
        case Transmission(id=name):
            stem = name
        case AdvisoryAudio(id=name, revision=revision, recipient=recipient):
            stem = f"advisory-{name}-{revision}-{recipient}"
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
        path = audio_file(self._folder, message)
        try:
            self._folder.mkdir(exist_ok=True)
            path.write_bytes(encode_wav(from_pcm(payload)))
        except OSError as error:
            with suppress(OSError):
                path.unlink()
            raise disk_failed(str(path), error) from None


def recorded_pcm(folder: Path, message: Transmission | AdvisoryAudio) -> bytes:
    """Return the PCM of a message from the ``audio`` folder of its run.

    Raises
    ------
    RunFolderError
        Its file is missing, or holds something else than the message vouches for.
    """
    path = audio_file(folder, message)
    try:
        pcm = to_pcm(read_wav(path))
    except SpeechError as error:
        raise RunFolderError(
            f"{error}; expected the sound of {message.id!r}, as the run wrote it"
        ) from None
    if hashlib.sha256(pcm).hexdigest() != message.sha256:
        raise RunFolderError(
            f"{path}: not the sound that the log vouches for; expected the SHA-256 of its samples "
            f"to be {message.sha256}"
        )
    return pcm
