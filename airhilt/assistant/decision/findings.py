"""Findings of a decision engine, and a short statement of each.

A finding is structure: callsigns, runways, actions. A wording makes messages of it; the statement
is what the evidence of an advisory notes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from airhilt.phraseology import Action, Instruction

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
_ACTIONS: dict[Action, str] = {
    "cleared_to_land": "cleared to land",
    "cleared_for_takeoff": "cleared for takeoff",
    "line_up": "line up",
    "cross": "cross",
    "proceed": "proceed",
    "hold_short": "hold short",
    "hold_position": "hold position",
    "cancel_takeoff": "cancel takeoff",
    "go_around": "go around",
}


@dataclass(frozen=True, slots=True)
class LossOfSeparation:
    """Two aircraft in flight will lose separation.

    Attributes
    ----------
    time_to_loss_s
        Time until then, if nobody reacts; None if it is not foreseen any more.
    """

    callsigns: tuple[str, str]
    time_to_loss_s: float | None

    def statement(self) -> str:
        """Return the finding in a few words."""
        first, second = self.callsigns
        return f"{first} and {second} lose separation in {self.time_to_loss_s or 0.0:.0f} s"


@dataclass(frozen=True, slots=True)
class LevelMisread:
    """An aircraft has read back another level than it was given, and traffic is there.

    Attributes
    ----------
    traffic
        Callsign of an aircraft that it would lose separation from.
    radio_ids
        Ids of the transmissions: the instruction, and its readback.
    """

    callsign: str
    read_ft: float
    cleared_ft: float
    traffic: str
    radio_ids: tuple[str, str]

    def statement(self) -> str:
        """Return the finding in a few words, without the callsign."""
        return (
            f"read back {self.read_ft:.0f} ft, cleared {self.cleared_ft:.0f} ft, "
            f"traffic {self.traffic}"
        )


@dataclass(frozen=True, slots=True)
class RunwayMisread:
    """A readback about a runway is wrong, or somebody else's, and the runway is in use.

    Attributes
    ----------
    callsign
        Speaker of the readback.
    addressed
        Callsign that was meant.
    given
        The instruction; None if there was none of the kind.
    traffic
        Callsign of somebody else who uses the runway.
    """

    callsign: str
    addressed: str
    given: Instruction | None
    read: Instruction
    traffic: str

    def statement(self) -> str:
        """Return the finding in a few words."""
        read, traffic = _instruction(self.read), f"traffic {self.traffic}"
        if self.addressed != self.callsign:
            return f"{read} for {self.addressed} was read back by {self.callsign}, {traffic}"
        given = _instruction(self.given) if self.given else "nothing of the kind"
        return f"{self.callsign} read back {read}, was told {given}, {traffic}"


@dataclass(frozen=True, slots=True)
class NotReadBack:
    """Somebody has not read back an instruction to keep off a runway that is in use.

    Attributes
    ----------
    traffic
        Callsign of somebody else who uses the runway.
    """

    callsign: str
    given: Instruction
    traffic: str

    def statement(self) -> str:
        """Return the finding in a few words."""
        return (
            f"{self.callsign} has not read back {_instruction(self.given)}, traffic {self.traffic}"
        )


@dataclass(frozen=True, slots=True)
class RecipientUnclear:
    """A call about a runway in use names a callsign that may be one of several.

    Attributes
    ----------
    callsigns
        Callsigns that it may be.
    traffic
        Callsign of somebody who uses the runway.
    """

    callsigns: tuple[str, ...]
    said: Instruction
    traffic: str

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
    """A slot of an instruction or a readback was heard with too little confidence.

    Attributes
    ----------
    slot
        ``callsign``, ``action``, ``runway`` or ``altitude``.
    confidence
        Confidence in that slot.
    traffic
        Callsign of somebody because of whom it matters.
    """

    callsign: str
    slot: str
    said: Instruction
    confidence: float
    traffic: str

    def statement(self) -> str:
        """Return the finding in a few words."""
        heard = _instruction(self.said)
        return f"{self.slot} of {self.callsign} heard as {heard!r}, {self.confidence:.0%} certain"


@dataclass(frozen=True, slots=True)
class Obstruction:
    """Somebody or something is, or will be, in the way of the user of a runway.

    Attributes
    ----------
    user
        Callsign of the aircraft that uses the runway.
    runway
        Direction in which it does.
    what
        Callsign, or a word such as ``deer``, of what is in its way.
    where
        Runway on which that is.
    """

    user: str
    use: RunwayUse
    runway: str
    how: Obstructs
    what: str
    where: str

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
    """Something comes nearer to an aircraft in flight whose camera sees it.

    Attributes
    ----------
    carrier
        Callsign of the aircraft with the camera.
    is_birds
        True if it is birds, and not an aircraft.
    callsign
        Callsign that it has on ADS-B; None if it has no transponder.
    contact_s
        Time until the two meet; None if that cannot be told yet.
    """

    carrier: str
    is_birds: bool
    callsign: str | None
    where: Where
    contact_s: float | None

    def statement(self) -> str:
        """Return the finding in a few words, without the carrier."""
        what = "birds" if self.is_birds else "traffic"
        who = f"{what} {self.callsign}" if self.callsign else what
        unseen = "" if self.callsign or self.is_birds else ", no transponder"
        return f"{who} {self.where}{unseen}, closing"


@dataclass(frozen=True, slots=True)
class Announcement:
    """A system aboard announces something of traffic in words of its own.

    Attributes
    ----------
    aural
        Words, such as ``climb, climb``.
    """

    aural: str

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
    return f"{_ACTIONS.get(instruction.action, instruction.action.replace('_', ' '))}{about}"
