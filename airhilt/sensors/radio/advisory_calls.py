"""Advisories that the assistant speaks on the frequency of who is to hear them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

from airhilt.audio.pcm import from_pcm
from airhilt.messages import (
    ADVISORY_CALL,
    ASSISTANT,
    Advisory,
    AdvisoryAudio,
    HearingTruth,
    Message,
    Severity,
)
from airhilt.phraseology.instruction_end import instruction_end
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.frequency_arbiter import FrequencyArbiter
from airhilt.sensors.radio.hearing import hearing_key
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sensors.radio.transmissions import Transmissions
from airhilt.sim.payload import Payload
from airhilt.units import SECOND_NS
from airhilt.world.actors.advisory_delivery import AdvisoryDelivery

PAUSE_S = 2.0
"""Pause in s after an advisory, in which others may speak: an assumption."""


class AdvisoryChannel(NamedTuple):
    """The use of the frequencies for advisories at or above a severity.

    Without a voice their words are transmitted as text. The delivery gets each advisory whose
    instruction its recipient has heard to the end.
    """

    is_voiced: bool
    speak_min_level: Severity
    delivery: AdvisoryDelivery


@dataclass(frozen=True, slots=True)
class _Waiting:
    """An advisory that is to be said."""

    advisory: Advisory
    frequency_khz: int
    text: str
    pcm: bytes
    instruction_part: float
    """Part of the duration after which the instruction has been said, in [0, 1]."""


class AdvisoryCalls:
    """Transmits advisories to crews and drivers, as a unit with a transmitter of its own would.

    On each frequency it says one at a time, the most urgent first. It waits for a free frequency
    like everybody else, and leaves a pause after each, in which others may speak. What is outdated
    when its turn comes is not said. Who is out of reach, or on whose receiver the call is blocked,
    does not hear it, and it is not repeated. The controller hears advisories from a loudspeaker.
    ``callsigns`` has the one of each actor by its callsign and by its 24-bit address.
    """

    def __init__(
        self,
        context: RadioContext,
        callsigns: Mapping[str, str],
        channel: AdvisoryChannel,
        arbiter: FrequencyArbiter,
        transmissions: Transmissions,
    ) -> None:
        self._context = context
        self._callsigns = callsigns
        self._channel = channel
        self._arbiter = arbiter
        self._transmissions = transmissions
        self._latest: dict[tuple[str, str], Advisory] = {}
        """The last revision of each advisory, by id and recipient."""
        self._waiting: dict[tuple[str, str], _Waiting] = {}
        """Advisories that wait for their turn, by id and recipient, in the order of arrival."""
        self._said: dict[str, _Waiting] = {}
        """Advisories on the air or about to be, by the ids of their transmissions."""
        self._heard: set[str] = set()
        """Transmissions whose recipient has heard the instruction."""

    def take(self, message: Message, payload: Payload) -> None:
        """Transmit an advisory, or the voice of one."""
        match message:
            case Advisory(recipient=recipient) if recipient in self._callsigns:
                name = (message.id, recipient)
                self._latest[name] = message
                self._waiting.pop(name, None)
                if not self._channel.is_voiced and self._is_said(message):
                    self._add(message, message.message)
            case AdvisoryAudio(id=identity, recipient=recipient):
                latest = self._latest.get((identity, recipient))
                if latest is not None and latest.revision == message.revision:
                    self._add(latest, message.text, message, bytes(payload))

    def began(self, on_air: OnAir) -> None:
        """Let the recipient of an advisory hear its instruction, if the transmission is one."""
        said = self._said.get(on_air.utterance.id)
        if said is None:
            return
        duration_s = (on_air.t_end_ns - on_air.t_tx_ns) / SECOND_NS
        is_heard = partial(self._hear, on_air, self._callsigns[said.advisory.recipient])
        self._channel.delivery.begin(said.advisory, said.instruction_part * duration_s, is_heard)

    def _hear(self, on_air: OnAir, actor: str) -> bool:
        """Return whether an actor has heard a transmission so far, and note it."""
        is_heard = self._transmissions.reaches(on_air, actor)
        if is_heard:
            self._heard.add(on_air.utterance.id)
        return is_heard

    def ended(self, on_air: OnAir) -> None:
        """Publish whether the recipient of an advisory has heard it, if it was one.

        Whoever has heard the instruction has heard it, whatever blocks the rest.
        """
        said = self._said.pop(on_air.utterance.id, None)
        if said is None:
            return
        context = self._context
        context.director.after(PAUSE_S, partial(self._next, said.frequency_khz))
        advisory = said.advisory
        actor = self._callsigns[advisory.recipient]
        is_heard = on_air.utterance.id in self._heard or self._transmissions.reaches(on_air, actor)
        truth = HearingTruth(
            t_ns=context.director.now_ns,
            id=on_air.utterance.id,
            actor=actor,
            outcome="understood" if is_heard else "missed",
            text=on_air.utterance.text if is_heard else "",
            source="ear",
        )
        context.publish(hearing_key(actor), truth)

    def _is_said(self, advisory: Advisory) -> bool:
        """Return whether an advisory is urgent enough to be said."""
        return advisory.active and advisory.severity.rank >= self._channel.speak_min_level.rank

    def _add(
        self, advisory: Advisory, text: str, audio: AdvisoryAudio | None = None, pcm: bytes = b""
    ) -> None:
        callsign = self._callsigns[advisory.recipient]
        frequency_khz = self._context.stations.frequency_of(callsign)
        if frequency_khz is not None:
            part = _instruction_part(advisory, callsign, text, audio)
            waiting = _Waiting(advisory, frequency_khz, text, pcm, part)
            self._waiting[advisory.id, advisory.recipient] = waiting
            self._next(frequency_khz)

    def _next(self, frequency_khz: int) -> None:
        """Say the most urgent advisory on a frequency, unless one is being said."""
        if any(said.frequency_khz == frequency_khz for said in self._said.values()):
            return
        there = [each for each in self._waiting.values() if each.frequency_khz == frequency_khz]
        if not there:
            return
        first = max(there, key=lambda each: each.advisory.severity.rank)
        advisory = first.advisory
        del self._waiting[advisory.id, advisory.recipient]
        name = f"{ADVISORY_CALL}{advisory.id}.{advisory.revision}.{advisory.recipient}"
        self._said[name] = first
        callsign = self._callsigns[advisory.recipient]
        speech = from_pcm(first.pcm) if first.pcm else None
        self._arbiter.say(
            Utterance(name, frequency_khz, ASSISTANT, callsign, first.text, speech=speech)
        )


def _instruction_part(
    advisory: Advisory, callsign: str, text: str, audio: AdvisoryAudio | None
) -> float:
    """Return the part of a call after which its instruction has been said, in [0, 1]."""
    names = {callsign, *advisory.traffic}
    end = instruction_end(text, advisory.recommendation, names, addressed=callsign)
    if audio is not None and audio.duration_s > 0.0:
        return min(1.0, audio.said_after_s(end) / audio.duration_s)
    return end / len(text) if text else 1.0
