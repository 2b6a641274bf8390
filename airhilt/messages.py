"""All messages on the bus. The JSON Schemas that ``airhilt schema`` prints come from here only.

They are in one file, long as it is, so that the author of a worker finds them in one place, in the
order of the data flow: run, sensors, workers, truth, and the protocol of workers.

Times are integer nanoseconds of simulation time. ``t_ns`` is the time of publication. A worker
leaves it out and the run sets it on delivery, because only the run knows how late the worker is.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from functools import lru_cache
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

from pydantic import (
    Base64Bytes,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    TypeAdapter,
    field_validator,
    model_validator,
)

from airhilt.commands import Command

LAST_NS = 2**63 - 1
"""Latest time that a message may name, in ns: the greatest integer of 64 bits, 292 years."""
Nanoseconds = Annotated[
    int, Field(ge=0, le=LAST_NS, description="nanoseconds since the start of the run")
]
Confidence = Annotated[float, Field(ge=0.0, le=1.0)]
VisibleClass = Annotated[
    str,
    Field(
        pattern=r"^[a-z][a-z0-9_-]{0,39}$",
        description="class of what cameras see, by COCO's name where COCO has one",
        examples=["airplane", "truck", "bird", "deer", "coyote"],
    ),
]
"""Class of what cameras see. Each kind of actor has its own; a detector knows those on its card."""


class Part(BaseModel):
    """Part of a message. It is immutable and refuses fields that it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Limit(NamedTuple):
    """Most that a run takes of the messages that come from outside on the keys of a class.

    Attributes
    ----------
    size_bytes
        Greatest size of one message; of raw bytes with a header, that of the bytes.
    rate_hz
        Greatest number in a second of wall time from all programs that take no grants, together.
    """

    size_bytes: int
    rate_hz: int


class Message(Part):
    """Base class of the messages.

    Attributes
    ----------
    limit
        What a run takes of them from outside; None: they never come from outside. The numbers are
        assumptions: at least ten times what AIRHILT's own workers need.
    """

    limit: ClassVar[Limit | None] = None
    t_ns: Nanoseconds = Field(default=0, description="time of publication, set by the run")


class Header(Message):
    """Message that is the attachment to raw bytes, the payload of the key."""


class Severity(StrEnum):
    """Urgency of an advisory, in rising order."""

    INFO = "INFO"
    ADVISORY = "ADVISORY"
    CAUTION = "CAUTION"
    WARNING = "WARNING"

    @property
    def rank(self) -> int:
        """Rank of the severity: 0 for INFO to 3 for WARNING."""
        return _SEVERITY_ORDER.index(self)


_SEVERITY_ORDER = tuple(Severity)

SPEAK_MIN_LEVEL = Severity.CAUTION
"""Least severity that is spoken and counts as a warning (AIRHILT, arXiv 2511.18718); advisories
below it are only shown."""


# --- the run itself -------------------------------------------------------------------------


Use = Literal["voice", "words"]
"""Use to which a person may agree: of the voice and of typed words, or of typed words alone."""
Phase = Literal["waiting", "running", "finished", "stopped"]


class Clock(Message):
    """``clock``: time and phase of the run, also answered to a query on that key. Not logged."""

    run: str
    phase: Phase
    pace: str
    behind_s: float = Field(
        default=0.0,
        ge=0.0,
        description="simulation time by which the run is later than its pace asks",
    )


FORMER_MODALITIES = {"speech": "asr", "voice": "tts"}
"""Names that modalities had up to version 0.4, still understood, by what they are now."""
Modality = Annotated[
    Literal["adsb", "radio", "enhancement", "asr", "tts", "vision", "decision", "equipment"],
    BeforeValidator(
        lambda given: FORMER_MODALITIES.get(given, given) if isinstance(given, str) else given
    ),
]
ModalityState = Literal["on", "off", "lost", "not evaluated"]


class Status(Message):
    """``status/<modality>``: a modality was switched on or off, or lost."""

    modality: Modality
    state: ModalityState
    cause: str = ""


GeodeticPoint = tuple[
    Annotated[float, Field(ge=-90.0, le=90.0)], Annotated[float, Field(ge=-180.0, le=180.0)]
]
"""Latitude and longitude, WGS84, in degrees."""


class RunwayBriefing(Part):
    """Direction of a runway, as charts publish it."""

    ident: str
    threshold: GeodeticPoint
    end: GeodeticPoint
    elevation_ft: float
    width_m: float
    protected_area: tuple[GeodeticPoint, ...] = Field(
        description="corners, in order, of the area that hold-short positions keep clear"
    )


class AirportBriefing(Part):
    """Airport, as charts publish it."""

    icao: str
    elevation_ft: float
    runways: tuple[RunwayBriefing, ...]


