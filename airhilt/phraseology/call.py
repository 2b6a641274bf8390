"""The meaning of a call."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from airhilt.phraseology.callsigns import NOBODY, CallsignMatch
from airhilt.phraseology.speakers import Spoken, speaker_of

Action = Literal[
    "cleared_to_land", "cleared_for_takeoff", "line_up", "hold_short", "hold_position", "cross",
    "proceed", "cancel_takeoff", "cancel_landing", "go_around", "touch_and_go", "low_approach",
    "cleared_option", "cleared_approach", "continue_approach", "vacate", "backtrack", "taxi",
    "stop", "push_back", "start_up", "follow", "give_way", "altitude", "heading", "speed",
    "direct", "own_navigation", "squawk", "contact", "monitor", "stand_by", "report",
    "wildlife", "wildlife_gone", "stop_and_go", "circle", "cancel_approach", "missed_approach",
    "cross_fix", "climb_via", "descend_via", "vertical_rate", "turn_by", "hold_at", "mach",
    "resume_speed", "no_speed_restrictions", "ident", "visual_separation", "orbit", "extend",
    "short_approach", "join", "side_step", "return_to_field", "expedite", "say",
]  # fmt: skip
"""Action that a call orders, reads back, or reports.

The slots of those in the circuit and of questions:

- orbit: one full turn, with ``turn`` if the side is said.
- extend: fly a leg of the circuit longer; ``position`` is the leg ("downwind").
- short_approach: turn in early; no slots.
- join: fly a leg of the circuit; ``position`` is the leg ("downwind", "base", "final", "crosswind",
  "upwind", "straight in"), with ``turn`` and ``runway`` if they are said.
