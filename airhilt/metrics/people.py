"""Words and actions of people at seats, and how soon they acted upon advisories."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from functools import partial
from statistics import fmean, median
from typing import Literal, NamedTuple

from airhilt.commands import Command
from airhilt.messages import (
    AFTER_STALL_S,
    SPEAK_MIN_LEVEL,
    STALLED,
    ActorTruth,
    Advisory,
    AdvisoryAudio,
    AgreeToUses,
    AnswerQuestion,
    Event,
    FlyCommand,
    HearCall,
    LeaveSeat,
    Message,
    PerceiveAdvisory,
    PressToTalk,
    SayText,
    SeatAct,
    SeatAction,
    SeatState,
    SpokenTruth,
    TakeSeat,
    Use,
    WorkloadQuestion,
    key_chunk,
)
from airhilt.metrics.compliance import complies
from airhilt.metrics.person_calls import PersonCalls
from airhilt.metrics.readbacks import ANSWERED_WITHIN_NS, Readbacks
from airhilt.metrics.summary import IsaRating, PersonReaction, PersonSummary, WorkloadSummary
from airhilt.units import SECOND_NS, ns_to_seconds, seconds_to_ns

FOLLOWED_WITHIN_S = 30.0
"""Time from perceiving an advisory in which the advised action counts as following it, in s: an
assumption. TCAS asks crews for 5 s (ICAO Doc 8168, volume III), controllers take longer."""
Advised = tuple[str, int, str]
"""Id, revision and recipient of an advisory."""


SPOKEN_CALL, TYPED_CALL = "spoken call", "typed call"
"""Names of the actions of pressing the button, and of typing a call."""
REAL_TIME = "realtime"
"""Name of the pace in which the time of the run passes as on the clock."""
AFTER_STALL_NS = seconds_to_ns(AFTER_STALL_S)
"""Time after a stall that is not real time yet, in ns."""
VIRTUAL = "virtual"
"""Name of the pace of a run that goes on as fast as before when another pace is asked for."""


class _Action(NamedTuple):
    t_ns: int
    what: str
    command: Command | None = None
    """None: it is a call."""
    track_deg: float | None = None
    """True track of the person's aircraft or vehicle when the command came."""
    is_refused: bool = False
    """True if the aircraft or vehicle was unable to carry it out."""


class _Perceived(NamedTuple):
    """An advisory as a person perceived it, and the first action after that."""

    name: Advised
    since_ns: int
    """Time from which the reaction counts."""
    way: Literal["heard", "seen"]
    first: _Action | None


@dataclass
class _Person:
    actions: list[_Action] = field(default_factory=list)
    delays_s: list[float] = field(default_factory=list)
    seen_ns: dict[Advised, int] = field(default_factory=dict)
    heard_ns: dict[Advised, int] = field(default_factory=dict)
    agreed: frozenset[Use] | None = None
    """Uses to which the last answer agrees; None: there was none."""
    told: set[Advised] = field(default_factory=set)
    """Advisories that were published to the person."""

    def refuse(self, t_ns: int) -> None:
        """Take in that the command that came at a time cannot be carried out."""
        if self.actions and self.actions[-1].command and self.actions[-1].t_ns == t_ns:
            self.actions[-1] = self.actions[-1]._replace(is_refused=True)

    def first_action(self, since_ns: int) -> _Action | None:
        later = (one for one in self.actions if one.t_ns >= since_ns)
        return min(later, default=None, key=lambda one: one.t_ns)

    @property
    def perceived_names(self) -> set[Advised]:
        """Advisories that the person saw or heard."""
        return {*self.seen_ns, *self.heard_ns}

    def perceived_ns(self, name: Advised) -> int:
        """Return when an advisory that the person saw or heard was first seen or heard."""
        return min(times[name] for times in (self.seen_ns, self.heard_ns) if name in times)

    def perceived(self, name: Advised) -> _Perceived:
        """Return from when an advisory counts: heard, or drawn if not heard before the action."""
        seen_ns, heard_ns = self.seen_ns.get(name), self.heard_ns.get(name)
        if seen_ns is not None:
            first = self.first_action(seen_ns)
            if heard_ns is None or (first is not None and first.t_ns < heard_ns):
                return _Perceived(name, seen_ns, "seen", first)
        assert heard_ns is not None  # It was perceived.
        return _Perceived(name, heard_ns, "heard", self.first_action(heard_ns))