class RosterEntry(Part):
    """Aircraft or vehicle that the controller expects."""

    callsign: str
    category: Literal["aircraft", "vehicle"]
    type: str = Field(description="ICAO designator of an aircraft, kind of a vehicle")
    ceiling_ft: float | None = Field(
        default=None, gt=0.0, description="service ceiling of the aircraft type; null: not known"
    )


class Briefing(Message):
    """``briefing``: facts that all participants know before the run begins."""

    controller: str
    horizontal_separation_nm: float = Field(gt=0.0)
    vertical_separation_ft: float = Field(gt=0.0)
    roster: tuple[RosterEntry, ...] = Field(
        default=(), description="aircraft and vehicles that the controller expects"
    )
    airport: AirportBriefing | None = None
    animals: tuple[VisibleClass, ...] = Field(
        default=("bird", "coyote", "deer"), description="classes of pictures that are animals"
    )


ASSISTANT = "ASSISTANT"
"""The assistant as a speaker: the name of its voice, and of its transmitter."""
ADVISORY_CALL = "advisory."
"""Beginning of the ids of the transmissions in which the assistant speaks its advisories."""


# --- sensors --------------------------------------------------------------------------------


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


EmitterCategory = Literal[
    "A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7",
    "B0", "B1", "B2", "B3", "B4", "B6", "B7",
    "C0", "C1", "C2", "C3", "C4", "C5",
]  # fmt: skip
"""ADS-B emitter category (DO-260B, 2.2.3.2.5.2): A1 light, A2 small, A3 large, A5 heavy aircraft,
B6 unmanned aircraft, C1 emergency, C2 service surface vehicle; A0, B0, C0 no information."""


class AdsbReport(Message):
    """``adsb/<icao24>``: state vector from an ADS-B receiver, in the units of DO-260B."""

    icao24: str = Field(pattern=r"^[0-9a-f]{6}$")
    callsign: str | None = Field(description="null until an identification squitter came through")
    latitude_deg: float = Field(ge=-90.0, le=90.0)
    longitude_deg: float = Field(ge=-180.0, le=180.0)
    altitude_ft: float | None = Field(
        description="pressure altitude in steps of 25 ft; null on the ground"
    )
    on_ground: bool = Field(default=False, description="the squitter had the surface format")
    emitter_category: EmitterCategory | None = Field(
        default=None, description="null until an identification squitter came through"
    )
    ground_speed_kt: float = Field(ge=0.0)
    track_deg: float = Field(ge=0.0, lt=360.0)
    vertical_rate_fpm: float = Field(description="in steps of 64 ft/min")
    nacp: int = Field(ge=0, le=11, description="navigation accuracy category for position")
    nacv: int = Field(ge=0, le=4, description="navigation accuracy category for velocity")
    receiver: str
    t_adsb_in_ns: Nanoseconds = Field(description="the squitter reached the receiver")
    t_adsb_out_ns: Nanoseconds = Field(description="the receiver gave out the report")


RadarKind = Literal["terminal", "en_route"]
PlotKind = Literal["primary", "secondary", "combined"]


class RadarInfo(Message):
    """``radar/<site>/info``: constant properties of a radar, published before its plots."""

    site: str
    kind: RadarKind
    latitude_deg: float = Field(ge=-90.0, le=90.0, description="of the antenna")
    longitude_deg: float = Field(ge=-180.0, le=180.0, description="of the antenna")
    altitude_m: float = Field(description="of the antenna, above WGS84 as all altitudes are")
    rotation_s: float = Field(gt=0.0, description="time of one turn of the antenna")
    primary_range_m: float = Field(gt=0.0, description="greatest slant range of primary plots")
    secondary_range_m: float = Field(gt=0.0, description="greatest slant range of replies")


class RadarPlot(Message):
    """``radar/<site>``: one target as one turn of a surveillance radar's antenna found it.

    ``t_ns`` is the end of the sector (1/32 of a turn) in which the beam passed the target. A plot
    does not say what it is of: one aircraft's plots of two turns are connected by nothing but their
    places and, if it has a transponder, its code. The range is a slant range, so the place on the
    ground needs an altitude: that of Mode C, or an assumed one for a primary plot.
    """

    site: str
    kind: PlotKind = Field(
        description="primary: an echo of the skin; secondary: a transponder's reply; combined: "
        "both, at the place of the reply, which is more exact"
    )
    t_plot_ns: Nanoseconds = Field(description="the beam passed the target")
    range_m: float = Field(ge=0.0, description="slant range from the antenna")
    azimuth_deg: float = Field(ge=0.0, lt=360.0, description="from true north at the antenna")
    mode_a: str | None = Field(
        default=None,
        pattern=r"^[0-7]{4}$",
        description="Mode A code (squawk), octal; null in a primary plot, or if it was not valid",
    )
    mode_c_ft: int | None = Field(
        default=None,
        description="pressure altitude in steps of 100 ft; null in a primary plot, or if it was "
        "not valid",
    )


