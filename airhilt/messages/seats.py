"""Messages between a run and the people at its seats."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Base64Bytes, Field, field_validator, model_validator

from airhilt.commands import Command
from airhilt.messages.base import Limit, Message, Part, Severity
from airhilt.messages.radio import TransmissionChunk, TransmissionClosed, TransmissionOpened

Use = Literal["voice", "words"]
"""Use to which a person may agree: of the voice and of typed words, or of typed words alone."""


class SeatAudioOpened(TransmissionOpened):
    """``seat/<seat>/audio``: attachment without payload; a seat begins to receive a transmission.

    Only a seat has it whose receiver has a reception of its own. Whoever keyed is not known there.
    """

    seat: str


class SeatAudioChunk(TransmissionChunk):
    """``seat/<seat>/audio``: attachment to at most 0.5 s of what a seat receives, as PCM."""

    seat: str


class SeatAudioClosed(TransmissionClosed):
    """``seat/<seat>/audio``: attachment without payload; a transmission that a seat got has ended.

    ``snr_db`` is the ratio at the seat.
    """

    seat: str


SeatAudio = Annotated[
    SeatAudioOpened | SeatAudioChunk | SeatAudioClosed, Field(discriminator="phase")
]
"""Messages on ``seat/<seat>/audio``."""


class ActorCommand(Message):
    """``command/<actor>``: command of a person or an external program to an actor."""

    limit = Limit(size_bytes=16_000, rate_hz=50)
    command: Command


class SpokenWords(Message):
    """``speech/<seat>``: words that the person at a seat says on the radio, in the seat's voice.

    The seat is the name of a unit or a callsign; what is no letter or digit of it is ``_``.
    """

    limit = Limit(size_bytes=4_000, rate_hz=5)
    text: str = Field(min_length=1, max_length=600)
    frequency_khz: int | None = Field(
        default=None,
        ge=118_000,
        le=137_000,
        description="in the aeronautical mobile band; null: the first one of the seat",
    )


FROM_MICROPHONE = "microphone."
"""Beginning of the ids of the transmissions that people speak."""


class MicrophoneAudio(Message):
    """``microphone/<seat>``: what the person at a seat says while the transmit button is held.

    First comes ``pressed``, then ``samples`` while the person speaks, then ``released``. The audio
    is PCM, 16 kHz, mono, 16 bits, little-endian, in base64.
    """

    limit = Limit(size_bytes=64_000, rate_hz=100)
    phase: Literal["pressed", "samples", "released"]
    frequency_khz: int | None = Field(
        default=None, ge=118_000, le=137_000, description="when pressed; null: as `SpokenWords`"
    )
    delay_s: float = Field(
        default=0.0,
        ge=0.0,
        le=60.0,
        description="from pressing the button until the message was sent, in s of wall time",
    )
    pcm: Base64Bytes = Field(
        default=b"",
        max_length=32_000,
        description="at most 1 s; empty in the log of a run with `--no-voice-recording`",
    )

    @field_validator("pcm")
    @classmethod
    def _has_whole_samples(cls, pcm: bytes) -> bytes:
        if len(pcm) % 2:
            raise ValueError(f"{len(pcm)} bytes; expected an even number: samples have 16 bits")
        return pcm


class SeatListening(Message):
    """``listening/<seat>``: the frequencies that the person at a seat listens to, from now on.

    A person who has just taken a seat listens to all of its frequencies.
    """

    limit = Limit(size_bytes=1_000, rate_hz=5)
    frequencies_khz: tuple[Annotated[int, Field(ge=118_000, le=137_000)], ...] = Field(
        max_length=20, description="empty: to none"
    )


class SeatConsent(Message):
    """``consent/<seat>``: answer of the person at a seat who was told what becomes of the words.

    `SeatInfo` says if the voice is recorded, and so do the options of the run.
    """

    limit = Limit(size_bytes=500, rate_hz=5)
    what: Use = Field(
        default="voice",
        description="use to which the person agrees or not: of voice and typed words, or of typed "
        "words alone",
    )
    is_given: bool = Field(
        description="false: it is declined or taken back, and the microphone is closed, or the "
        "words are not said"
    )

    def applied_to(self, agreed: frozenset[Use]) -> frozenset[Use]:
        """Return the uses to which a person agrees after this answer, from those before it.

        Consent to the use of the voice covers typed words, so who declines the use of words
        declines that of the voice too.
        """
        if self.is_given:
            return agreed | {self.what}
        return agreed - ({"voice"} if self.what == "voice" else {"voice", "words"})


class AdvisoryPerceived(Message):
    """``perceived/<seat>``: an advisory reached the person at a seat, as the page of the seat says.

    ``t_ns`` is when the page said so.
    """

    limit = Limit(size_bytes=2_000, rate_hz=50)
    id: str = Field(max_length=200, description="of the advisory")
    revision: int = Field(ge=0)
    recipient: str = Field(max_length=200)
    way: Literal["seen", "heard"]
    after_s: float = Field(
        default=0.0,
        ge=-10.0,
        le=10.0,
        description="time from ``t_ns`` until it was drawn, or its first sample was audible, by "
        "the clock of the browser; negative if that was before",
    )


class CallHeard(Message):
    """``heard/<seat>``: a transmission is audible at a seat from its beginning, as its page says.

    ``t_ns`` is when the page said so. The page says nothing of what it left out the beginning of,
    as while its person was transmitting.
    """

    limit = Limit(size_bytes=500, rate_hz=50)
    id: str = Field(max_length=200, description="of the transmission")
    after_s: float = Field(
        default=0.0,
        ge=-10.0,
        le=10.0,
        description="time from ``t_ns`` until its first sample was audible, by the clock of the "
        "browser; negative if that was before",
    )


class PaceCommand(Message):
    """``pace``: how fast the time of a run with seats is to pass, as a person asks for."""

    limit = Limit(size_bytes=500, rate_hz=5)
    factor: float = Field(
        ge=0.0, le=1.0, description="of real time; 0 lets it stand still, less than 0.1 is 0.1"
    )

    @field_validator("factor")
    @classmethod
    def _moves_or_stands(cls, factor: float) -> float:
        return factor if factor == 0.0 else max(factor, 0.1)


class NasaTlx(Part):
    """Ratings of the NASA Task Load Index (Hart & Staveland 1988), from 0 to 100 in steps of 5.

    Performance is 0 for perfect and 100 for failure.
    """

    mental_demand: int = Field(ge=0, le=100, multiple_of=5)
    physical_demand: int = Field(ge=0, le=100, multiple_of=5)
    temporal_demand: int = Field(ge=0, le=100, multiple_of=5)
    performance: int = Field(ge=0, le=100, multiple_of=5)
    effort: int = Field(ge=0, le=100, multiple_of=5)
    frustration: int = Field(ge=0, le=100, multiple_of=5)

    @property
    def raw_tlx(self) -> float:
        """Mean of the six ratings (Hart 2006)."""
        ratings: list[int] = list(self.model_dump().values())
        return sum(ratings) / len(ratings)


class WorkloadQuestion(Message):
    """``question/<seat>``: the person at a seat is asked how high the workload is.

    ISA (Tattersall & Foord 1996) is one number for now, asked while the run goes on; NASA-TLX is
    asked when it has come to its end, and time stands still.
    """

    seat: str
    number: int = Field(ge=1, description="of the question at this seat")
    scale: Literal["isa", "nasa_tlx"]


class WorkloadAnswer(Message):
    """``workload/<seat>``: answer of the person at a seat to a question; without a rating, none."""

    limit = Limit(size_bytes=1_000, rate_hz=5)
    question: int = Field(ge=1, description="its number")
    isa: int | None = Field(
        default=None,
        ge=1,
        le=5,
        description="1 under-utilised, 2 relaxed, 3 comfortable, 4 high, 5 excessive",
    )
    nasa_tlx: NasaTlx | None = None

    @model_validator(mode="after")
    def _has_one_scale(self) -> WorkloadAnswer:
        if self.isa is not None and self.nasa_tlx is not None:
            raise ValueError("isa and nasa_tlx; expected one of the two")
        return self


LONGEST_REFUSAL = 400
"""Greatest length of a refusal of a page in the log, in characters."""


class PageRefusal(Message):
    """``page``: what the page of a run has refused a browser or a stranger, in words.

    In the log it is an event of the kind ``refused``; it changes nothing of the run.
    """

    limit = Limit(size_bytes=2_000, rate_hz=50)
    text: str = Field(min_length=1, max_length=LONGEST_REFUSAL)


class SeatPresence(Message):
    """``seat/<seat>``: a person has taken a seat, or has left it.

    The run makes it of the liveliness token ``seat/<seat>``, which the page of the seat declares.
    """

    is_taken: bool


class SeatInfo(Message):
    """``seat/<seat>/info``: what the person at a seat has to know, also answered to a query."""

    seat: str
    category: Literal["unit", "aircraft", "vehicle"] = "unit"
    icao24: str | None = Field(default=None, description="address of the actor; null for a unit")
    has_adsb_in: bool = Field(
        default=False, description="true if the actor shows its crew the ADS-B of others"
    )
    recipients: tuple[str, ...] = Field(
        default=(), description="names under which advisories are for the person at the seat"
    )
    frequencies_khz: tuple[int, ...]
    has_sound: bool = Field(description="false in a run without speech: nobody can be heard")
    is_recognised: bool = Field(
        description="true if a recogniser takes part, so that automata understand a spoken call"
    )
    voice_is_recorded: bool
    has_own_receiver: bool = Field(
        default=False,
        description="true if the person hears what is on ``seat/<seat>/audio``; false: what the "
        "receiver at the units' site gets",
    )
    longest_call_s: float = Field(description="a call is cut after this time")
    may_pause: bool = Field(
        default=True, description="false in a run that refuses pause and slow motion"
    )
    spoken_from: Severity | None = Field(
        default=None,
        description="least severity that the assistant speaks; null: it has no voice, or none any "
        "more",
    )
    phraseology: Literal["faa", "icao"] = "faa"


class SeatNotice(Message):
    """``notice/<seat>``: something that the person at a seat is told in words."""

    seat: str
    text: str


class TaskCard(Message):
    """``task/<seat>``: a call of the script that is due, and that the person at a seat is to make.

    A call to the same addressee with the same instructions stands for it.
    """

    line: str = Field(description="id of the line of the script")
    seat: str
    addressed: str | None
    frequency_khz: int
    text: str = Field(description="words of the script")
    is_done: bool = Field(default=False, description="true once its addressee has taken it")


class CommandOffer(Message):
    """``offer/<seat>``: a command that the person at a seat may give because of a call.

    An automaton would carry it out because of the call. The person gives it on ``command/<actor>``.
    """

    seat: str
    number: int = Field(ge=1, description="of the offer in this run")
    call: str = Field(description="id of the call that was taken, or that is due at the seat")
    command: Command
    is_over: bool = Field(
        default=False,
        description="true once it is given or offered anew, others have taken its place, or the "
        "person has left",
    )


SEAT_AUDIO = "seat/*/audio"
"""Keys of the sound that the receiver of one seat gets: nobody else hears it."""
SEAT_KEYS = (
    "task", "offer", "speech", "microphone", "listening", "consent", "perceived", "heard",
    "question", "workload", "notice",
)  # fmt: skip
"""First parts of the keys between a run and the people at its seats: they have the words of the
script before they are said, and exactly what people say and do."""


KEYS: dict[str, type[Message]] = {
    "command/{actor}": ActorCommand,
    "speech/{seat}": SpokenWords,
    "microphone/{seat}": MicrophoneAudio,
    "listening/{seat}": SeatListening,
    "consent/{seat}": SeatConsent,
    "perceived/{seat}": AdvisoryPerceived,
    "heard/{seat}": CallHeard,
    "pace": PaceCommand,
    "page": PageRefusal,
    "seat/{seat}": SeatPresence,
    "seat/{seat}/info": SeatInfo,
    "seat/{seat}/audio (opened)": SeatAudioOpened,
    "seat/{seat}/audio (chunk)": SeatAudioChunk,
    "seat/{seat}/audio (closed)": SeatAudioClosed,
    "notice/{seat}": SeatNotice,
    "question/{seat}": WorkloadQuestion,
    "workload/{seat}": WorkloadAnswer,
    "task/{seat}": TaskCard,
    "offer/{seat}": CommandOffer,
}
"""The message of each key below ``airhilt/<run>/``."""
