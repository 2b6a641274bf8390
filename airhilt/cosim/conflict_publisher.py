"""Conflicts, collisions and incursions of actors, published as they happen."""

from __future__ import annotations

from collections.abc import Mapping

from airhilt.cosim.events import EventPublisher
from airhilt.cosim.router import MessageRouter
from airhilt.messages import ConflictPhase, ConflictTruth
from airhilt.sim import Director
from airhilt.world.actors import Actor
from airhilt.world.truth.conflicts import Pair
from airhilt.world.truth.runways import Incursion, RunwayMonitor


class ConflictPublisher:
    """Publishes what becomes true of pairs of actors; whatever collides, ends."""

    def __init__(
        self,
        director: Director,
        actors: Mapping[str, Actor],
        router: MessageRouter,
        event: EventPublisher,
        runways: RunwayMonitor | None,
    ) -> None:
        self._director = director
        self._actors = actors
        self._router = router
        self._event = event
        self._runways = runways

    def became_true(
        self, phase: ConflictPhase, pair: Pair, horizontal_m: float, vertical_m: float
    ) -> None:
        """Publish what became true of a pair; whatever collides, ends."""
        if all(self._actors[callsign].category == "wildlife" for callsign in pair):
            return  # A herd.
        self._router.publish(
            "truth/conflict",
            ConflictTruth(
                t_ns=self._director.now_ns,
                phase=phase,
                actors=pair,
                horizontal_m=horizontal_m,
                vertical_m=vertical_m,
            ),
        )
        if phase != "collision":
            return
        if self._runways is not None:
            self._runways.collided(*pair)
        for callsign, other in (pair, pair[::-1]):
            actor, struck = self._actors[callsign], self._actors[other]
            if struck.category == "wildlife" and not struck.body.on_ground:
                continue  # An aircraft flies on after a bird strike.
            actor.body.ended = f"collision with {other}"
            tell_end(self._event, actor)


def tell_end(event: EventPublisher, actor: Actor) -> None:
    """Publish that an actor has ended."""
    event("actor_ended", actor.spec.callsign, actor.body.ended or "")


def publish_incursion(director: Director, router: MessageRouter, incursion: Incursion) -> None:
    """Publish an incursion of a runway."""
    actors = (incursion.user, incursion.intruder)
    closest = incursion.closest
    router.publish(
        "truth/conflict",
        ConflictTruth(
            t_ns=director.now_ns,
            phase="runway_incursion",
            actors=tuple(actor for actor in actors if actor is not None),
            horizontal_m=closest.horizontal_m if closest else None,
            vertical_m=closest.vertical_m if closest else None,
            runway=incursion.runway.replace("/", "-"),
        ),
    )