class SurfaceTrack(Message):
    """``surface/<airport>``: one target of an airport's surface surveillance, once a second.

    Radar and multilateration are fused. Only a transponder gives a target a name, tells whether it
    is in the air, and how high.
    """

    airport: str = Field(description="ICAO designator")
    track: int = Field(ge=1, description="number of the track; the same until the target is lost")
    kind: PlotKind = Field(
        description="primary: detected by radar alone; secondary: by multilateration alone; "
        "combined: by both"
    )
    t_track_ns: Nanoseconds = Field(description="the target was measured")
    latitude_deg: float = Field(ge=-90.0, le=90.0)
    longitude_deg: float = Field(ge=-180.0, le=180.0)
    accuracy_m: float = Field(gt=0.0, description="95 % position error")
    altitude_ft: float | None = Field(
        default=None,
        description="pressure altitude in steps of 25 ft; null on the ground, or without a "
        "transponder",
    )
    on_ground: bool | None = Field(default=None, description="null without a transponder")
    ground_speed_kt: float = Field(ge=0.0, description="0 at a standstill")
    track_deg: float | None = Field(
        default=None, ge=0.0, lt=360.0, description="over the ground; null at a standstill"
    )
    icao24: str | None = Field(
        default=None, pattern=r"^[0-9a-f]{6}$", description="null without a transponder"
    )
    callsign: str | None = Field(default=None, description="null without a transponder")


class CockpitInstruments(Message):
    """``cockpit/<callsign>``: what the instruments of an aircraft show its own crew.

    Values are those of the aircraft's own state, rounded finer than a crew can read; errors of the
    instruments are not simulated. The air is the standard atmosphere and altimeters are set to
    1013.25 hPa, so the altitude is the pressure altitude.
    """

    callsign: str
    airspeed_kt: float = Field(ge=0.0, description="calibrated, in steps of 0.1 kt")
    mach: float = Field(ge=0.0)
    altitude_ft: int
    vertical_speed_fpm: int
    north: Literal["magnetic", "true"] = Field(
        description="of heading and track; true where the magnetic variation is not known"
    )
    heading_deg: float = Field(ge=0.0, lt=360.0)
    track_deg: float = Field(ge=0.0, lt=360.0, description="over the ground")
    ground_speed_kt: float = Field(ge=0.0)
    pitch_deg: float = Field(description="positive nose up")
    roll_deg: float = Field(description="positive right wing down")
    gear: float = Field(ge=0.0, le=1.0, description="position: 0 up, 1 down and locked")
    flaps: float = Field(ge=0.0, le=1.0, description="position: 0 up, 1 fully extended")
    on_ground: bool = Field(description="a main wheel carries weight")
    mode: str = Field(
        description="what autopilot and guidance do",
        examples=["en_route", "glide", "go_around", "takeoff_roll"],
    )
    radio_height_ft: int | None = Field(
        default=None,
        description="height of the wheels above the ground by the radio altimeter; null above "
        "2,500 ft, where it shows none",
    )
    selected_altitude_ft: int = Field(description="altitude that is flown to, or held")
    selected_airspeed_kt: int = Field(description="calibrated airspeed that is flown to, or held")


class VehiclePosition(Message):
    """``cockpit/<callsign>/position``: where a vehicle is, by its own moving map.

    Errors of the receiver are not simulated.
    """

    callsign: str
    latitude_deg: float = Field(ge=-90.0, le=90.0)
    longitude_deg: float = Field(ge=-180.0, le=180.0)
    heading_deg: float = Field(ge=0.0, lt=360.0, description="true")
    ground_speed_kt: float = Field(ge=0.0)


TransponderMode = Literal["S", "C"]
"""Mode S, or Modes A and C alone."""


class TcasReply(Message):
    """``tcas/<callsign>``: reply of one transponder to the TCAS II of an aircraft.

    There is one a second from each transponder in reach, unless it is lost. A Mode C reply does not
    say whose it is: two of them are connected by nothing but range and altitude.
    """

    callsign: str = Field(description="of the aircraft that interrogates")
    own_icao24: str = Field(
        pattern=r"^[0-9a-f]{6}$", description="of the aircraft that interrogates"
    )
    mode: TransponderMode
    icao24: str | None = Field(
        default=None,
        pattern=r"^[0-9a-f]{6}$",
        description="of the aircraft that replies; null in a Mode C reply",
    )
    range_m: float = Field(ge=0.0, description="slant range")
    bearing_deg: float = Field(
        ge=0.0, lt=360.0, description="from the own nose, clockwise; its error is large"
    )
    altitude_ft: int = Field(
        description="pressure altitude in steps of 25 ft, of 100 ft in a Mode C reply"
    )
    on_ground: bool = Field(default=False, description="vertical status of a Mode S reply")
    has_tcas: bool = Field(
        default=False,
        description="it has TCAS II as well, and coordinates (field RI of a Mode S reply)",
    )


Box = tuple[float, float, float, float]
"""Left, top, right, bottom in pixels; (0, 0) is the outer corner of the first pixel."""


