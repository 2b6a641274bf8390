"""A listener's understanding of a call: whether it is addressed, and what it commands."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from airhilt.commands import (
    AltitudeCommand,
    CancelTakeoffCommand,
    Command,
    ContinueCommand,
    GoAroundCommand,
    HoldPositionCommand,
    LandCommand,
    LineUpCommand,
    SpeedCommand,
    TakeOffCommand,
    TrackCommand,
)
from airhilt.phraseology import TAU_ASR, Call, Instruction, agree, parse_call


@dataclass(frozen=True, slots=True)
class Understanding:
    """Understanding of a call by one listener."""

    kind: Literal["as_said", "otherwise", "unclear", "not_for_me"]
    call: Call | None = None
    """Call as it was heard; None where it did not have to be parsed."""
    commands: tuple[Command, ...] = ()
    """Commands of a call that was heard otherwise than it was said."""


@dataclass(frozen=True, slots=True)
class Listener:
    """Understands calls, with the callsigns that are on a frequency."""

    callsigns: tuple[str, ...]
    variation_deg: float = 0.0
    """Magnetic variation of the headings that are said, in degrees, positive east."""

    def parse(self, text: str, word_confidences: Sequence[float] | None = None) -> Call:
        """Return the meaning of a call."""
        return parse_call(text, self.callsigns, word_confidences)

    def commands_of(
        self, instructions: Iterable[Instruction], bound_runway: str | None
    ) -> tuple[Command, ...]:
        """Return the commands that instructions give, as far as there is a command for each.

        Headings are magnetic, and are flown as true tracks: without wind.

        Instructions with a condition give none: their words do not say when it is met. A level that
        comes with a takeoff or a go-around is the level that it climbs to. A level to cross a fix
        at, or not to pass, is no level to fly to.
        """
        now = [instruction for instruction in instructions if not instruction.is_conditional]
        levels = (one for one in now if one.action == "altitude" and one.bound is None)
        level_ft = next((one.altitude_ft for one in levels if one.altitude_ft is not None), None)
        climbs = any(one.action in ("cleared_for_takeoff", "go_around") for one in now)
        found = [
            _command_of(instruction, bound_runway, level_ft, self.variation_deg)
            for instruction in now
            if not climbs or instruction.action != "altitude"
        ]
        return tuple(dict.fromkeys(command for command in found if command is not None))

    def understand(
        self,
        heard: str,
        said: str,
        known_by: tuple[str, ...],
        bound_runway: str | None = None,
        word_confidences: Sequence[float] | None = None,
    ) -> Understanding:
        """Return the understanding of a call by its addressee.

        A listener by ear who heard the words that were said is certain of them. A reader of a
        transcript does not know what was said, and goes by the confidence of each word.

        The callsigns ``known_by``, its own or the caller's, show the listener that the call is
        addressed; without any it takes it as addressed. A call that names no runway is on the one
        that the listener is going to use.
        """
        is_the_same = words(heard) == words(said)
        if is_the_same and word_confidences is None:
            return Understanding("as_said")
        taken = self.parse(heard, word_confidences)
        doubt = self._is_not_for(taken, known_by)
        if doubt == "not_for_me" and not is_the_same:
            return Understanding(doubt, taken)
        meant = self.parse(said)
        is_in_doubt = doubt == "unclear" or taken.confidence < TAU_ASR
        if is_in_doubt and (_wants_something(taken) or _wants_something(meant)):
            return Understanding("unclear", taken)
        if is_the_same or mean_the_same(taken.instructions, meant.instructions):
            return Understanding("as_said", taken)
        if not taken.instructions:
            return Understanding("unclear", taken)
        return Understanding("otherwise", taken, self.commands_of(taken.instructions, bound_runway))

    def overhear(
        self,
        heard: str,
        said: str,
        callsign: str,
        bound_runway: str | None = None,
        word_confidences: Sequence[float] | None = None,
    ) -> Understanding:
        """Return the understanding of a call by somebody else than its addressee."""
        if words(heard) == words(said):
            return Understanding("not_for_me")
        taken = self.parse(heard, word_confidences)
        commands = self.commands_of(taken.instructions, bound_runway)
        is_mine = self._is_not_for(taken, (callsign,)) is None and taken.kind in (
            "instruction",
            "correction",
        )
        if not is_mine or not commands or taken.confidence < TAU_ASR:
            return Understanding("not_for_me", taken)
        return Understanding("otherwise", taken, commands)

    def differs(self, read_back: str, said: str) -> bool:
        """Return whether a readback contradicts the call; a shorter readback does not."""
        meant = self.parse(said).instructions
        return not all(
            any(agree(instruction, other) for other in meant)
            for instruction in self.parse(read_back).instructions
        )

    @staticmethod
    def _is_not_for(
        taken: Call, known_by: tuple[str, ...]
    ) -> Literal["unclear", "not_for_me"] | None:
        """Return why a call may not be for a listener with these callsigns; None if it is."""
        match = taken.match
        if match.ambiguous and any(one.callsign in known_by for one in match.candidates):
            return "unclear"
        return None if not known_by or taken.callsign in known_by else "not_for_me"


def _wants_something(call: Call) -> bool:
    """Return whether a call instructs or asks, so that its words matter."""
    return bool(call.instructions) or call.kind in ("request", "say_again", "disregard")


def mean_the_same(heard: Sequence[Instruction], said: Sequence[Instruction]) -> bool:
    """Return whether instructions mean the same, however their conditions are worded."""
    return len(heard) == len(said) and all(
        agree(one, other) and _numbers(one) == _numbers(other)
        for one, other in zip(heard, said, strict=True)
    )


def _numbers(instruction: Instruction) -> tuple[float | None, ...]:
    return (
        instruction.altitude_ft,
        instruction.heading_deg,
        instruction.speed_kt,
        instruction.mach,
        instruction.rate_fpm,
        instruction.turn_deg,
        instruction.frequency_khz,
    )


def words(text: str) -> list[str]:
    """Return the words of a call without case and punctuation."""
    return re.findall(r"[a-z0-9]+", text.lower())


def _command_of(
    instruction: Instruction,
    bound_runway: str | None,
    level_ft: float | None,
    variation_deg: float,
) -> Command | None:
    runway = instruction.runway or bound_runway
    climb = {} if level_ft is None else {"climb_to_ft": level_ft}
    match instruction.action:
        case "go_around":
            return GoAroundCommand(action="go_around", **climb)
        case "cancel_takeoff":
            return CancelTakeoffCommand(action="cancel_takeoff")
        case "hold_short" | "hold_position" | "stop":
            return HoldPositionCommand(action="hold_position")
        case "cross" | "proceed":
            return ContinueCommand(action="continue")
        case "line_up" if runway is not None:
            return LineUpCommand(action="line_up", runway=runway)
        case "cleared_for_takeoff" if runway is not None:
            return TakeOffCommand(action="take_off", runway=runway, **climb)
        case "cleared_to_land" if runway is not None:
            return LandCommand(action="land", runway=runway)
        case "altitude" if level_ft is not None:
            return AltitudeCommand(action="altitude", altitude_ft=level_ft)
        case "heading" if instruction.heading_deg is not None:
            track_deg = (instruction.heading_deg + variation_deg) % 360.0
            return TrackCommand(action="track", track_deg=track_deg)
        case "speed" if instruction.speed_kt is not None:
            return SpeedCommand(action="speed", cas_kt=instruction.speed_kt)
    return None
