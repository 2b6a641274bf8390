"""Programs of other processes that publish by themselves: they take no grants."""

from __future__ import annotations

from collections.abc import Callable, Collection

from pydantic import ValidationError

from airhilt.bus.session import Bus
from airhilt.commands import Command
from airhilt.cosim.events import EventPublisher
from airhilt.cosim.modalities import Modalities
from airhilt.cosim.observer import Observer
from airhilt.cosim.router import MessageRouter
from airhilt.errors import WorkerError, first_problem
from airhilt.messages import UNREGISTERED, ActorCommand, Advisory, Message
from airhilt.sim import Director, RealTime, Virtual
from airhilt.workers.pool import parse_output

PATTERNS = ("advisory/*", "asr/*", "asr/*/partial", "vision/*", "command/*", "tts/*")
"""Keys that are heard; what comes on the last is refused, for a voice needs grants."""


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
        self._workers = workers
        self._is_strict = is_strict

    def serve(self, bus: Bus) -> None:
        """Hear what programs put on the bus, and what of it does not count."""
        bus.hear_refusals(
            lambda refusal: self._director.post(
                lambda: self.take_refused(refusal.key, refusal.cause)
            )
        )
        for pattern in PATTERNS:
            bus.hear(
                pattern,
                lambda key, data: self._director.post(lambda: self._hear(key, data)),
            )

    def _hear(self, key: str, data: bytes) -> None:
        """Take a message from the bus; a program that takes no grants needs real time."""
        if isinstance(self._director.pace, Virtual):
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
        except WorkerError as error:
            self._refuse(key, str(error))
            if self._is_strict:
                raise
            return
        stamped = message.model_copy(update={"t_ns": self._director.now_ns})
        if isinstance(stamped, Advisory) and not self.has_decision:
            self.has_decision = True
            self._modalities.set("decision", "on")
        self._router.heard(key, stamped, UNREGISTERED)
        if isinstance(stamped, ActorCommand):
            self._obey(key.split("/")[1], stamped.command)

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

    def take_refused(self, key: str, cause: str) -> None:
        """Refuse what only a cause is known of, such as what an earlier run refused."""
        self._note_first(key)
        self._refuse(key, cause)

    def _note_first(self, key: str) -> None:
        """Tell once that such a program has published."""
        if not self.heard:
            self.heard = True
            self._event("unregistered", key, "a program that takes no grants has published")

    def _refuse(self, key: str, cause: str) -> None:
        self._event("refused", key, cause)
        if cause not in self._refusals:
            self._refusals.add(cause)
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
    if not key.startswith("command/"):
        return parse_output(UNREGISTERED, key, data, now_ns)
    try:
        return ActorCommand.model_validate_json(data)
    except ValidationError as error:
        raise WorkerError(
            f"a program published on {key!r} something that is no ActorCommand: "
            f"{first_problem(error)}; see `airhilt schema`"
        ) from None