class CameraView(Part):
    """Pose and projection of a camera.

    The camera is a pinhole without distortion, with square pixels; its axis goes through the middle
    of the picture, (width_px / 2, height_px / 2). It is turned first to the heading, from true
    north, then up by the pitch, then clockwise about its axis by the roll. The values are exact:
    errors of navigation are not simulated.

    The ground of a run is level: `height_m` is the altitude above mean sea level less that of the
    ground, which is the airport's elevation, or the `terrain_elevation_ft` of a scene en route. It
    is neither an ellipsoidal height nor one above the charted end of a runway.
    """

    latitude_deg: float = Field(ge=-90.0, le=90.0)
    longitude_deg: float = Field(ge=-180.0, le=180.0)
    height_m: float = Field(description="above the level ground of the run")
    heading_deg: float = Field(ge=0.0, lt=360.0)
    pitch_deg: float = Field(ge=-90.0, le=90.0)
    roll_deg: float = Field(ge=-180.0, le=180.0)
    horizontal_fov_deg: float = Field(gt=0.0, lt=180.0)
    width_px: int = Field(ge=1)
    height_px: int = Field(ge=1)
    carrier: str | None = Field(
        default=None, description="callsign of the aircraft that it is on; null on the ground"
    )


class CameraInfo(Message):
    """``camera/<camera>/info``: constant properties of a camera, published before its pictures."""

    camera: str
    rate_hz: float = Field(gt=0.0)
    width_px: int = Field(ge=1)
    height_px: int = Field(ge=1)
    horizontal_fov_deg: float = Field(gt=0.0, lt=180.0)
    carrier: str | None = None
    own_aircraft: tuple[int, ...] = Field(
        default=(),
        description="pixels that its own aircraft may cover, as lengths of runs, row by row: "
        "free, covered, free and so on; empty if none",
    )


class CameraFrame(Header):
    """``camera/<camera>/frame``: attachment to one picture, 8-bit sRGB, row by row."""

    camera: str
    seq: int = Field(ge=0)
    t_frame_ns: Nanoseconds = Field(description="end of the exposure")
    view: CameraView
    encoding: Literal["rgb8", "none"] = Field(
        default="rgb8", description="none: the exposure was left out, and there are no pixels"
    )
    sha256: str = Field(description="of the pixels")


# --- workers --------------------------------------------------------------------------------


CONFIRMED_HITS = 3
"""Number of pictures in which an object must be found to be confirmed."""


class Detection(Part):
    """Object that was detected in a picture."""

    label: VisibleClass
    confidence: Confidence
    box: Box
    track_id: int | None = Field(
        default=None, ge=0, description="the same for one object in all pictures"
    )
    hits: int = Field(
        default=1, ge=1, description="number of pictures in which it was found so far"
    )

    @property
    def is_confirmed(self) -> bool:
        """True if the object was found in `CONFIRMED_HITS` pictures or more."""
        return self.hits >= CONFIRMED_HITS

    @field_validator("box")
    @classmethod
    def _has_room(cls, box: Box) -> Box:
        left, top, right, bottom = box
        if not (left < right and top < bottom):
            raise ValueError(
                f"box {box} has no room; expected left, top, right, bottom, no width and height"
            )
        return box


EXPOSURE_LEFT_OUT = "exposure left out"
"""Value of `Detections.missed` for an exposure that the camera left out."""


class Detections(Message):
    """``vision/<camera>``: objects found in one picture; ``t_ns`` is the paper's t_vision."""

    limit = Limit(size_bytes=128_000, rate_hz=200)
    camera: str
    seq: int = Field(ge=0, description="of the picture")
    t_frame_ns: Nanoseconds
    view: CameraView
    detections: tuple[Detection, ...] = ()
    engine: str
    missed: str = Field(
        "",
        description="why the detector did not look at the picture; empty if it did",
    )


class Word(Part):
    """Word of a transcript."""

    text: str
    confidence: Confidence


class Transcript(Message):
    """``asr/<freq_khz>``: the words of one transmission; ``t_ns`` is the paper's t_asr."""

    limit = Limit(size_bytes=32_000, rate_hz=20)
    id: str = Field(description="id of the transmission")
    frequency_khz: int
    t_tx_ns: Nanoseconds
    t_end_ns: Nanoseconds
    text: str
    words: tuple[Word, ...] = Field(
        default=(), description="the words of `text` one by one; empty if the engine has none"
    )
    confidence: Confidence
    engine: str
    speaker: str | None = Field(
        default=None,
        description="who spoke, as far as a receiver can know: the unit whose transmitter was "
        "keyed, or the callsign in the words of what came over the air; null if that is not known",
    )
    addressee: str | None = Field(
        default=None,
        description="whom the call is for: the callsign that a unit calls, or the controller for "
        "what came over the air; null if that is not known",
    )
    overheard: bool | None = Field(
        default=None,
        description="neither by nor for the controller of the briefing, nor the assistant's own "
        "voice; null if that is not known",
    )


