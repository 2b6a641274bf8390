"""Delivery of advisories to crews and drivers, and their reactions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

from airhilt.messages import (
    SPEAK_MIN_LEVEL,
    Advisory,
    AdvisoryAudio,
    EquipmentAlert,
    EventKind,
    LeaveSeat,
    Message,
    SeatAction,
    Severity,
    key_chunk,
)
from airhilt.phraseology.instruction_end import instruction_end
from airhilt.scenario.models import WildlifeSpec
from airhilt.seats import Seats
from airhilt.sim import Director, Priority
from airhilt.sim.payload import Payload
from airhilt.units import seconds_to_ns
from airhilt.world.actors.actor import Actor, Reaction, Unable


def by_address(actors: Mapping[str, Actor]) -> dict[str, Actor]:
    """Return the actors by all names under which an advisory may reach them.

    A crew may be reached by its 24-bit address, before its callsign is known.
    """
    addresses = {
        actor.spec.icao24: actor
        for actor in actors.values()
        if not isinstance(actor.spec, WildlifeSpec)
    }
    return {**addresses, **actors}


class _Pending(NamedTuple):
    """A reaction that is not done yet."""

    due_ns: int
    reaction: Reaction


class AdvisoryDelivery:
    """Delivers advisories to actors, and schedules the reactions.

    An active advisory at or above a severity is spoken: its recipient gets it when the words of its
    instruction have been said to their end, in the cockpit or on the frequency. All others, and all
    in a run without a voice, are read as soon as they are displayed: reading takes no time of its
    own. So are alerts of equipment, because the standard pilot model counts from their display
    (ICAO Annex 10, volume IV, 4.4.2.6).

    What is heard is heard: an advisory that is revised while it is spoken is still delivered when
    its own instruction has been said, unless its end or a later revision came first. What is
    superseded before it was done is not done: the reaction to a later revision takes its place, and
    comes no sooner than the one to the first.

    While equipment tells a crew what to do, the crew does that, whatever the assistant says: a
    resolution advisory has priority (ICAO Doc 8168, volume III, section 4, 3.2). People at seats
    act as they like.
    """

    def __init__(
        self,
        director: Director,
        actors: Mapping[str, Actor],
        event: Callable[[EventKind, str, str], None],
        tell: Callable[[str, str], None],
        *,
        is_voiced: bool,
        speak_min_level: Severity = SPEAK_MIN_LEVEL,
        is_on_frequency: bool = False,
        seats: Seats,
    ) -> None:
        self._director = director
        self._event = event
        self._tell = tell
        self._is_voiced = is_voiced or is_on_frequency
        self._speak_min_level = speak_min_level
        self._is_on_frequency = is_on_frequency
        self._seats = seats
        self._by_address = by_address(actors)
        self._unheard: dict[tuple[str, str], dict[int, Advisory]] = {}
        """Advisories that wait for the end of their instruction, by id, recipient and revision."""
        self._speaking: set[tuple[str, str, int]] = set()
        """Advisories whose voice has begun."""
        self._in_force: dict[str, set[str]] = {}
        """Ids of the alerts of equipment that tell a recipient what to do."""
        self._pending: dict[tuple[str, str], _Pending] = {}
        """Reaction that is not done yet to the latest revision of each advisory that was got, by id
        and recipient."""
        self._not_responded: set[tuple[str, str]] = set()
        """Advisories of which was told that there is no response, by id and recipient."""
        self._told_people: dict[tuple[str, str], tuple[Advisory, bool]] = {}
        """Latest revision of each advisory in force that a person has got, by id and recipient,
        and true if it is of equipment."""

    def take(self, key: str, message: Message, data: Payload) -> None:  # noqa: ARG002
        """Receive a message of the bus."""
        match message:
            case Advisory() if message.recipient in self._by_address:
                name = (message.id, message.recipient)
                if self._is_spoken(message):
                    self._unheard.setdefault(name, {})[message.revision] = message
                else:
                    self._unheard.pop(name, None)
                    self._deliver(message)
            case AdvisoryAudio() if not self._is_on_frequency:
                self._begin_in_cockpit(message)
            case EquipmentAlert(advisory=advisory) if advisory.recipient in self._by_address:
                in_force = self._in_force.setdefault(advisory.recipient, set())
                in_force.discard(advisory.id)
                if advisory.active and advisory.recommendation is not None:
                    in_force.add(advisory.id)
                self._deliver(advisory, is_equipment=True)
            case SeatAction(act=LeaveSeat()):
                self._person_left(key.split("/")[1])

    def begin(
        self, advisory: Advisory, instruction_s: float, is_heard: Callable[[], bool] = lambda: True
    ) -> None:
        """Deliver an advisory that begins to be spoken, once its instruction has been said.

        Parameters
        ----------
        instruction_s
            Time from now to the end of the instruction, in s.
        is_heard
            Called then; returns whether the recipient has heard it.
        """
        name = (advisory.id, advisory.recipient, advisory.revision)
        self._speaking.add(name)

        def said() -> None:
            self._speaking.discard(name)
            if is_heard():
                self._heard(advisory)

        self._director.after(instruction_s, said)

    def _begin_in_cockpit(self, audio: AdvisoryAudio) -> None:
        """Let the recipient hear the voice of an advisory from its loudspeaker."""
        waiting = self._unheard.get((audio.id, audio.recipient), {})
        advisory = waiting.get(audio.revision)
        if advisory is not None:
            names = {advisory.recipient, *advisory.traffic}
            end = instruction_end(audio.text, advisory.recommendation, names)
            self.begin(advisory, audio.said_after_s(end))

    def _heard(self, advisory: Advisory) -> None:
        """Deliver an advisory that its recipient has heard, unless it got a later one."""
        waiting = self._unheard.get((advisory.id, advisory.recipient), {})
        if advisory.revision in waiting:
            for revision in [each for each in waiting if each <= advisory.revision]:
                del waiting[revision]
            self._deliver(advisory)

    def voice_lost(self) -> None:
        """Deliver all advisories that wait for a voice, which is lost; what is spoken goes on."""
        self._is_voiced = False
        for (identity, recipient), waiting in list(self._unheard.items()):
            latest = max(waiting, default=None)
            if latest is not None and (identity, recipient, latest) not in self._speaking:
                self._deliver(self._unheard.pop((identity, recipient))[latest])

    def _person_left(self, seat: str) -> None:
        """Deliver the advisories in force to an actor whose person has left its seat."""
        for name, (advisory, is_equipment) in list(self._told_people.items()):
            if key_chunk(self._by_address[advisory.recipient].spec.callsign) == seat:
                del self._told_people[name]
                self._deliver(advisory, is_equipment=is_equipment)

    def _is_spoken(self, advisory: Advisory) -> bool:
        is_urgent = advisory.severity.rank >= self._speak_min_level.rank
        return self._is_voiced and advisory.active and is_urgent

    def _deliver(self, advisory: Advisory, *, is_equipment: bool = False) -> None:
        actor = self._by_address[advisory.recipient]
        if self._seats.has_person(actor.spec.callsign):
            name = (advisory.id, advisory.recipient)
            self._told_people.pop(name, None)
            if advisory.active:
                self._told_people[name] = (advisory, is_equipment)
            return
        name = (advisory.id, advisory.recipient)
        earlier = self._pending.pop(name, None)
        reaction = actor.hear(advisory, "ra" if is_equipment else "assistant")
        if reaction is None:
            return
        if not reaction.responds:
            self._tell_no_response(advisory, reaction, is_equipment)
            return
        due_ns = self._director.now_ns + seconds_to_ns(reaction.delay_s)
        if earlier is not None and advisory.active:
            due_ns = max(due_ns, earlier.due_ns)
        self._pending[name] = _Pending(due_ns, reaction)
        react = partial(self._react, actor, advisory, reaction, is_equipment)
        self._director.at(due_ns, react, Priority.SCRIPT)

    def _tell_no_response(self, advisory: Advisory, reaction: Reaction, is_equipment: bool) -> None:
        """Tell once that an actor does not respond to an advisory."""
        name = (advisory.id, advisory.recipient)
        if name not in self._not_responded and self._counts(advisory, is_equipment):
            self._not_responded.add(name)
            self._event("no_response", advisory.recipient, f"{reaction.text} ({advisory.id})")

    def _counts(self, advisory: Advisory, is_equipment: bool) -> bool:
        """Return whether an advisory counts: equipment that tells what to do has priority."""
        return is_equipment or not (advisory.active and self._in_force.get(advisory.recipient))

    def _react(
        self, actor: Actor, advisory: Advisory, reaction: Reaction, is_equipment: bool
    ) -> None:
        name = (advisory.id, advisory.recipient)
        pending = self._pending.get(name)
        if pending is None or pending.reaction is not reaction:
            return  # It was superseded before it was done.
        del self._pending[name]
        if actor.body.ended is not None or self._seats.has_person(actor.spec.callsign):
            return
        if not self._counts(advisory, is_equipment):
            return
        tells = reaction.tells()
        try:
            if reaction.act():
                text = f"{reaction.text} ({advisory.id})"
                self._event("pilot_reacts", advisory.recipient, text)
                if tells:
                    self._tell(actor.spec.callsign, tells)
        except Unable as unable:
            self._event("unable", advisory.recipient, str(unable))
