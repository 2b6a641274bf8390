"""Clearances and readbacks about runways, and where the two do not agree."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from airhilt.assistant.decision.readback_silence import ReadbackSilence
from airhilt.messages import Transcript, TransmissionOpened
from airhilt.phraseology import Action, Call, Instruction
from airhilt.units import SECOND_NS

LIFETIME_S: dict[Action, float] = {
    "cleared_to_land": 600.0,
    "cleared_for_takeoff": 180.0,
    "line_up": 300.0,
    "cross": 60.0,
    "proceed": 180.0,
}
"""Time for which a clearance on to a runway is in force if nothing ends it, in s."""
READBACK_WINDOW_NS = 30 * SECOND_NS
"""A readback later than this after its instruction, in ns, belongs to something else."""
DISCREPANCY_NS = 120 * SECOND_NS
"""Time for which an uncorrected wrong readback matters, in ns."""
RESTRICTING: frozenset[Action] = frozenset(
    {"cancel_takeoff", "go_around", "hold_short", "hold_position"}
)
"""Instructions that keep somebody off a runway: who has not received one goes on."""
REPORTS: frozenset[Action] = frozenset({"wildlife", "wildlife_gone"})


@dataclass(frozen=True, slots=True)
class Clearance:
    """A clearance on to a runway, in the words of its readback if there was one."""

    callsign: str
    action: Action
    runway: str | None
    t_end_ns: int


@dataclass(frozen=True, slots=True)
class Discrepancy:
    """A readback that does not agree with what was said, or comes from somebody else."""

    callsign: str
    """Callsign of who read back."""
    addressed: str
    """Callsign of who was meant."""
    given: Instruction | None
    read: Instruction
    t_end_ns: int


@dataclass(frozen=True, slots=True)
class Unanswered:
    """An instruction to keep off a runway that nobody has read back in time."""

    callsign: str
    given: Instruction
    t_end_ns: int


@dataclass(slots=True)
class _Addressed:
    """The last call to somebody."""

    instructions: tuple[Instruction, ...]
    call: Transcript
    answered: bool = False

    @property
    def t_end_ns(self) -> int:
        return self.call.t_end_ns


class Clearances:
    """The clearances about runways that were heard on the frequency."""

    def __init__(self) -> None:
        self._addressed: dict[str, _Addressed] = {}
        self._in_force: dict[str, tuple[Clearance, ...]] = {}
        self._holding: dict[str, str | None] = {}
        self._discrepancies: dict[str, Discrepancy] = {}
        self._silence = ReadbackSilence()

    def take_opening(self, opened: TransmissionOpened) -> None:
        """Note that somebody has begun to transmit."""
        self._silence.take_opening(opened)

    def take(self, call: Call, transcript: Transcript) -> None:
        """Update clearances and discrepancies with a call."""
        self._silence.take_transcript(transcript)
        said = tuple(each for each in call.instructions if each.action not in REPORTS)
        if call.callsign is None:
            return
        if call.addressed_first:
            self._addressed[call.callsign] = _Addressed(said, transcript)
            if said:
                self._settle(call.callsign)
        elif said:
            said = self._compare(call.callsign, said, transcript)
        elif (given := self._recent(call.callsign, transcript.t_tx_ns)) is not None:
            given.answered = True
        if said:
            self._act_on(call.callsign, said, transcript.t_end_ns)

    def in_force(self, t_ns: int) -> Iterator[Clearance]:
        """Yield the clearances that were not used, withdrawn or forgotten."""
        for clearances in self._in_force.values():
            for clearance in clearances:
                if t_ns - clearance.t_end_ns <= LIFETIME_S[clearance.action] * SECOND_NS:
                    yield clearance

    def is_holding(self, callsign: str, runways: tuple[str, ...]) -> bool:
        """Return whether the last instruction was to hold, short of one of these runways."""
        return callsign in self._holding and self._holding[callsign] in (None, *runways)

    def discrepancies(self, t_ns: int) -> Iterator[Discrepancy]:
        """Yield the discrepancies that nobody has corrected."""
        for discrepancy in self._discrepancies.values():
            if t_ns - discrepancy.t_end_ns <= DISCREPANCY_NS:
                yield discrepancy

    def unanswered(self, t_ns: int) -> Iterator[Unanswered]:
        """Yield the instructions to keep off a runway whose readback is late."""
        for callsign, addressed in self._addressed.items():
            if addressed.answered or t_ns - addressed.t_end_ns > DISCREPANCY_NS:
                continue
            given = [each for each in addressed.instructions if each.action in RESTRICTING]
            if given and self._silence.is_late(addressed.call, t_ns):
                yield Unanswered(callsign, given[0], addressed.t_end_ns)

    def finish(self, callsign: str, *actions: Action) -> None:
        """End clearances that somebody has used."""
        clearances = self._in_force.get(callsign, ())
        self._in_force[callsign] = tuple(c for c in clearances if c.action not in actions)

    def _act_on(self, callsign: str, said: tuple[Instruction, ...], t_end_ns: int) -> None:
        self._in_force[callsign] = tuple(
            Clearance(callsign, each.action, each.runway, t_end_ns)
            for each in said
            if each.action in LIFETIME_S
        )
        self._holding.pop(callsign, None)
        for each in said:
            if each.action in ("hold_short", "hold_position"):
                self._holding[callsign] = each.runway

    def _compare(
        self, callsign: str, read: tuple[Instruction, ...], transcript: Transcript
    ) -> tuple[Instruction, ...]:
        """Note where a readback is wrong, and return it with the runways that it leaves out."""
        begun_ns = transcript.t_tx_ns
        given = self._recent(callsign, begun_ns)
        complete = []
        self._settle(callsign)
        for each in read:
            said = given.instructions if given else ()
            match = next(
                (instruction for instruction in said if instruction.action == each.action), None
            )
            other = None if match else self._unanswered(each.action, callsign, begun_ns)
            complete.append(
                each if each.runway or not match else Instruction(each.action, match.runway)
            )
            if other is not None:
                self._note(callsign, other, each, each, transcript.t_end_ns)
            elif match and match.runway and complete[-1].runway != match.runway:
                self._note(callsign, callsign, match, each, transcript.t_end_ns)
            elif given and not match and each.action in LIFETIME_S:
                self._note(callsign, callsign, next(iter(said), None), each, transcript.t_end_ns)
        if given:
            given.answered = True
        return tuple(complete)

    def _recent(self, callsign: str, t_ns: int) -> _Addressed | None:
        given = self._addressed.get(callsign)
        return given if given and t_ns - given.t_end_ns <= READBACK_WINDOW_NS else None

    def _unanswered(self, action: Action, but: str, t_ns: int) -> str | None:
        """Return who else was given the same instruction a moment ago and has not answered."""
        for callsign in reversed(self._addressed):
            given = self._recent(callsign, t_ns)
            if callsign == but or given is None or given.answered:
                continue
            if any(each.action == action for each in given.instructions):
                return callsign
        return None

    def _note(
        self,
        callsign: str,
        addressed: str,
        given: Instruction | None,
        read: Instruction,
        t_end_ns: int,
    ) -> None:
        self._discrepancies[callsign] = Discrepancy(callsign, addressed, given, read, t_end_ns)

    def _settle(self, callsign: str) -> None:
        """Drop the discrepancy of somebody's last readback, because there is a new call."""
        self._discrepancies = {
            reader: each
            for reader, each in self._discrepancies.items()
            if callsign not in (reader, each.addressed)
        }