@dataclass
class _Seat:
    calls: PersonCalls
    recipients: tuple[str, ...] = ()
    """Names under which advisories are for the person."""
    people: list[_Person] = field(default_factory=list)
    is_taken: bool = False
    since_ns: int = 0
    """Time at which the seat was taken or left last."""
    taken_ns: int = 0
    """Time for which somebody had the seat, up to then."""
    track_deg: float | None = None
    """True track of the aircraft or vehicle; None for a unit."""
    asked_again: int = 0
    readback_errors: int = 0
    readback_errors_heard: int = 0
    questions: dict[int, WorkloadQuestion] = field(default_factory=dict)
    answers: dict[int, tuple[int, AnswerQuestion]] = field(default_factory=dict)
    """Time in ns and answer, by the number of the question."""

    @property
    def person(self) -> _Person | None:
        """The person who has the seat now."""
        return self.people[-1] if self.is_taken else None

    def occupy(self, t_ns: int, *, is_taken: bool) -> None:
        if is_taken and not self.is_taken:
            self.people.append(_Person())
        self.taken_ns, self.since_ns = self.taken_until_ns(t_ns), t_ns
        self.is_taken = is_taken

    def taken_until_ns(self, t_ns: int) -> int:
        """Return for how long somebody has had the seat at a time that is not past."""
        return self.taken_ns + (t_ns - self.since_ns if self.is_taken else 0)


