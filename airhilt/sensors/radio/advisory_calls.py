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
from airhilt.sensors.base import Publish
from airhilt.sensors.radio.hearing import hearing_key
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sensors.radio.stations import Stations
from airhilt.sensors.radio.transmissions import Transmissions
from airhilt.sim import Director, Priority
from airhilt.sim.payload import Payload
from airhilt.units import seconds_to_ns
from airhilt.world.actors.advisory_delivery import AdvisoryDelivery

PAUSE_S = 2.0
"""Pause in s after an advisory, in which others may speak: an assumption."""


class Spoken(NamedTuple):
    """One revision of an advisory, for one recipient."""

    id: str
    revision: int
    recipient: str


class AdvisoryChannel(NamedTuple):
    """The use of the frequencies for advisories.

    Attributes
    ----------
    is_voiced
        True if a worker speaks advisories; otherwise their words are transmitted as text.
    speak_min_level
        Least severity that is said.
    delivery
        Gets each advisory that its recipient has heard to the end.
    """

    is_voiced: bool
    speak_min_level: Severity
    delivery: AdvisoryDelivery


@dataclass(frozen=True, slots=True)
class _Waiting:
    """An advisory that is to be said."""

    spoken: Spoken
    severity: Severity
    frequency_khz: int
    text: str
    pcm: bytes


class AdvisoryCalls:
    """Transmits advisories to crews and drivers, as a unit with a transmitter of its own would.

    On each frequency it says one at a time, the most urgent first. It waits for a free frequency
    like everybody else, and leaves a pause after each, in which others may speak. What is outdated
    when its turn comes is not said. Who is out of reach, or on whose receiver the call is blocked,
    does not hear it, and it is not repeated. The controller hears advisories from a loudspeaker.

    Parameters
    ----------
    callsigns
        Callsign of each actor by its callsign and by its 24-bit address.
    """

    def __init__(
        self,
        director: Director,
        stations: Stations,
        callsigns: Mapping[str, str],
        channel: AdvisoryChannel,
        transmissions: Transmissions,
        publish: Publish,
    ) -> None:
        self._director = director
        self._stations = stations
        self._callsigns = callsigns
        self._is_voiced = channel.is_voiced
        self._speak_min_level = channel.speak_min_level
        self._delivery = channel.delivery
        self._transmissions = transmissions
        self._publish = publish
        self._latest: dict[tuple[str, str], Advisory] = {}
        """The last revision of each advisory, by id and recipient."""
        self._waiting: dict[tuple[str, str], _Waiting] = {}
        """Advisories that wait for their turn, by id and recipient, in the order of arrival."""
        self._said: dict[str, _Waiting] = {}
        """Advisories on the air or about to be, by the ids of their transmissions."""

    def take(self, message: Message, payload: Payload) -> None:
        """Transmit an advisory, or the voice of one."""
        match message:
            case Advisory(recipient=recipient) if recipient in self._callsigns:
                name = (message.id, recipient)
                self._latest[name] = message
                self._waiting.pop(name, None)
                if not self._is_voiced and self._is_said(message):
                    self._add(message, message.message, b"")
            case AdvisoryAudio(id=identity, recipient=recipient):
                latest = self._latest.get((identity, recipient))
                if latest is not None and latest.revision == message.revision:
                    self._add(latest, message.text, bytes(payload))

    def ended(self, on_air: OnAir) -> None:
        """Let the recipient of an advisory hear it, if the transmission was one and reaches it."""
        said = self._said.pop(on_air.utterance.id, None)
        if said is None:
            return
        after_ns = self._director.now_ns + seconds_to_ns(PAUSE_S)
        self._director.at(after_ns, partial(self._next, said.frequency_khz), Priority.SCRIPT)
        actor = self._callsigns[said.spoken.recipient]
        is_heard = self._transmissions.reaches(on_air, actor)
        truth = HearingTruth(
            t_ns=self._director.now_ns,
            id=on_air.utterance.id,
            actor=actor,
            outcome="understood" if is_heard else "missed",
            text=on_air.utterance.text if is_heard else "",
            source="ear",
        )
        self._publish(hearing_key(actor), truth)
        if is_heard:
            self._delivery.heard(*said.spoken)

    def _is_said(self, advisory: Advisory) -> bool:
        """Return whether an advisory is urgent enough to be said."""
        return advisory.active and advisory.severity.rank >= self._speak_min_level.rank

    def _add(self, advisory: Advisory, text: str, pcm: bytes) -> None:
        frequency_khz = self._stations.frequency_of(self._callsigns[advisory.recipient])
        if frequency_khz is None:
            return
        spoken = Spoken(advisory.id, advisory.revision, advisory.recipient)
        waiting = _Waiting(spoken, advisory.severity, frequency_khz, text, pcm)
        self._waiting[advisory.id, advisory.recipient] = waiting
        self._next(frequency_khz)

    def _next(self, frequency_khz: int) -> None:
        """Say the most urgent advisory on a frequency, unless one is being said."""
        if any(said.frequency_khz == frequency_khz for said in self._said.values()):
            return
        there = [each for each in self._waiting.values() if each.frequency_khz == frequency_khz]
        if not there:
            return
        first = max(there, key=lambda each: each.severity.rank)
        spoken = first.spoken
        del self._waiting[spoken.id, spoken.recipient]
        name = f"{ADVISORY_CALL}{spoken.id}.{spoken.revision}.{spoken.recipient}"
        self._said[name] = first
        callsign = self._callsigns[spoken.recipient]
        speech = from_pcm(first.pcm) if first.pcm else None
        self._transmissions.say(
            Utterance(name, frequency_khz, ASSISTANT, callsign, first.text, speech=speech)
        )
