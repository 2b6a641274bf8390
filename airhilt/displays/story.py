"""The whole story of a run at once: tracks, calls and advisories."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import NamedTuple

from airhilt.messages import ActorTruth, Advisory, SpokenTruth
from airhilt.metrics.result import Result


class Told(NamedTuple):
    """An advisory in one revision, and when it was replaced or over, in ns."""

    advisory: Advisory
    until_ns: int


@dataclass(frozen=True)
class Story:
    """Tracks, calls and advisories of a whole run."""

    tracks: dict[str, list[ActorTruth]]
    """The true states of each actor."""
    calls: list[SpokenTruth]
    advisories: list[Told]
    end_ns: int
    """Time of the last message."""

    @classmethod
    def of(cls, run: Result) -> Story:
        """Read the story of a run; errors are those of `Result.messages`."""
        tracks: defaultdict[str, list[ActorTruth]] = defaultdict(list)
        calls, told = [], []
        active: dict[tuple[str, str], Advisory] = {}
        end_ns = 0
        for message in run.messages():
            match message:
                case ActorTruth():
                    tracks[message.actor].append(message)
                case SpokenTruth():
                    calls.append(message)
                case Advisory():
                    name = message.id, message.recipient
                    if earlier := active.pop(name, None):
                        told.append(Told(earlier, message.t_ns))
                    if message.active:
                        active[name] = message
            if not isinstance(message, dict):
                end_ns = max(end_ns, message.t_ns)
        told += [Told(advisory, end_ns) for advisory in active.values()]
        return cls(dict(tracks), calls, told, end_ns)

    def teller(self, names: tuple[str, ...]) -> str | None:
        """Return the first of these names that is an actor with a track."""
        return next((name for name in names if name in self.tracks), None)
