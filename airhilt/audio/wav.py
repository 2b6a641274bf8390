"""WAV files.

A file of anything but 16 kHz, mono, 16 bits is refused and not converted, so that nobody measures
a resampler without knowing. Only the speech of a voice may have another rate.
"""

from __future__ import annotations

import io
import wave
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

from airhilt.audio.pcm import SAMPLE_BYTES, SAMPLE_RATE_HZ, Audio, from_pcm, to_pcm
from airhilt.audio.resampling import resampled
from airhilt.errors import SpeechError
from airhilt.host.files import read_file, replacing

LARGEST_WAV_BYTES = 100_000_000
"""Size of the largest file that is read: 52 minutes."""
SPEECH_RATES_HZ = (8_000, 96_000)
"""Least and greatest sample rate of speech that is resampled."""
LEAST_UNKNOWN_BYTES = 0x7FFF_0000
"""Size in a header from which it stands for "up to the end": who streams a file does not know its
size, and writes a number near 2^31 or 2^32."""


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
    return from_pcm(_read(data, source, (SAMPLE_RATE_HZ, SAMPLE_RATE_HZ))[1])


def decode_speech(data: bytes, source: str) -> Audio:
    """Return the samples of a WAV file of any rate in `SPEECH_RATES_HZ`, resampled to 16 kHz.

    It takes and raises what `decode_wav` does.
    """
    rate_hz, pcm = _read(data, source, SPEECH_RATES_HZ)
    return resampled(from_pcm(pcm), rate_hz)


def _read(data: bytes, source: str, rates_hz: tuple[int, int]) -> tuple[int, bytes]:
    """Return the sample rate and the PCM of a WAV file whose rate is in a range."""
    try:
        with wave.open(io.BytesIO(data), "rb") as file:
            rate_hz, channels = file.getframerate(), file.getnchannels()
            bits, frames = 8 * file.getsampwidth(), file.getnframes()
            pcm = file.readframes(frames)
    except (wave.Error, EOFError, RuntimeError) as error:  # RuntimeError: a chunk that ends too far
        raise SpeechError(
            f"{source}: no WAV file with PCM: {str(error) or 'it breaks off in its header'}"
        ) from None
    least_hz, greatest_hz = rates_hz
    if (channels, bits) != (1, 8 * SAMPLE_BYTES) or not least_hz <= rate_hz <= greatest_hz:
        rates = f"{least_hz}" if least_hz == greatest_hz else f"{least_hz} to {greatest_hz}"
        expected = _format(rates, 1, 8 * SAMPLE_BYTES)
        raise SpeechError(
            f"{source}: {_format(rate_hz, channels, bits)}; expected {expected}; convert it with "
            "`sox IN -r 16000 -c 1 -b 16 OUT`"
        )
    if frames * SAMPLE_BYTES >= LEAST_UNKNOWN_BYTES:
        frames = len(pcm) // SAMPLE_BYTES
        pcm = pcm[: frames * SAMPLE_BYTES]
    if frames == 0:
        raise SpeechError(f"{source}: a WAV file without samples; expected speech")
    if len(pcm) != frames * SAMPLE_BYTES:
        raise SpeechError(
            f"{source}: truncated: {len(pcm) // SAMPLE_BYTES} samples; its header promises {frames}"
        )
    return rate_hz, pcm


def _format(rate: str | int, channels: int, bits: int) -> str:
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
