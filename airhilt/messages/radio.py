"""Messages of the radio: transmissions as received, whole and piece by piece."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from airhilt.messages.base import Header, Limit, Nanoseconds

ASSISTANT = "ASSISTANT"
"""The assistant as a speaker: the name of its voice, and of its transmitter."""
ADVISORY_CALL = "advisory."
"""Beginning of the ids of the transmissions in which the assistant speaks its advisories."""


class Transmission(Header):
    """``radio/<freq_khz>/tx``: attachment to one transmission as received, PCM 16 kHz mono.

    ``samples`` is 0 in a run without speech: the transmission takes its time on the frequency, and
    its words arrive as a `Transcript` with the engine ``text``. ``samples`` is 0 as well after the
    sound of the radio is lost; then the words do not arrive.
    """

    id: str
    frequency_khz: int
    t_tx_ns: Nanoseconds = Field(description="start of the transmission")
    t_end_ns: Nanoseconds
    keyed_by: str | None = Field(
        default=None,
        description="unit at the receiver's site whose transmitter was keyed: a controller, or "
        "ASSISTANT; null: it came over the air",
    )
    snr_db: float | None = None
    sample_rate_hz: int = 16_000
    samples: int = 0
    sha256: str = Field(default="", description="of the PCM; empty without samples")


class EnhancedTransmission(Header):
    """``enhanced/<freq_khz>``: attachment to one transmission with less noise, PCM 16 kHz mono.

    It is there only in runs with an enhancer.
    """

    limit = Limit(size_bytes=32_000_000, rate_hz=10)
    id: str = Field(description="id of the transmission")
    frequency_khz: int
    t_tx_ns: Nanoseconds = Field(description="start of the transmission")
    t_end_ns: Nanoseconds
    keyed_by: str | None = Field(default=None, description="as in the `Transmission`")
    sample_rate_hz: int = 16_000
    samples: int = Field(ge=1)
    sha256: str = Field(description="of the PCM")
    enhancer: str = Field(description="name of the engine")


class TransmissionOpened(Header):
    """``radio/<freq_khz>/audio``: attachment without payload; a transmission has begun.

    Its chunks follow while it lasts, then `TransmissionClosed`.
    """

    phase: Literal["opened"] = "opened"
    id: str
    frequency_khz: int
    t_tx_ns: Nanoseconds = Field(description="start of the transmission")
    keyed_by: str | None = Field(
        default=None,
        description="unit at the receiver's site whose transmitter was keyed: a controller, or "
        "ASSISTANT; null: it came over the air",
    )
    sample_rate_hz: int = 16_000


class TransmissionChunk(Header):
    """``radio/<freq_khz>/audio``: attachment to at most 0.5 s of a transmission, PCM 16 kHz mono.

    ``t_ns`` is not before its last sample was on the air. The chunks of a transmission, one after
    the other, are the samples of its `Transmission`.
    """

    phase: Literal["chunk"] = "chunk"
    id: str
    frequency_khz: int
    seq: int = Field(ge=0, description="0 for the first chunk of the transmission")
    first_sample: int = Field(ge=0, description="number of samples in the chunks before it")
    samples: int = Field(ge=1)
    sha256: str = Field(description="of the PCM")


class TransmissionClosed(Header):
    """``radio/<freq_khz>/audio``: attachment without payload; a transmission has ended."""

    phase: Literal["closed"] = "closed"
    id: str
    frequency_khz: int
    t_tx_ns: Nanoseconds
    t_end_ns: Nanoseconds
    samples: int = Field(ge=0, description="in all chunks together")
    sha256: str = Field(default="", description="of the PCM of all chunks; empty without samples")
    snr_db: float | None = None
    is_complete: bool = Field(
        default=True,
        description="false: its sender or the sound of the radio was lost while it lasted, and no "
        "`Transmission` has these samples",
    )


TransmissionAudio = Annotated[
    TransmissionOpened | TransmissionChunk | TransmissionClosed, Field(discriminator="phase")
]
"""Messages on ``radio/<freq_khz>/audio``."""
