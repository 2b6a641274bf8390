"""Delivery of advisories to crews and drivers, and their reactions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

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
from airhilt.scenario.models import WildlifeSpec
from airhilt.seats import Seats
from airhilt.sim import Director
from airhilt.sim.payload import Payload
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


class AdvisoryDelivery:
    """Delivers advisories to actors, and schedules the reactions.

    An active advisory at or above a severity is spoken: its recipient gets it when the voice
    begins to be heard, or, on the recipients' frequencies, has been heard to the end. All others,
    and all in a run without a voice, are read as soon as they are published. So are alerts of
    equipment, which has a voice or a light of its own.

    While equipment tells a crew what to do, the crew does that, whatever the assistant says: a
    resolution advisory has priority (ICAO Doc 8168, volume III, section 4, 3.2). People at seats
    act as they like.
    """

    def __init__(
        self,
        director: Director,
        actors: Mapping[str, Actor],
        event: Callable[[EventKind, str, str], None],
        *,
        is_voiced: bool,
        speak_min_level: Severity = SPEAK_MIN_LEVEL,
        is_on_frequency: bool = False,
        seats: Seats,
    ) -> None:
        self._director = director
        self._event = event
        self._is_voiced = is_voiced or is_on_frequency
        self._speak_min_level = speak_min_level
        self._is_on_frequency = is_on_frequency
        self._seats = seats
        self._by_address = by_address(actors)
        self._unspoken: dict[tuple[str, str], Advisory] = {}
        """Latest revision of each advisory that waits for its voice, by id and recipient."""
        self._in_force: dict[str, set[str]] = {}
        """Ids of the alerts of equipment that tell a recipient what to do."""
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
                    self._unspoken[name] = message
                else:
                    self._unspoken.pop(name, None)
                    self._deliver(message)
            case AdvisoryAudio() if not self._is_on_frequency:
                self.heard(message.id, message.revision, message.recipient)
            case EquipmentAlert(advisory=advisory) if advisory.recipient in self._by_address:
                in_force = self._in_force.setdefault(advisory.recipient, set())
                in_force.discard(advisory.id)
                if advisory.active and advisory.recommendation is not None:
                    in_force.add(advisory.id)
                self._deliver(advisory, is_equipment=True)
            case SeatAction(act=LeaveSeat()):
                self._person_left(key.split("/")[1])

    def heard(self, identity: str, revision: int, recipient: str) -> None:
        """Deliver an advisory that its recipient has heard, unless a later revision waits."""
        waiting = self._unspoken.get((identity, recipient))
        if waiting is not None and waiting.revision == revision:
            del self._unspoken[identity, recipient]
            self._deliver(waiting)

    def voice_lost(self) -> None:
        """Deliver all advisories that wait for the voice, which is lost."""
        self._is_voiced = False
        waiting, self._unspoken = self._unspoken, {}
        for advisory in waiting.values():
            self._deliver(advisory)

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
        reaction = actor.hear(advisory, "ra" if is_equipment else "assistant")
        if reaction is None:
            return
        if not reaction.responds:
            self._tell_no_response(advisory, reaction, is_equipment)
        else:
            react = partial(self._react, actor, advisory, reaction, is_equipment)
            self._director.after(reaction.delay_s, react)

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
        if actor.body.ended is not None or self._seats.has_person(actor.spec.callsign):
            return
        if not self._counts(advisory, is_equipment):
            return
        try:
            if reaction.act():
                text = f"{reaction.text} ({advisory.id})"
                self._event("pilot_reacts", advisory.recipient, text)
        except Unable as unable:
            self._event("unable", advisory.recipient, str(unable))
