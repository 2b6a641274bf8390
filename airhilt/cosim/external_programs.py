"""Programs of other processes that publish by themselves: they take no grants."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial

from pydantic import ValidationError

from airhilt.bus.closed import Answer, ClosedBus
from airhilt.bus.intake import Intake
from airhilt.cosim.context import RunContext
from airhilt.cosim.participants import Participants
from airhilt.errors import WorkerError, all_problems
from airhilt.host.text import readable
from airhilt.messages import (
    UNREGISTERED,
    ActorCommand,
    AdsbReport,
    Advisory,
    AdvisoryAudio,
    Detections,
    DropCause,
    DroppedMessages,
    LeaveSeat,
    Limit,
    LiveReport,
    Message,
    PageRefusal,
    PartialTranscript,
    SayVoice,
    SeatAction,
    SeatAnswer,
    TakeSeat,
    Transcript,
    is_match,
    key_chunk,
)
from airhilt.seats import Seats
from airhilt.sim import RealTime, Virtual
from airhilt.workers.pool import parse_output

PAGE = "page"
"""Key of the refusals of a page: they are logged, and change nothing of the run."""
HEARD: Mapping[str, type[Message]] = {
    "advisory/*": Advisory,
    "asr/*": Transcript,
    "asr/*/partial": PartialTranscript,
    "vision/*": Detections,
    "command/*": ActorCommand,
    "live/*": LiveReport,
    PAGE: PageRefusal,
    "tts/*": AdvisoryAudio,
}
"""Messages of the keys that are heard; those on the last are refused, for a voice needs grants."""
ANSWERS = "worker/*/step"
"""Keys on which programs answer that were not asked."""
ACTS = "seat/*/do"
"""Keys of the queries by which people act at seats."""
EVENTS_LIMIT = Limit(size_bytes=0, rate_hz=20)
"""Limit of answers that nobody asked for."""
LIMITS = {keys: kind.limit for keys, kind in HEARD.items() if kind.limit is not None}
ACTS_LIMIT = SeatAction.limit
assert ACTS_LIMIT is not None
MOST_NOTICES = 20
"""Number of refusals that are told on the terminal; the log has all."""
DROPPED: Mapping[DropCause, str] = {
    "size": "larger than {limit.size_bytes:,} bytes",
    "rate": "more than {limit.rate_hz} in a second",
    "queue": "more than the run has time for",
    "transport": "lost before they came, as the numbers of their sender say",
}


class ExternalPrograms:
    """Lets messages that no grant asked for count when they arrive, in real time.

    Attributes
    ----------
    heard
        True if such a program has published.
    has_decision
        True if somebody decides, so that its first advisory changes nothing.
    dropped
        Number of messages that were dropped, by kind of key and cause; see `finish`.

    Parameters
    ----------
    seats
        Seats that are left to people.
    """

    def __init__(self, context: RunContext, seats: Seats, participants: Participants) -> None:
        options = context.setup.options
        self.heard = False
        self.has_decision = bool(participants.programs) or participants.does("decision")
        self._context = context
        self._director = context.director
        self._seats = seats
        self._workers = [worker.description.name for worker in participants.workers]
        self._keeps_voices = options.voice_recording
        self._is_strict = options.strict
        self._refusals: set[str] = set()
        self._act_keys = frozenset(f"seat/{key_chunk(state.seat)}/do" for state in seats)
        self._limits = {
            **LIMITS,
            ANSWERS: EVENTS_LIMIT,
            **dict.fromkeys((ACTS, *self._act_keys), ACTS_LIMIT),
        }
        self._intake = Intake(self._limits, self._dropping)
        self.dropped: dict[str, int] = {}

    def serve(self, bus: ClosedBus) -> None:
        """Hear what programs put on the bus, and what of it does not count."""
        bus.refused = self._hear_refusal
        bus.watch_holders(
            lambda key, holder: self._director.post(lambda: self._end_hold(key, holder))
        )
        bus.answer(ACTS, partial(self._asked, bus))
        for keys in HEARD:
            bus.hear(keys, self._hear, partial(self._intake.admit, keys))

    def _asked(self, bus: ClosedBus, key: str, data: bytes, answer: Answer) -> None:
        """Handle a query by which somebody acts at a seat; called on any thread."""
        # Seats that nobody offers share one limit, so that they crowd out none that there is.
        if not self._intake.admit(key if key in self._act_keys else ACTS, len(data)):
            answer(_refused("there were too many acts, or this one is too large"))
            return
        action: SeatAction | str
        try:
            action = SeatAction.model_validate_json(data)
        except ValidationError as error:
            # The reason has no words of the person: it is logged.
            problem = error.errors(include_input=False, include_url=False)[0]
            place = "/".join(str(part) for part in problem["loc"])
            action = f"it is no SeatAction: {place or 'all'}: {problem['type']}"
        else:
            seat_key = key.removesuffix("/do")
            if isinstance(action.act, TakeSeat) and not bus.has_holder(seat_key, action.holder):
                action = "the liveliness token of the holder is not declared"
        self._director.post(lambda: self._act(key, len(data), action, answer))

    def _act(self, key: str, size: int, action: SeatAction | str, answer: Answer) -> None:
        """Let an act count, or refuse it; whoever acts needs real time."""
        self._intake.release(size)
        why = action if isinstance(action, str) else self._seats.refusal(key, action)
        if isinstance(action, str) or why:
            self._context.event("refused", readable(key), readable(why))
            answer(_refused(why))
            return
        self._need_real_time(key)
        self._seats.note_secret(key, action)
        self._accept(key, action)
        answer(SeatAnswer(answer="ok").model_dump_json().encode())

    def _accept(self, key: str, action: SeatAction) -> None:
        """Let an act count now, and log it without the secret."""
        self._note_first(key)
        action = action.model_copy(update={"t_ns": self._director.now_ns, "secret": ""})
        logged = action
        if isinstance(action.act, SayVoice) and not self._keeps_voices:
            silent = action.act.model_copy(update={"pcm": b""})
            logged = action.model_copy(update={"act": silent})
        self._context.router.heard(key, action, UNREGISTERED, logged)

    def _end_hold(self, seat_key: str, holder: str) -> None:
        """Let who is gone leave the seat."""
        if self._seats.ends_hold(seat_key, holder):
            self._accept(f"{seat_key}/do", SeatAction(holder=holder, act=LeaveSeat()))

    def _hear_refusal(self, key: str, cause: str) -> None:
        """Handle an answer on the bus that does not count; called on any thread."""

        def take() -> None:
            self._intake.release(0)
            self.take_refused(key, cause)

        if self._intake.admit(ANSWERS, 0):
            self._director.post(take)

    def _dropping(self, keys: str, cause: DropCause) -> None:
        """Tell of the first message of its kind that is dropped for this cause (any thread)."""
        why = DROPPED[cause].format(limit=self._limits[keys])
        text = f"messages on {keys} are dropped: {why}; summary.json will say how many"
        self._director.post(lambda: self.take_refused(keys, text))

    def _hear(self, key: str, data: bytes) -> None:
        """Handle a message from the bus; called on any thread."""

        def take() -> None:
            self._intake.release(len(data))
            if key != PAGE:
                self._need_real_time(key)
            self.take(key, data)

        self._director.post(take)

    def _need_real_time(self, key: str) -> None:
        """Go on in real time: nobody can keep up with a run that goes faster without grants."""
        if isinstance(self._director.pace, Virtual):
            self._director.change_pace(RealTime())
            self._context.observer.notice(
                f"a program that takes no grants published on {key}: going on in real time"
            )

    def take_accepted(self, key: str, data: bytes) -> None:
        """Let a message count of an earlier run, which was accepted there, or of this process."""
        if key not in self._act_keys:
            self.take(key, data)
            return
        try:
            self._accept(key, SeatAction.model_validate_json(data))
        except ValidationError as error:  # Somebody has changed the record.
            self._refuse(key, all_problems(error))

    def take(self, key: str, data: bytes) -> None:
        """Let a message count now.

        Raises
        ------
        WorkerError
            The message is not what belongs on its key, and the run is strict.
        """
        self._note_first(key)
        try:
            message = _parse(key, data, self._director.now_ns)
            self._require_allowed(key, message)
        except WorkerError as error:
            self._refuse(key, str(error))
            if self._is_strict:
                raise
            return
        if isinstance(message, PageRefusal):
            self._context.event("refused", PAGE, readable(message.text))
            return
        now_ns = self._director.now_ns
        stamped = message.model_copy(update={"t_ns": now_ns})
        if isinstance(stamped, Advisory) and not self.has_decision:
            self.has_decision = True
            self._context.set_modality("decision", "on")
        self._context.router.heard(key, stamped, UNREGISTERED)
        if isinstance(stamped, LiveReport):
            times = {"t_adsb_in_ns": now_ns, "t_adsb_out_ns": now_ns}
            report = AdsbReport(**stamped.model_dump() | times)
            self._context.router.publish(f"adsb/{report.icao24}", report)

    def _require_allowed(self, key: str, message: Message) -> None:
        """Complain about what is of a worker, of a person at a seat, or of an actor."""
        if isinstance(message, Advisory):
            for name in self._workers:
                if message.id.startswith(f"{name}-"):
                    raise WorkerError(
                        f"a program published an advisory with the id {message.id!r}; expected an "
                        f"id of its own: this one belongs to worker {name!r}"
                    )
        if isinstance(message, ActorCommand) and self._seats.at(key) is not None:
            raise WorkerError(
                f"a program published on {key!r}, whose actor is left to a person; expected an act "
                f"of who has the seat, on seat/{key.split('/')[1]}/do"
            )

        if isinstance(message, LiveReport):
            actor = self._context.setup.scenario.callsigns.get(message.icao24)
            if actor is not None or key != f"live/{message.icao24}":
                raise WorkerError(
                    f"a program published on {key!r} a report of {actor or message.icao24}; "
                    "expected one of an aircraft that is not in the scenario, on its own key"
                )

    def take_refused(self, key: str, cause: str) -> None:
        """Record a refusal whose message is unavailable, such as that of an earlier run."""
        if key == PAGE or is_match(key, ACTS):
            self._context.event("refused", readable(key), readable(cause))
            return
        self._note_first(key)
        self._refuse(key, cause)

    def count_dropped(self, recorded: Iterable[DroppedMessages]) -> None:
        """Count what an earlier run has dropped."""
        for each in recorded:
            self._intake.dropped[each.keys, each.cause] += each.messages

    def finish(self) -> None:
        """Publish how many messages were dropped; what is dropped from now on is not counted."""
        for (keys, cause), number in sorted(self._intake.dropped.items()):
            self.dropped[f"{keys}: {cause}"] = number
            message = DroppedMessages(
                t_ns=self._director.now_ns, keys=keys, cause=cause, messages=number
            )
            self._context.router.publish("truth/dropped", message)
        self._intake.close()

    def _note_first(self, key: str) -> None:
        """Tell once that such a program has published; a page that refuses takes no part."""
        if not self.heard and key != PAGE:
            self.heard = True
            self._context.event("unregistered", key, "a program that takes no grants has published")

    def _refuse(self, key: str, cause: str) -> None:
        cause = readable(cause)
        self._context.event("refused", readable(key), cause)
        if cause in self._refusals or len(self._refusals) > MOST_NOTICES:
            return
        self._refusals.add(cause)
        if len(self._refusals) > MOST_NOTICES:
            cause = "more was refused: the log has it all, as events of the kind refused"
        self._context.observer.notice(cause)


def _parse(key: str, data: bytes, now_ns: int) -> Message:
    """Return the message that a program put on a key."""
    if key.startswith("tts/"):
        raise WorkerError(
            "a program published on 'tts/*' without a grant; expected a voice that takes grants "
            "(docs/workers.md)"
        )
    family, _, rest = key.partition("/")
    kind = HEARD.get(f"{family}/*" if rest else key)
    if kind not in (ActorCommand, LiveReport, PageRefusal):
        return parse_output(UNREGISTERED, key, data, now_ns)
    try:
        return kind.model_validate_json(data)
    except ValidationError as error:
        raise WorkerError(
            f"a program published on {key!r} something that is no {kind.__name__}: "
            f"{all_problems(error)}; see `airhilt schema --message "
            f"{kind.__name__}`"
        ) from None


def _refused(reason: str) -> bytes:
    """Return the answer to an act that is refused."""
    return SeatAnswer(answer="refused", reason=readable(reason)).model_dump_json().encode()
