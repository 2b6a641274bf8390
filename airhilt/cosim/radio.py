"""The radio of a run, and what the run says of radio failures."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from airhilt.cosim.events import EventPublisher
from airhilt.cosim.modalities import Modalities
from airhilt.cosim.observer import Observer
from airhilt.cosim.router import MessageRouter
from airhilt.cosim.setup import Setup
from airhilt.cosim.world_loop import WorldLoop
from airhilt.scenario.failures import EffectiveLine
from airhilt.seats import Seats
from airhilt.sensors.radio.advisory_calls import AdvisoryChannel
from airhilt.sensors.radio.backends import FallbackRadio
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.conversation import RadioConversation
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director, StepRecord
from airhilt.units import SECOND_NS


class RunRadio:
    """The radio sensor of a run: its conversation, connected with world, log and observer."""

    def __init__(
        self,
        director: Director,
        setup: Setup,
        world: WorldLoop,
        router: MessageRouter,
        event: EventPublisher,
        modalities: Modalities,
        observer: Observer,
        advisory_channel: AdvisoryChannel | None,
        stations: Stations,
        seats: Seats,
    ) -> None:
        radio = setup.scenario.radio
        self._backend = FallbackRadio(
            setup.sound,
            radio.words_per_minute,
            partial(modalities.lose, "radio", "radio_lost", "radio"),
        )
        context = RadioContext(
            director,
            setup.scenario,
            setup.lines,
            stations,
            self._backend,
            setup.options.seed,
            world,
            FailureNotices(director, world, event, modalities, observer, self._backend),
            router.publish,
            seats,
        )
        self._conversation = RadioConversation(context, advisory_channel)
        router.listen(self._conversation.take)

    def start(self) -> None:
        """Schedule the lines of the script, and the microphones that get stuck."""
        self._conversation.start()

    @property
    def has_sound(self) -> bool:
        """True unless the run has no speech, or has lost it."""
        return self._backend.has_sound

    def pause(self) -> None:
        """End the calls of people: nobody is on the air while the time stands still."""
        self._conversation.pause()

    def unfinished(self) -> Sequence[StepRecord]:
        """Return nothing: the radio has no latency of its own."""
        return ()

    def close(self) -> None:
        """End the transmissions that are on the air; the run ends."""
        self._conversation.close()


class FailureNotices:
    """Logs what the failures of a scenario do to the radio, and tells the user."""

    def __init__(
        self,
        director: Director,
        world: WorldLoop,
        event: EventPublisher,
        modalities: Modalities,
        observer: Observer,
        backend: FallbackRadio,
    ) -> None:
        self._director = director
        self._world = world
        self._event = event
        self._modalities = modalities
        self._observer = observer
        self._backend = backend

    def line_failed(self, line: EffectiveLine) -> None:
        """Log that a line is due which a failure changes."""
        self._world.affected |= line.affected
        self._world.uncleared |= line.uncleared
        for text in line.failures:
            self._event("failure", line.declared.id, text)

    def microphone_stuck(self, callsign: str, text: str) -> None:
        """Log that the microphone of an actor is stuck."""
        self._event("failure", callsign, text)
        self._modalities.set("radio", "lost", f"{callsign}: {text}")
        self._observer.notice(f"radio blocked at {self._now_s:.1f} s by {callsign}: {text}")

    def microphones_free(self) -> None:
        """Log that no microphone is stuck any more."""
        if not self._backend.is_lost:
            self._modalities.set("radio", "on")
        self._observer.notice(f"radio free again at {self._now_s:.1f} s")

    @property
    def _now_s(self) -> float:
        return self._director.now_ns / SECOND_NS
