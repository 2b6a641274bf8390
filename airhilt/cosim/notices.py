"""Notices for the user and for people at seats of what they would not see otherwise."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from airhilt.cosim.context import RunContext
from airhilt.cosim.world_loop import WorldLoop
from airhilt.messages import (
    UNREGISTERED,
    Advisory,
    AgreeToUses,
    Event,
    LeaveSeat,
    Message,
    ModelExchange,
    SeatAct,
    SeatAction,
    SeatState,
    TakeSeat,
    TuneFrequencies,
)
from airhilt.scenario.failures import EffectiveLine
from airhilt.seats import Seats
from airhilt.sensors.radio.backends import FallbackRadio
from airhilt.sim.payload import Payload
from airhilt.workers.checker import no_action
from airhilt.world.actors import Actor
from airhilt.world.actors.advisory_delivery import by_address


class WorkerNotices:
    """Gives one notice of each kind for each worker; the log has all that they are about.

    They are of the first advisory on which nobody acts, and of the first answer of a language model
    that is missing or rejected.

    Parameters
    ----------
    exempt
        Names of workers whose advisories need no notice.
    notice
        Called with the text of a notice.
    """

    def __init__(
        self,
        actors: Mapping[str, Actor],
        exempt: Collection[str],
        notice: Callable[[str], None],
    ) -> None:
        self._by_address = by_address(actors)
        self._exempt = exempt
        self._notice = notice
        self._told: set[tuple[str, str]] = set()

    def take(self, publisher: str, message: Message) -> None:
        """Receive a message with the name of its publisher."""
        match message:
            case Advisory() if publisher not in self._exempt:
                actor = self._by_address.get(message.recipient)
                if text := no_action(message, None if actor is None else actor.follows):
                    self._tell(publisher, "advisory", text)
            case ModelExchange(failure=failure) if failure:
                text = f"{failure}; the rules do without it; see llm/{publisher} in log.mcap"
                self._tell(publisher, "failure", text)
            case ModelExchange(rejections=(first, *_)):
                text = (
                    f"{first.subject}: {first.answered!r} is refused: {first.reason}; the rules "
                    f"stand; see llm/{publisher} in log.mcap"
                )
                self._tell(publisher, "rejection", text)

    def _tell(self, publisher: str, kind: str, text: str) -> None:
        if (publisher, kind) not in self._told:
            self._told.add((publisher, kind))
            who = "a program" if publisher == UNREGISTERED else f"worker {publisher!r}"
            self._notice(f"{who}: {text}")


class RadioNotices:
    """Logs what the failures of a scenario do to the radio, and tells the user."""

    def __init__(self, context: RunContext, world: WorldLoop, backend: FallbackRadio) -> None:
        self._context = context
        self._world = world
        self._backend = backend

    def line_failed(self, line: EffectiveLine) -> None:
        """Log that a line is due which a failure changes."""
        self._world.affected |= line.affected
        self._world.uncleared |= line.uncleared
        for text in line.failures:
            self._context.event("failure", line.declared.id, text)

    def microphone_stuck(self, callsign: str, text: str) -> None:
        """Log that the microphone of an actor is stuck."""
        self._context.event("failure", callsign, text)
        self._context.set_modality("radio", "lost", f"{callsign}: {text}")
        at = f"at {self._context.now_s:.1f} s"
        self._context.observer.notice(f"radio blocked {at} by {callsign}: {text}")

    def microphones_free(self) -> None:
        """Log that no microphone is stuck any more."""
        if not self._backend.is_lost:
            self._context.set_modality("radio", "on")
        self._context.observer.notice(f"radio free again at {self._context.now_s:.1f} s")


class SeatNotices:
    """Logs what changes at seats, and tells a person that a command cannot be done."""

    def __init__(self, context: RunContext, seats: Seats) -> None:
        self._context = context
        self._seats = seats

    def take(self, key: str, message: Message, data: Payload) -> None:  # noqa: ARG002
        """Receive a message of the run."""
        if isinstance(message, Event) and message.kind == "unable":
            why = message.text.removeprefix("unable").lstrip(" ,:")
            self._seats.notify(message.subject, f"Unable: {why}")
        if not isinstance(message, SeatAction) or (state := self._seats.at(key)) is None:
            return
        if text := _text_of(message.act, state):
            self._context.event("seat", state.seat, text)
        if isinstance(message.act, LeaveSeat) and not self._context.is_replay:
            self._context.observer.notice(
                f"seat {state.seat}: its person has left, and its script goes on"
            )


def _text_of(act: SeatAct, state: SeatState) -> str:
    """Return what an act changes at a seat, in words; empty if nothing."""
    match act:
        case TakeSeat():
            return "a person has it"
        case LeaveSeat():
            return "nobody is there: its script goes on"
        case AgreeToUses(uses=uses) if "voice" in uses:
            kept = "is" if state.voice_is_recorded else "is not"
            return f"agrees to speak and type; the voice {kept} recorded"
        case AgreeToUses(uses=uses):
            return "agrees to type; the words are recorded" if uses else "agrees to nothing"
        case TuneFrequencies(frequencies_khz=tuned):
            listed = [f"{khz / 1000:.3f} MHz" for khz in sorted(tuned)]
            return f"listens to {' and '.join(listed) or 'no frequency'}"
    return ""