- side_step: land on the parallel ``runway`` instead.
- return_to_field: come back to land, on ``runway`` if it is said.
- expedite: do without delay what was told before; no slots.
- vertical_rate: ``rate_fpm``, with ``sense`` if no level is named beside it ("climb at 1,200").
- say: tell by radio what ``position`` names ("altitude", "heading", "fuel remaining", "traffic in
  sight"), one instruction for each thing.
"""

CLEARANCES: frozenset[Action] = frozenset(
    {"cleared_to_land", "cleared_for_takeoff", "line_up", "cross", "proceed", "touch_and_go",
     "stop_and_go", "low_approach", "cleared_option", "cleared_approach", "backtrack", "taxi",
     "push_back", "start_up"}
)  # fmt: skip
"""Actions that need a clearance, and are therefore never guessed."""
REPORTS: frozenset[Action] = frozenset({"wildlife", "wildlife_gone"})
"""Actions that are reports."""
STOPS: frozenset[Action] = frozenset(
    {"stop", "hold_position", "hold_short", "go_around", "cancel_takeoff"}
)
"""Actions that end what was cleared, or keep off a runway, and so wait for no event."""
BESIDES: frozenset[Action] = frozenset(
    {"ident", "visual_separation", "mach", "vertical_rate", "resume_speed",
     "no_speed_restrictions", "cross_fix"}
)  # fmt: skip
"""Actions that leave clearances for runways as they are."""

TAU_ASR = 0.8
"""Confidence below which what was heard is in doubt (guard of arXiv 2511.18718)."""

OTHERWISE = "or"
"""Condition of what is done only if the clearance right before it cannot be (ICAO Doc 4444,
12.3.4.11: "take off immediately or vacate runway")."""

Sense = Literal["climb", "descend", "maintain"]
Turn = Literal["left", "right"]
Bound = Literal["or_more", "or_less"]
Kind = Literal[
    "instruction", "readback", "report", "request", "say_again", "correction", "disregard",
    "hail", "radio_check", "question", "unknown",
]  # fmt: skip
"""Kind of a call; a hail has only the names of who is called and who calls."""
Asks = Literal["able", "doing"]
"""Subject of a question: whether somebody can do something, or does it."""


@dataclass(frozen=True, slots=True)
class Instruction:
    """One action of a call, with its details.

    Two instructions are equal if they mean the same, whatever their confidences.
    """

    action: Action
    runway: str | None = None
    """Its designator, such as 01L."""
    position: str | None = None
    """Place: a taxiway or intersection such as B5, a station, a fix or a place in words."""
    condition: str | None = None
    """Event before which it is not in effect, in words, such as "behind the landing cessna"; None
    if it is in effect now."""
    until: str | None = None
    """Limit of what is in effect now, in words, such as "until 4 mile final"."""
    hold_short: str | None = None
    """Point to hold short of, if it is not a runway."""
    via: tuple[str, ...] = ()
    """Taxiways."""
    sense: Sense | None = None
    altitude_ft: float | None = None
    bound: Bound | None = None
    """Side of a level, speed or rate that is free: "at or above" is or_more."""
    rate_fpm: float | None = None
    """Vertical rate, in ft/min."""
    turn: Turn | None = None
    heading_deg: float | None = None
    turn_deg: float | None = None
    """Number of degrees to turn by."""
    speed_kt: float | None = None
    mach: float | None = None
    named: str | None = None
    """Name of a speed without a number, such as "minimum clean", "normal" or "published"."""
    frequency_khz: int | None = None
    squawk: str | None = None
    approach: str | None = None
    """Kind of approach, such as ils or visual."""
    variant: str | None = None
    """Letter of one of several approaches of a kind to a runway: Z of ILS Z."""
    immediate: bool = False
    """True if it is to be done at once or without delay."""
    confidence: float = field(default=1.0, compare=False)
    """Confidence in [0, 1] that this was said; see docs/parser-accuracy.md."""
    action_heard: float = field(default=1.0, compare=False)
    """Least confidence of the recogniser in the words of the action, in [0, 1]."""
    details_heard: float = field(default=1.0, compare=False)
    """Likewise in the words of its details, such as the runway or the level."""

    @property
    def details_confidence(self) -> float:
        """Confidence in [0, 1] in the details, as they were heard and as they make sense."""
        heard = min(self.action_heard, self.details_heard)
        makes_sense = self.confidence / heard if heard > 0.0 else 0.0
        return min(self.details_heard, makes_sense)

    @property
    def is_conditional(self) -> bool:
        """True if it is not in effect before an event."""
        return self.condition is not None


@dataclass(frozen=True, slots=True)
class Question:
    """A question about an action, which orders nothing."""

    asks: Asks
    about: Instruction


@dataclass(frozen=True, slots=True)
class Wind:
    """A wind: variable if it has no direction, calm if it has no speed."""

    direction_deg: float | None
    speed_kt: float
    gust_kt: float | None = None


@dataclass(frozen=True, slots=True)
class Call:
    """The meaning of one call."""

    match: CallsignMatch = NOBODY
    addressed_first: bool = False
    """True if it begins with the callsign, as an instruction does; a readback ends with it."""
    kind: Kind = "unknown"
    instructions: tuple[Instruction, ...] = ()
    """Instructions in effect now or under a condition."""
    expected: tuple[Instruction, ...] = ()
    """Contents that the call says are to be expected. Nothing of it is an instruction."""
    asked: tuple[Question, ...] = ()
    """Questions of a call. Nothing of them is an instruction."""
    unread: bool = False
    """True if it begins with the callsign and has an order that could not be made out."""
    distress: bool = False
    """True if it says mayday (ICAO Annex 10 volume II, 5.3.2)."""
    urgency: bool = False
    """True if it says pan pan (5.3.3)."""
    emergency_descent: bool = False
    """True if it announces an emergency descent (ICAO Doc 4444, 15.1.4)."""
    corrected: bool = False
    """True if it corrects itself or the call before it."""
    disregards: bool = False
    """True if it withdraws what calls before it told, and not only words of its own."""
    negative: bool = False
    """True if it begins with "negative" or says "unable"."""
    acknowledged: bool = False
    """True if it says roger, wilco or the like."""
    asks_again: bool = False
    """True if it asks for words again: "say again", "confirm", "verify", "read back"."""
    position: str | None = None
    """Position that the speaker reports, in words."""
    traffic: tuple[str, ...] = ()
    """Traffic information, in words."""
    wind: Wind | None = None
    pressure_hpa: float | None = None
    """Altimeter setting."""
    confidence: float = 0.0
    """Confidence in [0, 1] that all of it is right; see docs/parser-accuracy.md."""
    text: str = field(default="", compare=False)
    """Its words, with ``|`` for its callsign."""

    @property
    def spoken(self) -> Spoken:
        """Speaker by the words, a pilot or a controller, and the confidence in that."""
        return speaker_of(self.text)

    @property
    def callsign(self) -> str | None:
        """Callsign on the frequency that it names; None if there is none, or more than one."""
        return None if self.match.ambiguous else self.match.callsign

    @property
    def altitude(self) -> Instruction | None:
        """First instruction to climb, to descend or to maintain a level that is in effect now."""
        now = (each for each in self.instructions if not each.is_conditional)
        return next((each for each in now if each.action == "altitude"), None)

    @property
    def sense(self) -> Sense | None:
        """Sense of the first instruction about a level."""
        return self.altitude.sense if self.altitude else None

    @property
    def altitude_ft(self) -> float | None:
        """Altitude of the first instruction about a level."""
        return self.altitude.altitude_ft if self.altitude else None
