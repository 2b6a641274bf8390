"""Clearances and readbacks about runways, and where the two do not agree."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

from airhilt.assistant.decision.guard import ConfidenceGuard, Doubt, RememberingGuard
from airhilt.assistant.decision.readback_silence import ReadbackSilence
from airhilt.messages import Transcript, TransmissionOpened
from airhilt.phraseology import BESIDES, REPORTS, Action, Call, Instruction, differences
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
"""Instructions to keep off a runway. Who has not received one goes on."""


class Clearance(NamedTuple):
    """A clearance on to a runway, in the words of its readback if there was one."""

    callsign: str
    action: Action
    runway: str | None
    t_end_ns: int
    radio_id: str
    """Id of the transmission."""
    is_certain: bool = True
    """False if a slot of it is in doubt: it then allows nobody to be on a runway."""


class Discrepancy(NamedTuple):
    """A readback that does not agree with what was said, or comes from somebody else."""

    callsign: str
    """Callsign of who read back."""
    addressed: str
    """Callsign of who was meant."""
    given: Instruction | None
    read: Instruction
    t_end_ns: int
    radio_ids: tuple[str, str]
    """Ids of the transmissions: the instruction, and its readback."""


class Unanswered(NamedTuple):
    """An instruction to keep off a runway that nobody has read back in time."""

    callsign: str
    given: Instruction
    t_end_ns: int
    radio_id: str


class AmbiguousCall(NamedTuple):
    """An instruction about a runway whose addressee may be one of several."""

    transcript: Transcript
    callsigns: tuple[str, ...]
    said: Instruction


@dataclass(slots=True)
class _Addressed:
    """The last call to somebody."""

    instructions: tuple[Instruction, ...]
    call: Call
    transcript: Transcript
    doubts: dict[Action, Doubt]
    """Instructions of the call that are in doubt, by their actions."""
    values: dict[Action, Doubt | None]
    """Doubts about their runways, by their actions."""
    answered: bool = False
    asked_again_ns: int = 0
    """End of the last request to say the readback again."""

    @property
    def t_end_ns(self) -> int:
        return max(self.transcript.t_end_ns, self.asked_again_ns)

    def told(self, action: Action) -> Instruction | None:
        return next((each for each in self.instructions if each.action == action), None)


class Clearances:
    """The clearances about runways that were heard on the frequency.

    An instruction of which a slot is in doubt is believed once its readback agrees with it, or once
    it was said again, with confidence or alike. Until then it gives no permission and withdraws
    none.
    """

    def __init__(self, guard: ConfidenceGuard) -> None:
        self._guard = RememberingGuard(guard.tau_asr)
        self._doubts: dict[str, Doubt] = {}
        """The doubt about the last call of or to each callsign."""
        self._addressed: dict[str, _Addressed] = {}
        self._read_back: dict[str, _Addressed] = {}
        """Instructions that were read back, if nothing else was said since, by callsign."""
        self._in_force: dict[str, tuple[Clearance, ...]] = {}
        self._holding: dict[str, str | None] = {}
        self._discrepancies: dict[str, Discrepancy] = {}
        self._ambiguous: list[AmbiguousCall] = []
        self._silence = ReadbackSilence()
        self._answered_ns: dict[int, int] = {}
        """Beginning of the last call of a crew, by frequency. It does not begin with a callsign."""

    def take_opening(self, opened: TransmissionOpened) -> None:
        """Note that somebody has begun to transmit."""
        self._silence.take_opening(opened)

    def take(self, call: Call, transcript: Transcript) -> None:
        """Update clearances and discrepancies with a call."""
        self._silence.take_transcript(transcript)
        if not call.addressed_first:
            self._answered_ns[transcript.frequency_khz] = transcript.t_tx_ns
        said = tuple(each for each in call.instructions if each.action not in REPORTS | BESIDES)
        self._take_ambiguous(call, transcript)
        callsign = call.match.callsign
        if callsign is None:
            return
        doubts = {
            each.action: doubt
            for each in said
            if (doubt := self._guard.doubt(call, each, transcript)) is not None
            and self._is_news(callsign, each)
        }
        if call.match.ambiguous:
            self._suspect(callsign, doubts.values())
            return
        if call.asks_again:  # What is in doubt will be said again.
            self._drop_doubts(callsign)
        if call.addressed_first:
            values = {
                each.action: self._guard.doubt_of_value(call, each, transcript) for each in said
            }
            self._address(callsign, _Addressed(said, call, transcript, dict(doubts), values))
        elif said:
            said = self._compare(call, callsign, said, transcript, doubts)
        else:
            if (given := self._recent(callsign, transcript.t_tx_ns)) is not None:
                given.answered = True
            if _tells_something(call):
                self._read_back.pop(callsign, None)
        believed = tuple(each for each in said if each.action not in doubts)
        if believed:
            self._act_on(callsign, believed, transcript)
        self._suspect(callsign, doubts.values())

    def _take_ambiguous(self, call: Call, transcript: Transcript) -> None:
        """Note a call that may be for several; one that names one of them settles it."""
        if call.callsign is not None:
            self._ambiguous = [x for x in self._ambiguous if call.callsign not in x.callsigns]
        said = [x for x in call.instructions if x.action in LIFETIME_S or x.action in RESTRICTING]
        if call.match.ambiguous and said:
            callsigns = tuple(each.callsign for each in call.match.candidates)
            self._ambiguous.append(AmbiguousCall(transcript, callsigns, said[0]))

    def _address(self, callsign: str, addressed: _Addressed) -> None:
        """Note a call to somebody, whose readback is awaited.

        After a request to say a readback again, another readback of the same instruction is
        awaited. Until it comes, a call without an instruction, such as "roger", changes nothing.
        Any other "say again" is about other words, or is the crew's: nothing is awaited after it
        until the next instruction.
        """
        call, end_ns = addressed.call, addressed.transcript.t_end_ns
        told = self._read_back.get(callsign)
        if call.asks_again:
            if told is not None and end_ns - told.t_end_ns <= DISCREPANCY_NS:
                told.answered, told.asked_again_ns = False, end_ns
                self._addressed[callsign] = told
            else:
                self._addressed.pop(callsign, None)
            return
        if told is not None and not addressed.instructions:
            given = self._recent(callsign, addressed.transcript.t_tx_ns)
            if given is told and not told.answered:
                return
        if addressed.instructions or _tells_something(call):
            self._read_back.pop(callsign, None)
        self._addressed[callsign] = addressed
        if len(addressed.doubts) < len(addressed.instructions):
            self._settle(callsign)

    def _is_news(self, callsign: str, said: Instruction) -> bool:
        """Return whether an instruction would change what somebody is believed to be cleared to."""
        if said.action in RESTRICTING:
            return True
        return said.action in LIFETIME_S and not any(
            known.is_certain and (known.action, known.runway) == (said.action, said.runway)
            for known in self._in_force.get(callsign, ())
        )

    def in_force(self, t_ns: int) -> list[Clearance]:
        """Return the clearances that were not used, withdrawn or forgotten."""
        return [
            clearance
            for clearances in self._in_force.values()
            for clearance in clearances
            if t_ns - clearance.t_end_ns <= LIFETIME_S[clearance.action] * SECOND_NS
        ]

    def is_holding(self, callsign: str, runways: tuple[str, ...]) -> bool:
        """Return whether the last instruction was to hold, short of one of these runways."""
        return callsign in self._holding and self._holding[callsign] in (None, *runways)

    def discrepancies(self, t_ns: int) -> list[Discrepancy]:
        """Return the discrepancies that nobody has corrected."""
        found = self._discrepancies.values()
        return [each for each in found if t_ns - each.t_end_ns <= DISCREPANCY_NS]

    def ambiguous(self, t_ns: int) -> list[AmbiguousCall]:
        """Return the calls that may be for several, and that nobody has settled."""
        found = self._ambiguous
        return [each for each in found if t_ns - each.transcript.t_end_ns <= DISCREPANCY_NS]

    def unanswered(self, t_ns: int) -> Iterator[Unanswered]:
        """Yield the instructions to keep off a runway whose readback is late."""
        for callsign, addressed in self._addressed.items():
            is_asked_again = addressed.asked_again_ns > 0
            is_old = t_ns - addressed.t_end_ns > DISCREPANCY_NS
            if addressed.answered or is_asked_again or is_old:
                continue
            given = [
                each
                for each in addressed.instructions
                if each.action in RESTRICTING and each.action not in addressed.doubts
            ]
            if given and self._silence.is_late(addressed.transcript, t_ns):
                yield Unanswered(callsign, given[0], addressed.t_end_ns, addressed.transcript.id)

    def doubts(self, t_ns: int) -> Iterator[Doubt]:
        """Yield what is still in doubt; an instruction not before its readback is late."""
        for doubt in self._doubts.values():
            said = doubt.transcript
            since_ns = t_ns - said.t_end_ns
            is_due = (
                doubt.is_answered
                or since_ns > READBACK_WINDOW_NS
                or self._answered_ns.get(said.frequency_khz, 0) >= said.t_end_ns
                or self._silence.is_late(said, t_ns)
            )
            if is_due and since_ns <= DISCREPANCY_NS:
                yield doubt

    def finish(self, callsign: str, *actions: Action) -> None:
        """End clearances that somebody has used."""
        clearances = self._in_force.get(callsign, ())
        self._in_force[callsign] = tuple(c for c in clearances if c.action not in actions)

    def _act_on(self, callsign: str, said: tuple[Instruction, ...], transcript: Transcript) -> None:
        self._in_force[callsign] = tuple(
            Clearance(callsign, each.action, each.runway, transcript.t_end_ns, transcript.id)
            for each in said
            if each.action in LIFETIME_S
        )
        self._holding.pop(callsign, None)
        self._drop_doubts(callsign)
        for each in said:
            if each.action in ("hold_short", "hold_position"):
                self._holding[callsign] = each.runway

    def _drop_doubts(self, callsign: str) -> None:
        self._doubts = {
            name: doubt
            for name, doubt in self._doubts.items()
            if callsign not in (name, doubt.callsign)
        }

    def _suspect(self, callsign: str, doubts: Iterable[Doubt]) -> None:
        """Note doubts; their instructions may have cleared somebody, who then holds no more."""
        for doubt in doubts:
            self._doubts[callsign] = doubt
            said = doubt.said
            if said.action in LIFETIME_S:
                heard = doubt.transcript
                maybe = Clearance(
                    callsign, said.action, said.runway, heard.t_end_ns, heard.id, is_certain=False
                )
                self._in_force[callsign] = (*self._in_force.get(callsign, ()), maybe)
                self._holding.pop(callsign, None)

    def _compare(
        self,
        call: Call,
        callsign: str,
        read: tuple[Instruction, ...],
        transcript: Transcript,
        doubts: dict[Action, Doubt],
    ) -> tuple[Instruction, ...]:
        """Note where a readback is wrong, and return it with the runways that it leaves out.

        A slot that agrees with the instruction is no longer in doubt. A slot that differs and is in
        doubt in either call does not count as a wrong readback yet.
        """
        given = self._recent(callsign, transcript.t_tx_ns)
        complete = []
        if len(doubts) < len(read):
            self._settle(callsign)
        for each in read:
            match = given.told(each.action) if given else None
            full = each if each.runway or not match else replace(each, runway=match.runway)
            complete.append(full)
            other = None if match else self._unanswered(each.action, callsign, transcript.t_tx_ns)
            own = doubts.pop(each.action, None)
            addressed, told = callsign, match
            if other is not None:
                addressed, told = other, each
                heard = (own, self._addressed[other].doubts.get(each.action))
                doubt = next((one for one in heard if one and one.slot == "callsign"), None)
            elif given and match:
                if "runway" not in differences(match, each):
                    continue
                doubt = self._guard.doubt_of_value(call, each, transcript)
                doubt = doubt or given.values[each.action]
            elif given and each.action in LIFETIME_S:
                told = next(iter(given.instructions), None)
                doubt = own or next(iter(given.doubts.values()), None)
                doubt = doubt or self._guard.doubt_of_rest(callsign, each, given.transcript)
            else:
                if own is not None:
                    doubts[each.action] = own
                continue
            if doubt is not None:
                doubts[each.action] = replace(doubt, is_answered=True)
                continue
            radio_ids = (self._addressed[addressed].transcript.id, transcript.id)
            self._discrepancies[callsign] = Discrepancy(
                callsign, addressed, told, each, transcript.t_end_ns, radio_ids
            )
        if given:
            given.answered = True
            self._read_back[callsign] = given
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

    def _settle(self, callsign: str) -> None:
        """Drop the discrepancy of somebody's last readback, because there is a new call."""
        self._discrepancies = {
            reader: each
            for reader, each in self._discrepancies.items()
            if callsign not in (reader, each.addressed)
        }


def _tells_something(call: Call) -> bool:
    """Return whether a call without an instruction has words of its own that were understood."""
    return call.kind != "unknown" and not call.acknowledged