class PartialTranscript(Message):
    """``asr/<freq_khz>/partial``: the words of a transmission so far, while it lasts.

    It is published for each 0.5 s of audio, if the run asks for it. The `Transcript` of the whole
    transmission replaces it.
    """

    limit = Limit(size_bytes=32_000, rate_hz=100)
    id: str = Field(description="id of the transmission")
    frequency_khz: int
    t_tx_ns: Nanoseconds
    t_heard_ns: Nanoseconds = Field(description="end of the audio that the words are of")
    text: str
    words: tuple[Word, ...] = Field(
        default=(), description="the words of `text` one by one; empty if the engine has none"
    )
    confidence: Confidence
    stable_words: int = Field(
        ge=0,
        description="number of words of `text`, from the first, that the partial transcript before "
        "has too; the others may change, because little audio follows them",
    )
    engine: str


class Climb(Part):
    """Climb or descend to a level and stay there; the turn is made at the same time."""

    action: Literal["altitude"] = "altitude"
    sense: Literal["climb", "descend"]
    altitude_ft: float
    vertical_rate_fpm: float = Field(gt=0.0)
    turn_deg: float = Field(
        default=0.0, ge=-180.0, le=180.0, description="turn from the present track, to the right"
    )


class Turn(Part):
    """Turn by an angle from the present track."""

    action: Literal["turn"] = "turn"
    degrees: float = Field(ge=-180.0, le=180.0, description="positive to the right")


class MaintainLevel(Part):
    """Stay at, or level off at, a level."""

    action: Literal["maintain"] = "maintain"
    altitude_ft: float


class GoAround(Part):
    """Break the approach off."""

    action: Literal["go_around"] = "go_around"
    runway: str


class CancelTakeoff(Part):
    """Do not take off, or reject the takeoff."""

    action: Literal["cancel_takeoff"] = "cancel_takeoff"
    runway: str


class HoldPosition(Part):
    """Stop where you are, short of the runway."""

    action: Literal["hold_position"] = "hold_position"
    runway: str


class Confirm(Part):
    """Ask for, or say again, what was heard with too little confidence."""

    action: Literal["confirm"] = "confirm"
    callsign: str = Field(description="callsign of the aircraft or vehicle that the call concerns")
    slot: str = Field(
        description="part of the call that is in doubt", examples=["callsign", "runway", "altitude"]
    )


Recommendation = Annotated[
    Climb | Turn | MaintainLevel | GoAround | CancelTakeoff | HoldPosition | Confirm,
    Field(discriminator="action"),
]


class Evidence(Part):
    """Evidence on which an advisory rests."""

    sources: tuple[str, ...] = Field(description="modalities that the advisory rests on")
    time_to_loss_s: float | None = Field(
        default=None, description="time until separation is lost, if nobody reacts"
    )
    time_to_closest_approach_s: float | None = None
    horizontal_at_closest_approach_m: float | None = None
    vertical_at_closest_approach_m: float | None = None
    runway: str | None = None
    time_to_go_s: float | None = Field(
        default=None, description="time until the user of the runway reaches the obstacle"
    )
    note: str = ""
    radio_ids: tuple[str, ...] = Field(default=(), description="ids of transmissions")
    camera_ids: tuple[str, ...] = Field(default=(), description="names of cameras")
    tracks: tuple[str, ...] = Field(
        default=(), description="icao24 of ADS-B tracks, and names of other tracks"
    )
    rules: tuple[str, ...] = Field(
        default=(), description="names of the rules that were triggered", examples=[["occupancy"]]
    )
    shares: dict[str, Confidence] = Field(
        default_factory=dict,
        description="share of each modality in the judgement, by its name in `sources`; they add "
        "up to 1; empty: not told",
    )
    inconsistencies: tuple[str, ...] = Field(
        default=(),
        description="faults of the data that the advisory rests on",
        examples=[["ADS-B of AAL123 inconsistent"]],
    )


AdvisoryKind = Literal[
    "loss_of_separation", "readback_mismatch", "runway_conflict", "clarification"
]
"""Kind of conflict, or ``clarification`` of a call that was heard with too little confidence."""

CONTROLLER = "ATC"
"""Recipient of the advisories to the controller."""


class Advisory(Message):
    """``advisory/<recipient>``: advisory on one conflict to one recipient; ``t_ns`` is t_dec.

    ``id`` begins with the name of the worker, so that ids of two workers differ. The advisory is
    published again with a higher ``revision`` when its severity or recommendation changes, and a
    last time with ``active`` false when the conflict is over.
    """

    limit = Limit(size_bytes=32_000, rate_hz=50)
    id: str = Field(pattern=r"^[A-Za-z0-9_.-]{1,80}$")
    revision: int = Field(ge=0)
    recipient: str = Field(
        pattern=r"^[A-Za-z0-9_-]{1,20}$",
        description="ATC, a callsign, or an icao24 while there is no callsign",
    )
    recipients: tuple[str, ...]
    kind: AdvisoryKind
    severity: Severity
    active: bool = True
    traffic: tuple[str, ...] = Field(description="callsigns (or icao24) of those in conflict")
    message: str
    recommendation: Recommendation | None = None
    evidence: Evidence
    t_ready_ns: Nanoseconds = Field(description="arrival of the last input that it rests on")


