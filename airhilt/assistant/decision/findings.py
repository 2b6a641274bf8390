"""Findings of a decision engine, and a short statement of each.

A finding is structure: callsigns, runways, actions. A wording makes messages of it; the statement
is what the evidence of an advisory notes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from airhilt.phraseology import Instruction

RunwayUse = Literal["arrival", "departure", "rollout"]
"""Use of a runway by an aircraft."""

Obstructs = Literal[
    "on",
    "entering",
    "on, by camera",
    "animal on",
    "unidentified on",
    "cleared on to",
    "reported on",
    "airborne on final for",
    "airborne over",
    "opposite",
    "on crossing",
]
"""Ways in which somebody or something obstructs the user of a runway."""

_OBSTRUCTS: dict[Obstructs, str] = {
    "on": "{what} is on runway {where}",
    "entering": "{what} is about to enter runway {where}",
    "on, by camera": "{what} is on runway {where}, seen by camera",
    "animal on": "{what} on runway {where}",
    "unidentified on": "unidentified {what} on runway {where}",
    "cleared on to": "{what} was cleared on to runway {where}",
    "reported on": "{what} reported on runway {where}",
    "airborne on final for": "{what} on final for runway {where}",
    "airborne over": "{what} over runway {where}",
    "opposite": "{what} opposite on runway {where}",
    "on crossing": "{what} on crossing runway {where}",
}
_USES: dict[RunwayUse, str] = {
    "arrival": "on final for",
    "departure": "takes off from",
    "rollout": "rolls out on",
}


@dataclass(frozen=True, slots=True)
class LossOfSeparation:
    """Two aircraft in flight will lose separation."""

    callsigns: tuple[str, str]
    time_to_loss_s: float | None
    """Time until then, if nobody reacts; None if it is not foreseen any more."""

    def statement(self) -> str:
        """Return the finding in a few words."""
        first, second = self.callsigns
        return f"{first} and {second} lose separation in {self.time_to_loss_s or 0.0:.0f} s"


@dataclass(frozen=True, slots=True)
class LevelMisread:
    """An aircraft has read back another level than it was given, and traffic is there."""

    callsign: str
    read_ft: float
    cleared_ft: float
    traffic: str
    """Callsign of an aircraft that it would lose separation from."""
    radio_ids: tuple[str, str]
    """Ids of the transmissions: the instruction, and its readback."""

    def statement(self) -> str:
        """Return the finding in a few words, without the callsign."""
        return (
            f"read back {self.read_ft:.0f} ft, cleared {self.cleared_ft:.0f} ft, "
            f"traffic {self.traffic}"
        )


@dataclass(frozen=True, slots=True)
class RunwayMisread:
    """A readback about a runway is wrong, or somebody else's, and the runway is in use."""

    callsign: str
    """Speaker of the readback."""
    addressed: str
    """Callsign that was meant."""
    given: Instruction | None
    """The instruction; None if there was none of the kind."""
    read: Instruction
    traffic: str
    """Callsign of somebody else who uses the runway."""

    def statement(self) -> str:
        """Return the finding in a few words."""
        read, traffic = _instruction(self.read), f"traffic {self.traffic}"
        if self.addressed != self.callsign:
            return f"{read} for {self.addressed} was read back by {self.callsign}, {traffic}"
        given = _instruction(self.given) if self.given else "nothing of the kind"
        return f"{self.callsign} read back {read}, was told {given}, {traffic}"


@dataclass(frozen=True, slots=True)
class NotReadBack:
    """Somebody has not read back an instruction to keep off a runway that is in use."""

    callsign: str
    given: Instruction
    traffic: str
    """Callsign of somebody else who uses the runway."""

    def statement(self) -> str:
        """Return the finding in a few words."""
        return (
            f"{self.callsign} has not read back {_instruction(self.given)}, traffic {self.traffic}"
        )


