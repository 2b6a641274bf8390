"""WAV files.

A file of anything but 16 kHz, mono, 16 bits is refused and not converted, so that nobody measures
a resampler without knowing.
"""

from __future__ import annotations

import io
import wave
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

from airhilt.audio.pcm import SAMPLE_BYTES, SAMPLE_RATE_HZ, Audio, from_pcm, to_pcm
from airhilt.errors import SpeechError
from airhilt.host.files import read_file, replacing

LARGEST_WAV_BYTES = 100_000_000
"""Size of the largest file that is read: 52 minutes."""


def encode_wav(audio: Audio) -> bytes:
    """Return samples as the bytes of a WAV file; it raises what `to_pcm` does."""
    stream = io.BytesIO()
    _write(stream, (audio,))
    return stream.getvalue()


def _write(stream: BinaryIO, pieces: Iterable[Audio]) -> None:
    with wave.open(stream, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(SAMPLE_BYTES)
        file.setframerate(SAMPLE_RATE_HZ)
        for piece in pieces:
            file.writeframes(to_pcm(piece))


def decode_wav(data: bytes, source: str) -> Audio:
    """Return the samples of a WAV file.

    Parameters
    ----------
    source
        Origin of the bytes, for messages.

    Raises
    ------
    SpeechError
        It is no WAV file, of another format than 16 kHz, mono, 16 bits, empty or truncated.
    """
    try:
        with wave.open(io.BytesIO(data), "rb") as file:
            found = (file.getframerate(), file.getnchannels(), 8 * file.getsampwidth())
            frames = file.getnframes()
            pcm = file.readframes(frames)
    except (wave.Error, EOFError, RuntimeError) as error:  # RuntimeError: a chunk that ends too far
        raise SpeechError(
            f"{source}: no WAV file with PCM: {str(error) or 'it breaks off in its header'}"
        ) from None
    expected = (SAMPLE_RATE_HZ, 1, 8 * SAMPLE_BYTES)
    if found != expected:
        raise SpeechError(
            f"{source}: {_format(found)}; expected {_format(expected)}; convert it with "
            "`sox IN -r 16000 -c 1 -b 16 OUT`"
        )
    if frames == 0:
        raise SpeechError(f"{source}: a WAV file without samples; expected speech")
    if len(pcm) != frames * SAMPLE_BYTES:
        raise SpeechError(
            f"{source}: truncated: {len(pcm) // SAMPLE_BYTES} samples; its header promises {frames}"
        )
    return from_pcm(pcm)


def _format(rate_channels_bits: tuple[int, int, int]) -> str:
    rate, channels, bits = rate_channels_bits
    return f"{rate} Hz, {'mono' if channels == 1 else f'{channels} channels'}, {bits} bits"


def read_wav(path: Path) -> Audio:
    """Return the samples of a WAV file.

    Raises
    ------
    SpeechError
        It cannot be read, or as `decode_wav`.
    """
    if path.exists() and not path.is_file():  # A pipe may have no end.
        raise SpeechError(f"{path}: cannot be read: no regular file")
    try:
        data = read_file(path, LARGEST_WAV_BYTES)
    except OSError as error:
        raise SpeechError(f"{path}: cannot be read: {error.strerror}") from None
    return decode_wav(data, str(path))


def write_wav(path: Path, audio: Audio) -> None:
    """Write samples to a WAV file; see `write_wav_pieces`."""
    write_wav_pieces(path, (audio,))


def write_wav_pieces(path: Path, pieces: Iterable[Audio]) -> None:
    """Write samples to a WAV file as they come, all or nothing.

    Raises
    ------
    SpeechError
        It cannot be written, or as `to_pcm`.
    """
    try:
        with replacing(path) as stream:
            _write(stream, pieces)
    except OSError as error:
        raise SpeechError(f"{path}: cannot be written: {error.strerror}") from None
