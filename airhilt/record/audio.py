"""``audio/``: the sound of each transmission and spoken advisory, a WAV file each.

The files are named after their messages. The log has the SHA-256 of the samples.
"""

from __future__ import annotations

import hashlib
from contextlib import suppress
from pathlib import Path

from airhilt.audio.pcm import from_pcm, to_pcm
from airhilt.audio.wav import LARGEST_WAV_BYTES, decode_wav, encode_wav
from airhilt.errors import RunFolderError, SpeechError, writing_to_run
from airhilt.host.files import make_folder, read_inside
from airhilt.messages import (
    FROM_MICROPHONE,
    AdvisoryAudio,
    EnhancedTransmission,
    Message,
    SeatAudioClosed,
    Transmission,
    TransmissionChunk,
    TransmissionClosed,
)
from airhilt.sim.payload import Payload

MessageWithSound = (
    Transmission | TransmissionClosed | SeatAudioClosed | EnhancedTransmission | AdvisoryAudio
)
"""A message whose sound is written to a file of its own."""


def audio_file(folder: Path, message: MessageWithSound) -> Path:
    """Return the path of the sound of a message in the ``audio`` folder of a run."""
    stem = message.id
    if isinstance(message, AdvisoryAudio):
        stem = f"advisory-{message.id}-{message.revision}-{message.recipient}"
    elif isinstance(message, EnhancedTransmission):
        stem = f"enhanced-{message.id}"
    elif isinstance(message, SeatAudioClosed):
        stem = f"seat-{message.seat}-{message.id}"
    return folder / f"{''.join(c if c.isalnum() or c in '._-' else '_' for c in stem)}.wav"


class AudioRecorder:
    """Writes the sound of each message that has any, as it is published.

    The chunks of a transmission are written if no `Transmission` has their samples: its sender or
    the sound of the radio was lost while it lasted. Those of a receiver of a seat always are. What
    people have spoken is left out unless voices are kept.
    """

    def __init__(self, folder: Path, *, keeps_voices: bool = True) -> None:
        self._folder = folder
        self._keeps_voices = keeps_voices
        self._chunks: dict[tuple[str, str], bytearray] = {}
        """PCM of the transmissions that are on the air, by the key of their chunks and by id."""

    def take(self, key: str, message: Message, payload: Payload) -> None:
        """Write the sound of a message; `RunFolderError` if the disk is full or gone."""
        match message:
            case TransmissionChunk():
                self._chunks.setdefault((key, message.id), bytearray()).extend(bytes(payload))
            case TransmissionClosed():
                pcm = bytes(self._chunks.pop((key, message.id), b""))
                if pcm and (isinstance(message, SeatAudioClosed) or not message.is_complete):
                    self._write(message, pcm)
            case Transmission() | EnhancedTransmission() | AdvisoryAudio() if payload:
                self._write(message, bytes(payload))

    def _write(self, message: MessageWithSound, pcm: bytes) -> None:
        if not self._keeps_voices and message.id.startswith(FROM_MICROPHONE):
            return
        path = audio_file(self._folder, message)
        try:
            with writing_to_run(path):
                make_folder(self._folder)
                path.write_bytes(encode_wav(from_pcm(pcm)))
        except RunFolderError:
            with suppress(OSError):
                path.unlink()
            raise


def recorded_pcm(folder: Path, message: MessageWithSound) -> bytes:
    """Return the PCM of a message from the ``audio`` folder of its run.

    It raises `RunFolderError` if its file is missing, or has other samples than the message says.
    """
    path = audio_file(folder, message)
    try:
        data = read_inside(folder.parent, path, LARGEST_WAV_BYTES)
        pcm = to_pcm(decode_wav(data, str(path)))
    except OSError as error:
        raise RunFolderError(f"{path}: cannot be read: {error.strerror}") from None
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
