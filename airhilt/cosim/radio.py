"""The radio of a run, and what the run says of radio failures."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import partial

from airhilt.commands import Command
from airhilt.cosim.events import EventPublisher
from airhilt.cosim.modalities import Modalities
from airhilt.cosim.observer import Observer
from airhilt.cosim.router import MessageRouter
from airhilt.cosim.setup import Setup
from airhilt.cosim.world_loop import WorldLoop
from airhilt.messages import SeatInfo, Severity
from airhilt.scenario.failures import EffectiveLine
from airhilt.sensors.radio.advisory_calls import AdvisoryChannel
from airhilt.sensors.radio.backends import FallbackRadio
from airhilt.sensors.radio.conversation import FromSeat, RadioConversation
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
        seats: Collection[str],
    ) -> None:
        radio = setup.scenario.radio
        self._director = director
        self._world = world
        self._event = event
        self._modalities = modalities
        self._observer = observer
        self._backend = FallbackRadio(
            setup.sound,
            radio.words_per_minute,
            partial(modalities.lose, "radio", "radio_lost", "radio"),
        )
        self._conversation = RadioConversation(
            director,
            setup.scenario,
            setup.lines,
            Stations(setup.actors, setup.site, radio.lines),
            self._backend,
            setup.options.seed,
            world.ended_lines,
            line_begun=world.line_begun,
            once=world.once,
            publish=router.publish,
            do=world.do,
            failed=self._line_failed,
            microphone_stuck=self._microphone_stuck,
            microphones_free=self._microphones_free,
            advisory_channel=advisory_channel,
            seats=seats,
        )
        router.listen(self._conversation.take)

    def start(self) -> None:
        """Schedule the lines of the script, and the microphones that get stuck."""
        self._conversation.start()

    def take_from_seat(self, seat: str, message: FromSeat) -> None:
        """Take what the person at a seat says, typed or spoken."""
        self._conversation.take_from_seat(seat, message)

    def listen(self, seat: str, frequencies_khz: Collection[int]) -> bool:
        """Take in what the person at a seat listens to; return true if that has changed."""
        return self._conversation.listen(seat, frequencies_khz)

    def occupy(self, seat: str, is_taken: bool) -> None:
        """Take in that a person has taken a seat or left it."""
        self._conversation.occupy(seat, is_taken=is_taken)

    def commanded(self, actor: str, command: Command) -> None:
        """Take in that an actor carries out a command that somebody has given it."""
        self._conversation.commanded(actor, command)

    def has_person(self, name: str) -> bool:
        """Return whether a person speaks and acts for a unit or an actor, and nobody else."""
        return self._conversation.has_person(name)

    def pause(self, is_paused: bool) -> None:
        """Take in that the time stands still, or passes again."""
        self._conversation.pause(is_paused)

    def infos(
        self,
        *,
        is_recognised: bool,
        voice_is_recorded: bool,
        may_pause: bool,
        spoken_from: Severity | None,
    ) -> list[SeatInfo]:
        """Return what the persons at the seats have to know."""
        return self._conversation.infos(
            is_recognised=is_recognised,
            voice_is_recorded=voice_is_recorded,
            may_pause=may_pause,
            spoken_from=spoken_from,
        )

    def unfinished(self) -> Sequence[StepRecord]:
        """Return nothing: the radio has no latency of its own."""
        return ()

    def close(self) -> None:
        """End the transmissions that are on the air; the run ends."""
        self._conversation.close()

    def _line_failed(self, line: EffectiveLine) -> None:
        self._world.affected |= line.affected
        self._world.uncleared |= line.uncleared
        for text in line.failures:
            self._event("failure", line.declared.id, text)

    def _microphone_stuck(self, callsign: str, text: str) -> None:
        self._event("failure", callsign, text)
        self._modalities.set("radio", "lost", f"{callsign}: {text}")
        self._observer.notice(f"radio blocked at {self._now_s:.1f} s by {callsign}: {text}")

    def _microphones_free(self) -> None:
        if not self._backend.is_lost:
            self._modalities.set("radio", "on")
        self._observer.notice(f"radio free again at {self._now_s:.1f} s")

    @property
    def _now_s(self) -> float:
        return self._director.now_ns / SECOND_NS