class PeopleRecords:
    """Follows the people at the seats of a run, which are units and callsigns.

    The callsigns are those of the run; the pace is the one with which it begins.
    """

    def __init__(
        self, seats: Collection[str], callsigns: Collection[str] = (), pace: str = REAL_TIME
    ) -> None:
        self._readbacks = Readbacks(callsigns)
        self._names = {key_chunk(seat): seat for seat in seats}
        self._seats = {seat: _Seat(PersonCalls(seat)) for seat in seats}
        self._advisories: dict[Advised, Advisory] = {}
        self._voices_ns: dict[Advised, int] = {}
        self._on_air: list[SpokenTruth] = []
        """Calls of everybody, if there are seats."""
        self._heard_ns: dict[str, dict[str, int]] = {}
        """Times at which calls were audible, by their ids and by seats."""
        self._first_pace = pace
        self._paces: list[tuple[int, str]] = []
        """Times at which the pace changed, and the pace."""
        self._stalls_ns: list[int] = []

    def take_state(self, state: ActorTruth) -> None:
        """Receive the true state of an actor."""
        seat = self._seats.get(state.actor)
        if seat is not None:
            track_rad = math.atan2(state.velocity_east_m_s, state.velocity_north_m_s)
            seat.track_deg = math.degrees(track_rad)

    def take(self, key: str, message: Message) -> None:
        """Receive a published message."""
        if self._seats and (error := self._readbacks.take(message)) is not None:
            if error.reader in self._seats:
                self._seats[error.reader].readback_errors += 1
            if error.giver in self._seats:
                self._seats[error.giver].readback_errors_heard += 1
        if self._seats and isinstance(message, SpokenTruth):
            self._on_air.append(message)
        for seat in self._seats.values():
            seat.calls.take(message)
        match message:
            case Advisory():
                name = message.id, message.revision, message.recipient
                self._advisories[name] = message
                for seat in self._seats.values():
                    if message.active and seat.person and message.recipient in seat.recipients:
                        seat.person.told.add(name)
            case Event(kind="pace", text=text, t_ns=t_ns) if text == STALLED:
                self._stalls_ns.append(t_ns)
            case Event(kind="pace", text=pace, t_ns=t_ns) if self._first_pace != VIRTUAL:
                self._paces.append((t_ns, pace))
            case Event(kind="unable", subject=at, t_ns=t_ns) if at in self._seats:
                if (person := self._seats[at].person) is not None:
                    person.refuse(t_ns)
            case SeatState(seat=at, recipients=recipients, question=question):
                self._seats[at].recipients = recipients
                if question is not None:
                    self._seats[at].questions[question.number] = question
            case AdvisoryAudio():
                name = message.id, message.revision, message.recipient
                self._voices_ns[name] = message.t_ns
            case SpokenTruth(addressed=at, id=call) if at in self._seats:
                self._seats[at].asked_again += ".say-again-" in call
            case SeatAction(act=act, t_ns=t_ns):
                if (at := self._names.get(key.split("/")[1])) is not None:
                    self._take_at(at, act, t_ns)

    def _take_at(self, at: str, act: SeatAct, t_ns: int) -> None:
        seat = self._seats[at]
        match act:
            case TakeSeat():
                seat.occupy(t_ns, is_taken=True)
            case LeaveSeat():
                seat.occupy(t_ns, is_taken=False)
            case AnswerQuestion(question=number):
                seat.answers.setdefault(number, (t_ns, act))
            case HearCall(id=call, after_s=after_s) if seat.person is not None:
                heard_ns = t_ns + round(after_s * SECOND_NS)
                self._heard_ns.setdefault(call, {}).setdefault(at, heard_ns)
            case _ if seat.person is not None:
                self._take_of(seat, seat.person, act, t_ns)

    @staticmethod
    def _take_of(seat: _Seat, person: _Person, act: SeatAct, t_ns: int) -> None:
        match act:
            case AgreeToUses(uses=uses):
                person.agreed = frozenset(uses)
            case FlyCommand(command=command):
                person.actions.append(_Action(t_ns, command.action, command, seat.track_deg))
            case SayText(text=text):
                seat.calls.type(t_ns, text)
                person.actions.append(_Action(t_ns, TYPED_CALL))
            case PressToTalk(delay_s=delay_s):
                pressed_ns = t_ns - round(delay_s * SECOND_NS)
                seat.calls.press(pressed_ns, t_ns)
                person.actions.append(_Action(pressed_ns, SPOKEN_CALL))
                person.delays_s.append(delay_s)
            case PerceiveAdvisory(id=identity, revision=revision, recipient=recipient):
                times = person.heard_ns if act.way == "heard" else person.seen_ns
                perceived_ns = t_ns + round(act.after_s * SECOND_NS)
                times.setdefault((identity, revision, recipient), perceived_ns)

    def summaries(self, now_ns: int) -> list[PersonSummary]:
        """Return what people did until the end of the run, by seat."""
        return [self._summary(name, seat, now_ns) for name, seat in self._seats.items()]

    def _summary(self, name: str, seat: _Seat, now_ns: int) -> PersonSummary:
        done = [one.what for person in seat.people for one in person.actions]
        spoken, typed = done.count(SPOKEN_CALL), done.count(TYPED_CALL)
        delays_s = [delay_s for person in seat.people for delay_s in person.delays_s]
        reactions = [one for person in seat.people for one in self._reactions(person)]
        calls = seat.calls.rows(partial(self._heard_after, name), self._next_call)
        spoken_s = [call.to_loudspeaker_s for call in calls if call.way == "spoken"]
        return PersonSummary(
            seat=name,
            seat_time_s=seat.taken_until_ns(now_ns) / SECOND_NS,
            consent=_consent(seat.people),
            spoken_calls=spoken,
            typed_calls=typed,
            commands=len(done) - spoken - typed,
            asked_to_say_again=seat.asked_again,
            readback_errors=seat.readback_errors,
            readback_errors_heard=seat.readback_errors_heard,
            press_to_transmit_s=_median(delays_s),
            press_to_loudspeaker_s=_median(spoken_s),
            reaction_time_s=_median([one.reaction_time_s for one in reactions]),
            warning_to_press_s=self._warning_to_press_s(seat.people),
            unperceived=sum(len(person.told - person.perceived_names) for person in seat.people),
            calls=calls,
            reactions=reactions,
            workload=_workload(seat) if seat.questions else None,
        )

    def _heard_after(self, speaker: str, call: str, since_ns: int) -> list[float | None]:
        """Return how long after a time each seat but the speaker's heard a call, in s."""
        return [
            (heard_ns - since_ns) / SECOND_NS if self._is_real_time(since_ns, heard_ns) else None
            for seat, heard_ns in self._heard_ns.get(call, {}).items()
            if seat != speaker
        ]

    def _next_call(self, said: SpokenTruth) -> SpokenTruth | None:
        later = (
            one
            for one in self._on_air
            if one.frequency_khz == said.frequency_khz and one.t_tx_ns >= said.t_end_ns
        )
        found = min(later, default=None, key=lambda one: one.t_tx_ns)
        if found is None or found.t_tx_ns - said.t_end_ns > ANSWERED_WITHIN_NS:
            return None
        seat = self._seats.get(found.speaker)
        if seat is None or found.speaker == said.speaker or not seat.calls.made(found.id):
            return None
        return found

    def _warning_to_press_s(self, people: list[_Person]) -> float | None:
        """Return how long after the first warning perceived the person pressed the button."""
        warnings = [
            (person.perceived_ns(name), person)
            for person in people
            for name in person.perceived_names & self._advisories.keys()
            if self._advisories[name].severity.rank >= SPEAK_MIN_LEVEL.rank
        ]
        if not warnings:
            return None
        warned_ns, person = min(warnings, key=lambda one: one[0])
        pressed = (one.t_ns for one in person.actions if one.what == SPOKEN_CALL)
        pressed_ns = min((t_ns for t_ns in pressed if t_ns >= warned_ns), default=None)
        if pressed_ns is None or not self._is_real_time(warned_ns, pressed_ns):
            return None
        return _seconds_between(warned_ns, pressed_ns)

    def _reactions(self, person: _Person) -> list[PersonReaction]:
        names = person.perceived_names & self._advisories.keys()
        perceived = sorted(person.perceived(name) for name in names)
        return [self._reaction(one, perceived, person) for one in perceived]

    def _reaction(
        self, one: _Perceived, perceived: list[_Perceived], person: _Person
    ) -> PersonReaction:
        name, since_ns, first = one.name, one.since_ns, one.first
        advisory = self._advisories[name]
        heard_ns, voice_ns = person.heard_ns.get(name), self._voices_ns.get(name)
        is_shared = first is not None and self._answered(first, perceived) is not one
        is_real_time = first is None or self._is_real_time(since_ns, first.t_ns)
        reacted_ns = None if first is None or is_shared or not is_real_time else first.t_ns
        return PersonReaction(
            advisory=advisory.id,
            revision=advisory.revision,
            kind=advisory.kind,
            severity=advisory.severity,
            advised=None if advisory.recommendation is None else advisory.recommendation.action,
            t_advisory_s=advisory.t_ns / SECOND_NS,
            t_seen_s=ns_to_seconds(person.seen_ns.get(name)),
            t_heard_s=ns_to_seconds(heard_ns),
            voice_to_loudspeaker_s=_seconds_between(voice_ns, heard_ns),
            counted_from=one.way,
            first_action=None if first is None else first.what,
            is_shared=is_shared,
            is_real_time=is_real_time,
            reaction_time_s=_seconds_between(since_ns, reacted_ns),
            followed=_is_followed(advisory, since_ns, person.actions),
        )

    def _answered(self, action: _Action, perceived: list[_Perceived]) -> _Perceived:
        """Return the advisory to which an action is the reaction.

        It is the first with which the action complies, else the first after which it is the first
        action.
        """

        def order(one: _Perceived) -> tuple[bool, int, Advised]:
            is_other = not _complies(action, self._advisories[one.name])
            return is_other, one.since_ns, one.name

        return min((one for one in perceived if one.first is action), key=order)

    def _is_real_time(self, begin_ns: int, end_ns: int) -> bool:
        before = [self._first_pace, *(pace for t_ns, pace in self._paces if t_ns < begin_ns)]
        within = [pace for t_ns, pace in self._paces if begin_ns <= t_ns <= end_ns]
        stalls = [t_ns for t_ns in self._stalls_ns if begin_ns - AFTER_STALL_NS <= t_ns <= end_ns]
        return not stalls and all(pace == REAL_TIME for pace in (before[-1], *within))