@dataclass(frozen=True, slots=True)
class RecipientUnclear:
    """A call about a runway in use names a callsign that may be one of several."""

    callsigns: tuple[str, ...]
    said: Instruction
    traffic: str
    """Callsign of somebody who uses the runway."""

    def statement(self) -> str:
        """Return the finding in a few words."""
        who = " or ".join(self.callsigns)
        return f"{_instruction(self.said)} may be for {who}, traffic {self.traffic}"


@dataclass(frozen=True, slots=True)
class Occupied:
    """Somebody or something is on a runway that nobody is known to use."""

    what: str
    runway: str

    def statement(self) -> str:
        """Return the finding in a few words."""
        return f"{self.what} is on runway {self.runway}"


@dataclass(frozen=True, slots=True)
class Unclear:
    """A slot of an instruction or a readback was heard with too little confidence."""

    callsign: str
    slot: str
    """``callsign``, ``action``, ``runway`` or ``altitude``."""
    said: Instruction
    confidence: float
    """Confidence in that slot."""
    traffic: str
    """Callsign of somebody because of whom it matters."""

    def statement(self) -> str:
        """Return the finding in a few words."""
        heard = _instruction(self.said)
        return f"{self.slot} of {self.callsign} heard as {heard!r}, {self.confidence:.0%} certain"


@dataclass(frozen=True, slots=True)
class Obstruction:
    """Somebody or something is, or will be, in the way of the user of a runway."""

    user: str
    """Callsign of the aircraft that uses the runway."""
    use: RunwayUse
    runway: str
    """Direction in which it does."""
    how: Obstructs
    what: str
    """Callsign, or a word such as ``deer``, of what is in its way."""
    where: str
    """Runway on which that is."""

    def statement(self) -> str:
        """Return what is in the way, in a few words."""
        return _OBSTRUCTS[self.how].format(what=self.what, where=self.where)

    def statement_of_use(self) -> str:
        """Return what the user of the runway does, in a few words."""
        return f"{self.user} {_USES[self.use]} runway {self.runway}"


@dataclass(frozen=True, slots=True)
class OpposedClearances:
    """Two are cleared to use one runway in opposite directions."""

    callsigns: tuple[str, str]
    runways: tuple[str, str]

    def statement(self) -> str:
        """Return the finding in a few words."""
        return f"cleared for runway {self.runways[0]} and runway {self.runways[1]}"


Where = Literal[
    "ahead", "ahead to the left", "ahead to the right", "to the left", "to the right", "behind"
]
"""A direction as the crew of an aircraft sees it."""


@dataclass(frozen=True, slots=True)
class Intruder:
    """Something comes nearer to an aircraft in flight whose camera sees it."""

    carrier: str
    """Callsign of the aircraft with the camera."""
    is_birds: bool
    """True if it is birds, and not an aircraft."""
    callsign: str | None
    """Callsign that it has on ADS-B; None if it has no transponder."""
    where: Where
    contact_s: float | None
    """Time until the two meet; None if that cannot be told yet."""

    def statement(self) -> str:
        """Return the finding in a few words, without the carrier."""
        what = "birds" if self.is_birds else "traffic"
        who = f"{what} {self.callsign}" if self.callsign else what
        unseen = "" if self.callsign or self.is_birds else ", no transponder"
        return f"{who} {self.where}{unseen}, closing"


@dataclass(frozen=True, slots=True)
class Announcement:
    """A system aboard announces something of traffic in words of its own."""

    aural: str
    """Words, such as ``climb, climb``."""

    def statement(self) -> str:
        """Return the announcement."""
        return self.aural


Finding = (
    LossOfSeparation
    | LevelMisread
    | RunwayMisread
    | NotReadBack
    | RecipientUnclear
    | Occupied
    | Unclear
    | Obstruction
    | OpposedClearances
    | Intruder
    | Announcement
)


def _instruction(instruction: Instruction) -> str:
    about = f" runway {instruction.runway}" if instruction.runway else ""
    if instruction.altitude_ft is not None:
        about = f" {instruction.altitude_ft:.0f} ft"
    return f"{instruction.action.replace('_', ' ')}{about}"
