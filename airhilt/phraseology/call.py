"""What a call says, as the parts of it that mean something."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from airhilt.phraseology.callsigns import NOBODY, CallsignMatch

Action = Literal[
    "cleared_to_land", "cleared_for_takeoff", "line_up", "hold_short", "hold_position", "cross",
    "proceed", "cancel_takeoff", "cancel_landing", "go_around", "touch_and_go", "low_approach",
    "cleared_option", "cleared_approach", "continue_approach", "vacate", "backtrack", "taxi",
    "stop", "push_back", "start_up", "follow", "give_way", "altitude", "heading", "speed",
    "direct", "own_navigation", "squawk", "contact", "monitor", "stand_by", "report",
    "wildlife", "wildlife_gone",
]  # fmt: skip
"""What somebody is to do, or does, or, of wildlife, reports."""

CLEARANCES: frozenset[Action] = frozenset(
    {"cleared_to_land", "cleared_for_takeoff", "line_up", "cross", "proceed", "touch_and_go",
     "low_approach", "cleared_option", "cleared_approach", "backtrack", "taxi", "push_back",
     "start_up"}
)  # fmt: skip
"""Actions that need a clearance: none of them is ever guessed."""
REPORTS: frozenset[Action] = frozenset({"wildlife", "wildlife_gone"})
"""Actions that tell about something instead of doing it."""

Sense = Literal["climb", "descend", "maintain"]
Turn = Literal["left", "right"]
Kind = Literal[
    "instruction", "readback", "report", "request", "say_again", "correction", "disregard",
    "unknown",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Instruction:
    """One action of a call, and what is said about it.

    Two are equal if they mean the same, however sure each is.
    """

    action: Action
    runway: str | None = None
    """Its designator, such as 01L."""
    position: str | None = None
    """Where: a taxiway or intersection such as B5, a station, a fix or a place in words."""
    condition: str | None = None
    """What must come first, or how long it holds, in words: "behind the landing cessna"."""
    hold_short: str | None = None
    """The point to hold short of, if it is no runway."""
    via: tuple[str, ...] = ()
    """Taxiways."""
    sense: Sense | None = None
    altitude_ft: float | None = None
    turn: Turn | None = None
    heading_deg: float | None = None
    speed_kt: float | None = None
    frequency_khz: int | None = None
    squawk: str | None = None
    approach: str | None = None
    """Its kind, such as ils or visual."""
    immediate: bool = False
    """At once, or without delay."""
    confidence: float = field(default=1.0, compare=False)
    """That this was said, in [0, 1]; see docs/phraseology.md."""


@dataclass(frozen=True, slots=True)
class Wind:
    """A wind that was told; without a direction it is variable, without speed calm."""

    direction_deg: float | None
    speed_kt: float
    gust_kt: float | None = None


@dataclass(frozen=True, slots=True)
class Call:
    """What one call says."""

    match: CallsignMatch = NOBODY
    addressed_first: bool = False
    """It begins with the callsign, as an instruction does; a readback ends with it."""
    kind: Kind = "unknown"
    instructions: tuple[Instruction, ...] = ()
    distress: bool = False
    """It says mayday (ICAO Annex 10 volume II, 5.3.2)."""
    urgency: bool = False
    """It says pan pan (5.3.3)."""
    corrected: bool = False
    """It corrects itself or the call before it."""
    negative: bool = False
    """It begins with "negative", or says "unable"."""
    acknowledged: bool = False
    """It says roger, wilco or the like."""
    position: str | None = None
    """Where the speaker says to be, in words."""
    traffic: tuple[str, ...] = ()
    """Traffic information, in words."""
    wind: Wind | None = None
    pressure_hpa: float | None = None
    """Altimeter setting."""
    confidence: float = 0.0
    """That all of it is right, in [0, 1]; see docs/phraseology.md."""

    @property
    def callsign(self) -> str | None:
        """The callsign on the frequency that it names, if it names one and only that."""
        return None if self.match.ambiguous else self.match.callsign

    @property
    def altitude(self) -> Instruction | None:
        """The first instruction to climb, to descend or to keep a level."""
        return next((each for each in self.instructions if each.action == "altitude"), None)

    @property
    def sense(self) -> Sense | None:
        """That of the first instruction about a level."""
        return self.altitude.sense if self.altitude else None

    @property
    def altitude_ft(self) -> float | None:
        """That of the first instruction about a level."""
        return self.altitude.altitude_ft if self.altitude else None
