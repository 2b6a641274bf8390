"""Programs of other processes that publish by themselves: they take no grants."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from functools import partial

from pydantic import ValidationError

from airhilt.bus.intake import Intake
from airhilt.bus.session import Bus, Refusal
from airhilt.commands import Command
from airhilt.cosim.events import EventPublisher
from airhilt.cosim.modalities import Modalities
from airhilt.cosim.observer import Observer
from airhilt.cosim.router import MessageRouter
from airhilt.errors import WorkerError, first_problem
from airhilt.messages import (
    UNREGISTERED,
    ActorCommand,
    Advisory,
    AdvisoryAudio,
    AdvisoryPerceived,
    CallHeard,
    Detections,
    DropCause,
    DroppedMessages,
    Limit,
    Message,
    MicrophoneAudio,
    PaceCommand,
    PageRefusal,
    PartialTranscript,
    SeatConsent,
    SeatListening,
    SeatPresence,
    SpokenWords,
    Transcript,
    WorkloadAnswer,
)
from airhilt.sensors.radio.conversation import FromSeat
from airhilt.sim import Director, RealTime, Virtual
from airhilt.text import readable
from airhilt.workers.pool import parse_output

PAGE = "page"
"""Key of the refusals of a page: they are logged, and change nothing of the run."""
HEARD: Mapping[str, type[Message]] = {
    "advisory/*": Advisory,
    "asr/*": Transcript,
    "asr/*/partial": PartialTranscript,
    "vision/*": Detections,
    "command/*": ActorCommand,
    "speech/*": SpokenWords,
    "microphone/*": MicrophoneAudio,
    "listening/*": SeatListening,
    "consent/*": SeatConsent,
    "perceived/*": AdvisoryPerceived,
    "heard/*": CallHeard,
    "pace": PaceCommand,
    PAGE: PageRefusal,
    "workload/*": WorkloadAnswer,
    "tts/*": AdvisoryAudio,
}
"""Messages of the keys that are heard; those on the last are refused, for a voice needs grants."""
AT_SEATS = (
    SpokenWords, MicrophoneAudio, SeatListening, SeatConsent, AdvisoryPerceived, CallHeard,
    SeatPresence, WorkloadAnswer,
)  # fmt: skip
"""Messages of people at seats."""
ANSWERS = "worker/*/step"
"""Keys on which programs answer that were not asked."""
SEATS = "seat/*"
"""Keys on which programs take seats."""
EVENTS_LIMIT = Limit(size_bytes=0, rate_hz=20)
"""Limit of answers that nobody asked for, and of taking or leaving a seat."""
LIMITS = {keys: kind.limit for keys, kind in HEARD.items() if kind.limit is not None}
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

    Parameters
    ----------
    obey
        Lets an actor carry out a command.
    take_from_seat
        Takes what the person at a seat says, typed or spoken.
    seats
        Seats that are left to people, as parts of keys.
    units
        Seats that fly and drive nothing, as parts of keys.
    keeps_voices
        False leaves the voices of people out of the log.
    listen
        Takes to which frequencies the person at a seat, a part of keys, listens.
    consent
        Takes whether the person at a seat agrees to the use of the voice, or of typed words.
    occupy
        Called with a seat, as a part of keys, and true if a person has taken it, false if left.
    set_pace
        Lets the time pass at a part of real time.
    may_pause
        False refuses that.
    answer
        Takes what the person at a seat, a part of keys, answers to a question about workload.
    is_asked
        Says of a seat, a part of keys, and a number that this question waits for an answer.
    workers
        Names of the workers that take grants: their advisories are not those of a program.
    is_strict
        True if a message that is refused stops the run.
    """

    def __init__(
        self,
        director: Director,
        router: MessageRouter,
        event: EventPublisher,
        modalities: Modalities,
        observer: Observer,
        *,
        obey: Callable[[str, Command], None],
        take_from_seat: Callable[[str, FromSeat], None],
        seats: Collection[str],
        units: Collection[str],
        keeps_voices: bool,
        listen: Callable[[str, SeatListening], None],
        consent: Callable[[str, SeatConsent], None],
        occupy: Callable[[str, bool], None],
        set_pace: Callable[[float], None],
        may_pause: bool,
        answer: Callable[[str, WorkloadAnswer], None],
        is_asked: Callable[[str, int], bool],
        workers: Collection[str],
        has_decision: bool,
        is_strict: bool,
    ) -> None:
        self.heard = False
        self._refusals: set[str] = set()
        self.has_decision = has_decision
        self._director = director
        self._router = router
        self._event = event
        self._modalities = modalities
        self._observer = observer
        self._obey = obey
        self._take_from_seat = take_from_seat
        self._seats = frozenset(seats)
        self._units = units
        self._keeps_voices = keeps_voices
        self._listen = listen
        self._consent = consent
        self._occupy = occupy
        self._set_pace = set_pace
        self._may_pause = may_pause
        self._answer = answer
        self._is_asked = is_asked
        self._workers = workers
        self._is_strict = is_strict
        self._seat_keys = frozenset(f"seat/{seat}" for seat in seats)
        bounded = dict.fromkeys((ANSWERS, SEATS, *self._seat_keys), EVENTS_LIMIT)
        self._intake = Intake(LIMITS | bounded, self._dropping)
        self._dropped: dict[str, int] = {}

    def serve(self, bus: Bus) -> None:
        """Hear what programs put on the bus, and what of it does not count."""
        bus.hear_refusals(self._hear_refusal)
        bus.watch_seats(self._note_presence)
        for keys in HEARD:
            bus.hear(keys, self._post, partial(self._intake.admit, keys))

    def _note_presence(self, seat: str, is_taken: bool) -> None:
        """Take note that a person has taken a seat, or left it (any thread)."""
        key = f"seat/{seat}"
        # Seats that nobody offers share one limit, so that they crowd out none that there is.
        if self._intake.admit(key if key in self._seat_keys else SEATS, 0):
            self._director.post(lambda: self._take_presence(key, is_taken))

    def _take_presence(self, key: str, is_taken: bool) -> None:
        self._intake.release(0)
        self.take(key, SeatPresence(is_taken=is_taken).model_dump_json().encode())

    def _hear_refusal(self, refusal: Refusal) -> None:
        if self._intake.admit(ANSWERS, 0):
            self._director.post(lambda: self._take_answer(refusal))

    def _take_answer(self, refusal: Refusal) -> None:
        self._intake.release(0)
        self.take_refused(refusal.key, refusal.cause)

    def _post(self, key: str, data: bytes) -> None:
        self._director.post(lambda: self._hear(key, data))

    def _dropping(self, keys: str, cause: DropCause) -> None:
        """Tell of the first message of its kind that is dropped for this cause (any thread)."""
        limit = LIMITS.get(keys, EVENTS_LIMIT)
        text = (
            f"messages on {keys} are dropped: {DROPPED[cause].format(limit=limit)}; summary.json "
            "will say how many"
        )
        self._director.post(lambda: self.take_refused(keys, text))

    def _hear(self, key: str, data: bytes) -> None:
        """Take a message from the bus; a program that takes no grants needs real time."""
        self._intake.release(len(data))
        if isinstance(self._director.pace, Virtual) and key != PAGE:
            self._director.change_pace(RealTime())
            self._observer.notice(
                f"a program that takes no grants published on {key}: going on in real time"
            )
        self.take(key, data)

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
            self._require_own(message)
            self._require_seat(key, message)
            self._require_asked(key, message)
        except WorkerError as error:
            self._refuse(key, str(error))
            if self._is_strict:
                raise
            return
        if isinstance(message, PageRefusal):
            self._event("refused", PAGE, readable(message.text))
            return
        stamped = message.model_copy(update={"t_ns": self._director.now_ns})
        if isinstance(stamped, Advisory) and not self.has_decision:
            self.has_decision = True
            self._modalities.set("decision", "on")
        self._router.heard(key, self._logged(stamped), UNREGISTERED)
        if isinstance(stamped, ActorCommand):
            self._obey(key.split("/")[1], stamped.command)
        elif isinstance(stamped, FromSeat):
            self._take_from_seat(key.split("/")[1], stamped)
        elif isinstance(stamped, SeatListening):
            self._listen(key.split("/")[1], stamped)
        elif isinstance(stamped, SeatConsent):
            self._consent(key.split("/")[1], stamped)
        elif isinstance(stamped, SeatPresence):
            self._occupy(key.split("/")[1], stamped.is_taken)
        elif isinstance(stamped, PaceCommand):
            self._set_pace(stamped.factor)
        elif isinstance(stamped, WorkloadAnswer):
            self._answer(key.split("/")[1], stamped)

    def _logged(self, message: Message) -> Message:
        """Return a message as the log is to have it."""
        if isinstance(message, MicrophoneAudio) and not self._keeps_voices:
            return message.model_copy(update={"pcm": b""})
        return message

    def _require_own(self, message: Message) -> None:
        """Complain about an advisory that says it is of a worker that takes grants.

        Raises
        ------
        WorkerError
            Its id begins with the name of one.
        """
        if not isinstance(message, Advisory):
            return
        for name in self._workers:
            if message.id.startswith(f"{name}-"):
                raise WorkerError(
                    f"a program published an advisory with the id {message.id!r}; expected an id "
                    f"of its own: this one belongs to worker {name!r}"
                )

    def _require_seat(self, key: str, message: Message) -> None:
        """Complain about what happens at a seat that is not a person's, or cannot be there.

        Raises
        ------
        WorkerError
            It is none.
        """
        known = ", ".join(sorted(self._seats)) or "none: there is no --seat"
        if isinstance(message, PaceCommand) and not self._seats:
            raise WorkerError(
                f"a program published on {key!r}, which is for the page of people at seats alone; "
                "expected a run with --seat"
            )
        if isinstance(message, PaceCommand) and not self._may_pause:
            raise WorkerError(
                f"a program published on {key!r}, but this run has no pause and no slow motion; "
                "expected a run without --no-pause"
            )
        if isinstance(message, ActorCommand) and key.split("/")[1] in self._units:
            raise WorkerError(
                f"a program published on {key!r}, the seat of a unit, which flies and drives "
                "nothing; expected the callsign of an aircraft or a vehicle"
            )
        if isinstance(message, AT_SEATS) and key.split("/")[1] not in self._seats:
            raise WorkerError(
                f"a program published on {key!r}, no seat of this run; expected {known}"
            )

    def _require_asked(self, key: str, message: Message) -> None:
        """Complain about an answer to what was not asked, or has an answer already.

        Raises
        ------
        WorkerError
            It is one.
        """
        if isinstance(message, WorkloadAnswer):
            number = message.question
            if not self._is_asked(key.split("/")[1], number):
                raise WorkerError(
                    f"a program published on {key!r} an answer to question {number}; expected the "
                    "number of a question that was asked there and has no answer yet"
                )

    def take_refused(self, key: str, cause: str) -> None:
        """Refuse what only a cause is known of, such as what an earlier run refused."""
        if key == PAGE:
            self._event("refused", PAGE, readable(cause))
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
            self._dropped[f"{keys}: {cause}"] = number
            message = DroppedMessages(
                t_ns=self._director.now_ns, keys=keys, cause=cause, messages=number
            )
            self._router.publish("truth/dropped", message)

    def dropped(self) -> dict[str, int]:
        """Return how many messages were dropped, by kind of key and cause; see `finish`."""
        return self._dropped

    def _note_first(self, key: str) -> None:
        """Tell once that such a program has published; a page that refuses takes no part."""
        if not self.heard and key != PAGE:
            self.heard = True
            self._event("unregistered", key, "a program that takes no grants has published")

    def _refuse(self, key: str, cause: str) -> None:
        cause = readable(cause)
        self._event("refused", readable(key), cause)
        if cause in self._refusals or len(self._refusals) > MOST_NOTICES:
            return
        self._refusals.add(cause)
        if len(self._refusals) > MOST_NOTICES:
            cause = "more was refused: the log has it all, as events of the kind refused"
        self._observer.notice(cause)


def _parse(key: str, data: bytes, now_ns: int) -> Message:
    """Return the message that a program put on a key.

    Raises
    ------
    WorkerError
        It is not what belongs there, or it is a voice.
    """
    if key.startswith("tts/"):
        raise WorkerError(
            "a program published on 'tts/*' without a grant; expected a voice that takes grants "
            "(docs/workers.md)"
        )
    family, _, rest = key.partition("/")
    kind = SeatPresence if family == "seat" else HEARD.get(f"{family}/*" if rest else key)
    if kind not in (ActorCommand, PaceCommand, PageRefusal, *AT_SEATS):
        return parse_output(UNREGISTERED, key, data, now_ns)
    try:
        return kind.model_validate_json(data)
    except ValidationError as error:
        raise WorkerError(
            f"a program published on {key!r} something that is no {kind.__name__}: "
            f"{first_problem(error)}; see `airhilt schema`"
        ) from None