class Rejection(Part):
    """Part of the answer of a language model that was not used."""

    subject: str = Field(description="what it is about, such as an advisory and its recipient")
    answered: str = Field(description="what the model answered")
    reason: str


class ModelExchange(Message):
    """``llm/<worker>``: what a language model was asked and answered, and what became of it.

    Where an answer is missing or rejected, the rule's own advisory or text was published.
    """

    limit = Limit(size_bytes=4_000_000, rate_hz=10)
    model: str = Field(description="its name at the endpoint")
    task: Literal["wording", "decision"]
    advisories: tuple[str, ...] = Field(default=(), description="ids of the advisories concerned")
    question: str = Field(description="JSON that the model was given")
    answer: str | None = Field(description="text that it answered; null if none came")
    failure: str = Field(default="", description="why nothing of it was used; empty if it was read")
    rejections: tuple[Rejection, ...] = ()


class EquipmentAlert(Message):
    """``equipment/<equipment>/<recipient>``: alert of equipment that is in the world.

    It is no advice of the assistant under test. Its recipient hears it at once, by a voice or a
    light of the equipment's own.
    """

    limit = Limit(size_bytes=32_000, rate_hz=50)
    equipment: str = Field(
        pattern=r"^[a-z0-9_-]{1,40}$", description="its name", examples=["tcas", "conflict_alert"]
    )
    advisory: Advisory


class AdvisoryAudio(Header):
    """``tts/<advisory id>``: attachment to the audio of an advisory, PCM 16 kHz mono.

    ``t_ns`` is the paper's t_tts: the beginning of the voice.
    """

    limit = Limit(size_bytes=16_000_000, rate_hz=10)
    id: str = Field(description="id of the advisory")
    revision: int = Field(ge=0)
    recipient: str
    text: str
    t_dec_ns: Nanoseconds = Field(description="time of the decision")
    engine: str
    sample_rate_hz: int = 16_000
    samples: int = Field(ge=0)
    sha256: str = Field(description="of the PCM")


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


# --- truth: for the recorder, metrics and viewers only --------------------------------------


class ActorTruth(Message):
    """``truth/state/<actor>``: true state of an actor; null where a value does not apply."""

    actor: str
    category: Literal["aircraft", "vehicle", "wildlife"]
    icao24: str | None = None
    phase: str = Field(description="phase of flight or of driving, or behaviour of an animal")
    on_ground: bool
    latitude_deg: float
    longitude_deg: float
    altitude_m: float
    height_agl_m: float
    velocity_north_m_s: float
    velocity_east_m_s: float
    velocity_down_m_s: float
    roll_deg: float = 0.0
    pitch_deg: float = 0.0
    heading_deg: float
    true_airspeed_m_s: float | None = None
    calibrated_airspeed_m_s: float | None = None
    target_altitude_m: float | None = None


class SpokenTruth(Message):
    """``truth/radio/<id>``: true speaker, addressee and text of a call."""

    id: str
    speaker: str
    addressed: str | None
    frequency_khz: int
    text: str
    t_tx_ns: Nanoseconds
    t_end_ns: Nanoseconds
    in_reply_to: str | None = Field(
        default=None, description="id of the transmission that it answers"
    )
    blocked_by: tuple[str, ...] = Field(
        default=(), description="ids of the transmissions that it was mixed with"
    )
    snr_db: float | None = None
    is_from_microphone: bool = Field(
        default=False, description="true: a person spoke it, so that its words are not known"
    )


class HearingTruth(Message):
    """``truth/hearing/<actor>``: understanding of a call by one of its addressees.

    Nobody knows what a person at a seat understands by ear: ``understood`` means then that the call
    has reached the seat.
    """

    id: str = Field(description="id of the transmission")
    actor: str
    outcome: Literal["understood", "misheard", "unsure", "missed"]
    text: str = Field(description="words that reached the actor; empty if none did")
    source: Literal["ear", "transcript"]


ConflictPhase = Literal[
    "begun",
    "opened",
    "closed",
    "loss_of_separation",
    "nmac",
    "tcas_ta",
    "tcas_ra",
    "runway_incursion",
    "collision",
]


class SightingTruth(Part):
    """Truth about one actor in a picture."""

    actor: str
    label: VisibleClass
    box: Box = Field(description="around the part of the actor within the picture, hidden or not")
    pixels: float = Field(ge=0.0, description="visible area, in pixels")
    visible_fraction: Confidence = Field(description="visible part of its area within the picture")
    truncation: Confidence = Field(description="part of its whole box that is outside the picture")
    range_m: float = Field(ge=0.0)
    transmission: Confidence = Field(description="part of its contrast that the air leaves")


