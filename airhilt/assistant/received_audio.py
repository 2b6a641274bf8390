"""The samples of a transmission that a worker was given."""

from __future__ import annotations

from airhilt.audio.pcm import SAMPLE_BYTES, SAMPLE_RATE_HZ, Audio, from_pcm
from airhilt.errors import SpeechError
from airhilt.messages import EnhancedTransmission, Transmission


def pcm_to_audio(header: Transmission | EnhancedTransmission, pcm: bytes) -> Audio:
    """Return the samples of a transmission.

    Raises
    ------
    SpeechError
        Their number or their rate is not what the header says.
    """
    if header.sample_rate_hz != SAMPLE_RATE_HZ or len(pcm) != SAMPLE_BYTES * header.samples:
        raise SpeechError(
            f"transmission {header.id}: {len(pcm)} bytes at {header.sample_rate_hz} Hz; expected "
            f"{header.samples} samples of 16 bits at {SAMPLE_RATE_HZ} Hz"
        )
    return from_pcm(pcm)