def _seconds_between(begin_ns: int | None, end_ns: int | None) -> float | None:
    return None if begin_ns is None or end_ns is None else (end_ns - begin_ns) / SECOND_NS


def _median(values: Sequence[float | None]) -> float | None:
    """Return the median of the values that are known, None if none is."""
    known = [value for value in values if value is not None]
    return median(known) if known else None


def _consent(people: list[_Person]) -> Literal["voice", "words", "none"] | None:
    """Return to what the last person who has answered agreed at last."""
    answers = [one.agreed for one in people if one.agreed is not None]
    if not answers:
        return None
    return "voice" if "voice" in answers[-1] else "words" if answers[-1] else "none"


def _workload(seat: _Seat) -> WorkloadSummary:
    ratings, tlx = [], None
    for number, question in sorted(seat.questions.items()):
        answered_ns, answer = seat.answers.get(number, (0, None))
        if question.scale == "nasa_tlx":
            tlx = None if answer is None else answer.nasa_tlx
            continue
        rating = None if answer is None else answer.isa
        after_s = None if rating is None else (answered_ns - question.asked_ns) / SECOND_NS
        asked_s = question.asked_ns / SECOND_NS
        ratings.append(IsaRating(t_s=asked_s, rating=rating, answered_after_s=after_s))
    given = [one.rating for one in ratings if one.rating is not None]
    return WorkloadSummary(
        isa_mean=fmean(given) if given else None,
        isa=ratings,
        nasa_tlx=tlx,
        raw_tlx=None if tlx is None else tlx.raw_tlx,
    )


def _is_followed(advisory: Advisory, since_ns: int, actions: list[_Action]) -> bool | None:
    """Return whether a person did in time what was advised; None if nothing was."""
    if advisory.recommendation is None:
        return None
    until_ns = since_ns + round(FOLLOWED_WITHIN_S * SECOND_NS)
    return any(
        since_ns <= one.t_ns <= until_ns and not one.is_refused and _complies(one, advisory)
        for one in actions
    )


def _complies(action: _Action, advisory: Advisory) -> bool:
    advised = advisory.recommendation
    return advised is not None and complies(advised, action.command, action.track_deg)