class CameraTruth(Message):
    """``truth/camera/<camera>``: actors that are really in a picture."""

    camera: str
    seq: int = Field(ge=0)
    t_frame_ns: Nanoseconds
    sightings: tuple[SightingTruth, ...]


class ConflictTruth(Message):
    """``truth/conflict``: beginning of a phase of a conflict between two actors.

    In the air the distances are between the actors' centres, on a runway between their outlines.
    """

    phase: ConflictPhase
    actors: tuple[str, ...]
    horizontal_m: float | None = None
    vertical_m: float | None = None
    runway: str | None = None


class Arrival(Part):
    """Aircraft on final approach."""

    actor: str
    runway: str = Field(description="direction of landing")
    time_to_threshold_s: float


class RunwayTruth(Message):
    """``truth/runway/<runway>``: occupants and arrivals of a runway, published on each change."""

    runway: str = Field(examples=["01-19"])
    occupants: tuple[str, ...]
    arrivals: tuple[Arrival, ...]


EventKind = Literal[
    "actor_ended",
    "command",
    "unable",
    "failure",
    "pilot_reacts",
    "worker_lost",
    "radio_lost",
    "cameras_lost",
    "unregistered",
    "refused",
    "pace",
    "seat",
    "finished",
    "stopped",
]


DropCause = Literal["size", "rate", "queue", "transport"]
"""Reason why a message of another program did not count: it was too large, there were too many in a
second or too many that waited, or it was lost before it came."""


class DroppedMessages(Message):
    """``truth/dropped``: how many messages of programs did not count, at the end of the run.

    There is one for each kind of key and cause, if there were any.
    """

    keys: str = Field(examples=["advisory/*"])
    cause: DropCause = Field(
        description="size: larger than the limit; rate: more in a second than the limit; queue: "
        "more than could wait; transport: numbers are missing among those that the sender gave"
    )
    messages: int = Field(ge=1)


STALLED = "stalled"
"""Text of the event ``pace`` when a run with seats was late and has taken the clock anew."""
AFTER_STALL_S = 5.0
"""Time of the run after a stall that is not real time yet, in s, because what people did in the
stall comes then: an assumption."""


class Event(Message):
    """``truth/event``: event in the world or in the run."""

    kind: EventKind
    subject: str
    text: str


# --- workers: registration and time grants --------------------------------------------------


class InputSpec(Part):
    """Key that a worker subscribes to, relative to the run, and the policy of its queue.

    ``fifo``: a step takes the oldest input. ``latest``: the queue keeps only the newest input and
    counts those that it drops. ``batch``: a step takes all inputs that wait.
    """

    key: str = Field(examples=["adsb/*"])
    policy: Literal["fifo", "latest", "batch"] = "fifo"


class DeclaredLatency(Part):
    """Latency that a worker declares, for `--latency fixed` and `lognormal`."""

    median_s: float = Field(ge=0.0)
    sigma: float = Field(default=0.25, ge=0.0, description="of the logarithm, for lognormal")


WORKER_NAME = r"^[a-z0-9_-]+$"
RUN = "run"
"""Publisher of the messages of the run itself."""
UNREGISTERED = "unregistered"
"""Publisher of the messages of programs that take no grants."""


class WorkerDescription(Part):
    """Answer to a query on ``worker/<name>/describe``."""

    name: str = Field(pattern=WORKER_NAME)
    modality: Modality
    inputs: tuple[InputSpec, ...] = Field(min_length=1)
    latency: DeclaredLatency = DeclaredLatency(median_s=0.1)
    engine: str = Field(
        "",
        description="name of the decision engine in AIRHILT's decision worker, such as reference; "
        "empty for other workers",
    )
    configuration: dict[str, Any] = Field(
        default_factory=dict,
        description="rules and thresholds of that engine, whole; empty if it has none",
    )


class GrantInput(Part):
    """Input of a grant. Its bytes are in the payload, in the order of the inputs."""

    key: str
    t_in_ns: Nanoseconds
    size: int = Field(ge=0, description="bytes of the payload that are this input's")
    attachment: Any = Field(default=None, description="JSON header of raw inputs, else null")


class Grant(Part):
    """Attachment of a query on ``worker/<name>/step``: the worker computes at time ``t_ns``."""

    t_ns: Nanoseconds
    seq: int = Field(ge=0)
    inputs: tuple[GrantInput, ...]


class StepOutput(Part):
    """Output of a step. Its bytes are in the payload of the reply, in the order of the outputs."""

    key: str
    size: int = Field(ge=0)
    t_out_ns: Nanoseconds | None = Field(
        default=None,
        description="time at which it leaves the worker, not before the grant's t_ns; null: when "
        "the latency has passed",
    )
    attachment: Any = None


