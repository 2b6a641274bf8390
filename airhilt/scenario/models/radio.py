"""Radio calls of a scenario, and how well people hear each other."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from airhilt.commands import Command
from airhilt.quantities import Flag, FrequencyKhz, Name, Number, Share, SnrDb, TimeS
from airhilt.scenario import radio_profiles as profiles
from airhilt.scenario.models.base import MOST_COMMANDS, Callsign, Identifier, Model
from airhilt.scenario.models.conditions import Condition


class ScriptedCommand(Model):
    """Command that a radio line gives to an actor, carried out ``delay_s`` after the line's end.

    With ``when``, it waits for that condition as well: "behind the landing traffic, line up".
    """

    actor: Callsign
    command: Command
    delay_s: Number = Field(default=2.0, ge=0.0, le=600.0)
    when: Condition | None = None


class ReceptionSettings(Model):
    """Reception of calls: their noise, and the part of the radio channel in their sound."""

    snr_db: SnrDb | None = Field(
        default=None,
        description="SNR of what is received; null: that of the next wider settings, in the order "
        "line, station, radio; null in the radio too: nobody mishears",
    )
    wet: Share | None = Field(
        default=None,
        description="part of the radio channel in the sound; the rest is the voice as it was "
        "spoken; null: that of the next wider settings, and at last that of the profile",
    )


class StationRadio(ReceptionSettings):
    """Transmitter of an actor or a unit: the reception of its calls."""


class ReceiverRadio(Model):
    """Receiver of an actor or a unit: the reception of all calls there."""

    snr_db: SnrDb = Field(
        description="SNR of the best calls at this receiver: a call has the lower one of this and "
        "its own"
    )


class RadioLine(ReceptionSettings):
    """One call on a frequency. If the frequency is busy, the call waits until it is free."""

    id: Identifier
    at_s: TimeS = Field(default=0.0, description="earliest time of the call")
    when: Condition | None = Field(
        default=None, description="the call also waits for this condition"
    )
    speaker: Name = Field(description="a callsign, or a unit's name")
    to: Name | None = Field(default=None, description="addressed callsign or unit")
    frequency_khz: FrequencyKhz = Field(description="name of a channel with 25 or 8.33 kHz spacing")
    text: str = Field(min_length=1, max_length=500)
    commands: tuple[ScriptedCommand, ...] = Field(default=(), max_length=MOST_COMMANDS)
    answers: Identifier | None = Field(
        default=None,
        description="the line that it answers; null: an actor reads back the line before on the "
        "frequency, if that was from whom this is for and for whom this is from",
    )


Topology = Literal["parallel", "asr_first", "gated_fusion"]


class Radio(ReceptionSettings):
    """Radio calls in the order of time, and how well people hear each other."""

    controller: Name = Field(default="Center", description="name of the unit that listens")
    lines: tuple[RadioLine, ...] = Field(default=(), max_length=5000)
    words_per_minute: Number = Field(
        default=160.0, ge=60.0, le=400.0, description="speaking rate of calls without sound"
    )
    stations: dict[Name, StationRadio] = Field(
        default={},
        max_length=500,
        description="units besides the controller, and reception of the calls of single speakers, "
        "by callsign or by the unit's name",
        examples=[{"AAL123": {"snr_db": 5.0, "wet": 0.7}}],
    )
    receivers: dict[Name, ReceiverRadio] = Field(
        default={},
        max_length=500,
        description="reception of all calls at single listeners, by callsign or by the unit's "
        "name; whoever has none hears as the receiver at the units' site",
        examples=[{"AAL123": {"snr_db": 3.0}}],
    )
    squelch_db: SnrDb = Field(default=-10.0, description="SNR below which receivers stay silent")
    profile: Annotated[str, Field(max_length=500), AfterValidator(profiles.checked)] | None = Field(
        default=None,
        description="named settings of the radio channel, or a learned channel, FILE.onnx",
    )
    topology: Topology = Field(
        default="parallel",
        description="parallel: crews hear the radio, as the assistant does; asr_first: crews get "
        "the transcript instead; gated_fusion: as parallel, and the assistant says nothing while "
        "it has not taken in all that was said",
    )
    overhearing: Flag = Field(
        default=True,
        description="crews that get transcripts may take one of a call to others for their own",
    )
    phraseology: Literal["faa", "icao"] = Field(
        default="faa", description="phraseology of generated calls"
    )
    readbacks: Literal["scripted", "generated"] = Field(
        default="scripted",
        description="generated: crews also read back instructions that no line answers",
    )
    controller_checks_readbacks: Flag = Field(
        default=False,
        description="controllers correct a wrong readback, and repeat what is not answered even "
        "where a failure is why",
    )
