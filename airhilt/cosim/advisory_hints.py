"""Notices to authors of workers about advisories on which nobody acts."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from airhilt.messages import UNREGISTERED, Advisory, Message
from airhilt.workers.hints import no_action
from airhilt.world.actors import Actor
from airhilt.world.actors.advisory_delivery import by_address


class AdvisoryHints:
    """Gives one notice for each worker that warns somebody who will not act.

    Parameters
    ----------
    exempt
        Names of workers that get no notice.
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
        self._settled = set(exempt)
        """Publishers that get no notice, or no further one."""
        self._notice = notice

    def take(self, publisher: str, message: Message) -> None:
        """Receive a message with the name of its publisher."""
        if not isinstance(message, Advisory) or publisher in self._settled:
            return
        actor = self._by_address.get(message.recipient)
        text = no_action(message, None if actor is None else actor.follows)
        if text is not None:
            self._settled.add(publisher)
            who = "a program" if publisher == UNREGISTERED else f"worker {publisher!r}"
            self._notice(f"{who}: {text}")