class StepReply(Part):
    """Attachment of the reply to a grant."""

    seq: int = Field(ge=0)
    compute_s: float = Field(ge=0.0, description="wall time that the step took")
    outputs: tuple[StepOutput, ...] = ()
    wake_ns: Nanoseconds | None = Field(
        default=None, description="call again at this time even without inputs"
    )


SEAT_AUDIO = "seat/*/audio"
"""Keys of the sound that the receiver of one seat gets: nobody else hears it."""
SEAT_KEYS = (
    "task", "offer", "speech", "microphone", "listening", "consent", "perceived", "heard",
    "question", "workload", "notice",
)  # fmt: skip
"""First parts of the keys between a run and the people at its seats: they have the words of the
script before they are said, and exactly what people say and do."""

BUS_MESSAGES: dict[str, type[Message]] = {
    "clock": Clock,
    "briefing": Briefing,
    "status/{modality}": Status,
    "radio/{frequency_khz}/tx": Transmission,
    "radio/{frequency_khz}/audio (opened)": TransmissionOpened,
    "radio/{frequency_khz}/audio (chunk)": TransmissionChunk,
    "radio/{frequency_khz}/audio (closed)": TransmissionClosed,
    "enhanced/{frequency_khz}": EnhancedTransmission,
    "camera/{camera}/info": CameraInfo,
    "camera/{camera}/frame": CameraFrame,
    "adsb/{icao24}": AdsbReport,
    "radar/{site}/info": RadarInfo,
    "radar/{site}": RadarPlot,
    "surface/{airport}": SurfaceTrack,
    "cockpit/{callsign}": CockpitInstruments,
    "cockpit/{callsign}/position": VehiclePosition,
    "tcas/{callsign}": TcasReply,
    "asr/{frequency_khz}": Transcript,
    "asr/{frequency_khz}/partial": PartialTranscript,
    "vision/{camera}": Detections,
    "advisory/{recipient}": Advisory,
    "tts/{id}": AdvisoryAudio,
    "llm/{worker}": ModelExchange,
    "equipment/{equipment}/{recipient}": EquipmentAlert,
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
    "truth/state/{actor}": ActorTruth,
    "truth/radio/{id}": SpokenTruth,
    "truth/hearing/{actor}": HearingTruth,
    "truth/camera/{camera}": CameraTruth,
    "truth/conflict": ConflictTruth,
    "truth/runway/{runway}": RunwayTruth,
    "truth/event": Event,
    "truth/dropped": DroppedMessages,
}
"""The message of each key below ``airhilt/<run>/``."""


@lru_cache(maxsize=4096)
def bus_message(key: str) -> type[Message] | None:
    """Return the class of the messages with a key below ``airhilt/<run>/``, None if it has none.

    Pieces of a transmission have none: their key has three.
    """
    parts = key.split("/")
    for template, model in BUS_MESSAGES.items():
        wanted = template.split("/")
        if len(wanted) == len(parts) and all(
            one.startswith("{") or one == part for one, part in zip(wanted, parts, strict=True)
        ):
            return model
    return None


WORKER_MESSAGES: dict[str, type[BaseModel]] = {
    "worker/{name}/describe (reply)": WorkerDescription,
    "worker/{name}/step (attachment)": Grant,
    "worker/{name}/step (attachment of the reply)": StepReply,
}
"""The messages of the worker protocol."""

WORKER_OUTPUTS: dict[str, type[Message]] = {
    "enhanced": EnhancedTransmission,
    "asr": Transcript,
    "vision": Detections,
    "advisory": Advisory,
    "tts": AdvisoryAudio,
    "llm": ModelExchange,
    "equipment": EquipmentAlert,
}
"""Messages that a worker may publish, by the first part of the key; never sensors or truth. Only
equipment of the world publishes on ``equipment``."""


def worker_output(key: str) -> type[Message] | None:
    """Return the class of the messages that a worker may publish on a key, None if there is none.

    The first part of a key tells it, except for partial transcripts.
    """
    first, _, rest = key.partition("/")
    if first == "asr" and rest.endswith("/partial"):
        return PartialTranscript
    return WORKER_OUTPUTS.get(first)


def json_schemas(more: Mapping[str, type[BaseModel]] | None = None) -> dict[str, Any]:
    """Return all schemas in one JSON object, by key, as ``airhilt schema`` prints them.

    Parameters
    ----------
    more
        Messages of other packages, by key.
    """
    return {
        key: {"title": model.__name__, **TypeAdapter(model).json_schema(), **_limit(model)}
        for key, model in {**BUS_MESSAGES, **WORKER_MESSAGES, **(more or {})}.items()
    }


def _limit(model: type[BaseModel]) -> dict[str, Any]:
    """Return the limit of a class of messages, as its schema has it."""
    limit = model.limit if issubclass(model, Message) else None
    return {} if limit is None else {"x-airhilt-limit": limit._asdict()}
