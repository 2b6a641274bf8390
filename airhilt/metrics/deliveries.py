"""Deliveries to each decider before it decided, and what its warnings can rest on by them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from airhilt.messages import (
    ADVISORY_CALL,
    AdsbReport,
    Advisory,
    Detections,
    EnhancedTransmission,
    Message,
    PartialTranscript,
    RadarPlot,
    SpokenTruth,
    SurfaceTrack,
    TcasReply,
    Transcript,
    Transmission,
    TransmissionChunk,
    is_match,
)
from airhilt.sim import StepRecord

Kind = Literal["radio", "camera", "track"]
ADDRESS = re.compile(r"^[0-9a-f]{6}$")
"""Names of tracks that are those of transponders; others are a decider's own."""


@dataclass
class _Item:
    """Something that may be evidence: where and when it came first, and whom it concerns."""

    keys: dict[str, int] = field(default_factory=dict)
    """Time of the first message of it on each key, in ns."""
    concerns: set[str] = field(default_factory=set)


class Deliveries:
    """Messages that each decider had been given when the step began in which it decided.

    Parameters
    ----------
    deciders
        Patterns of the keys that each decider subscribes to, by its name. A program that decides
        without taking inputs by steps is on no such list: all that was published is its.
    callsigns
        Callsign of each actor by all its names.
    roster
        Callsigns that are known from the briefing; who is not on it can be known by sight alone.
    was_seen
        Whether a detection since a time in ns really showed an actor.
    """

    def __init__(
        self,
        deciders: Mapping[str, Sequence[str]],
        callsigns: Mapping[str, str],
        roster: Sequence[str],
        was_seen: Callable[[str, int], bool],
    ) -> None:
        self._deciders = deciders
        self._callsigns = callsigns
        self._roster = frozenset(roster)
        self._was_seen = was_seen
        self._items: dict[tuple[Kind, str], _Item] = {}
        self._nameless: dict[str, int] = {}
        """First messages of targets that do not say who they are: time in ns by key."""
        self._begun_ns: dict[str, int] = {}
        """Begin of the last step of each decider that has finished."""

    def step(self, record: StepRecord) -> None:
        """Note a finished step of a worker: what it had been given by its begin is in its hands."""
        if record.worker in self._deciders:
            self._begun_ns[record.worker] = record.t_start_ns

    def take(self, key: str, message: Message) -> None:
        """Note a message that may be evidence; the voice of an advisory is none."""
        if str(getattr(message, "id", "")).startswith(ADVISORY_CALL):
            return
        match message:
            case SpokenTruth(id=name):
                self._item("radio", name).concerns |= self._known(
                    message.speaker, message.addressed
                )
            case (
                Transmission() | EnhancedTransmission() | TransmissionChunk() | PartialTranscript()
            ):
                self._add(key, message, "radio", message.id)
            case Transcript(id=name):
                self._add(key, message, "radio", name, message.speaker, message.addressee)
            case Detections(camera=name, missed=""):
                self._add(key, message, "camera", name)
            case AdsbReport(icao24=str(name)) | TcasReply(icao24=str(name)):
                self._add(key, message, "track", name, name)
            case SurfaceTrack(icao24=str(name)):
                self._add(key, message, "track", name, name)
            case RadarPlot() | SurfaceTrack() | TcasReply():
                self._nameless.setdefault(key, message.t_ns)

    def unfounded(self, advisory: Advisory) -> tuple[str, ...]:
        """Return the names that an advisory rests on and cannot: unknown, later, or of others."""
        evidence, had = advisory.evidence, self._had(advisory)
        named = self._known(*advisory.traffic)
        cited: Iterator[tuple[Kind, str]] = (
            *(("radio", name) for name in evidence.radio_ids),
            *(("camera", name) for name in evidence.camera_ids),
            *(("track", name) for name in evidence.tracks if ADDRESS.match(name)),
        )  # type: ignore[assignment]  # a tuple of pairs
        return tuple(
            name
            for kind, name in cited
            if (item := self._items.get((kind, name))) is None
            or not had(item.keys)
            or (item.concerns and not item.concerns & named)
        )

    def is_founded(self, advisory: Advisory, actors: Sequence[str]) -> bool:
        """Return whether an advisory can be a warning of actors by what its decider had been given.

        Something of each of them on the roster had reached it, and what it cites is not all
        unfounded. A target without a name may be one of them, if that of the other is known.
        """
        evidence, had = advisory.evidence, self._had(advisory)
        cited = {*evidence.radio_ids, *evidence.camera_ids, *filter(ADDRESS.match, evidence.tracks)}
        if cited and cited == set(self.unfounded(advisory)):
            return False
        given = [(kind, item) for (kind, _), item in self._items.items() if had(item.keys)]
        is_watched = any(kind == "camera" for kind, _ in given)
        unknown = [
            actor
            for actor in self._roster.intersection(actors)
            if not any(actor in item.concerns for _, item in given)
            and not (is_watched and self._was_seen(actor, 0))
        ]
        return not unknown or (len(unknown) == 1 and had(self._nameless))

    def _had(self, advisory: Advisory) -> Callable[[Mapping[str, int]], bool]:
        """Return what tells whether the decider of an advisory had one of some first messages."""
        name = next((each for each in self._deciders if advisory.id.startswith(f"{each}-")), None)
        if name is None:
            return lambda keys: any(t_ns <= advisory.t_ns for t_ns in keys.values())
        begun_ns, patterns = self._begun_ns.get(name, -1), self._deciders[name]
        return lambda keys: any(
            t_ns <= begun_ns and any(is_match(key, pattern) for pattern in patterns)
            for key, t_ns in keys.items()
        )

    def _known(self, *names: str | None) -> set[str]:
        return {self._callsigns[name] for name in names if name and name in self._callsigns}

    def _item(self, kind: Kind, name: str) -> _Item:
        return self._items.setdefault((kind, name), _Item())

    def _add(self, key: str, message: Message, kind: Kind, name: str, *who: str | None) -> None:
        item = self._item(kind, name)
        item.keys.setdefault(key, message.t_ns)
        item.concerns |= self._known(*who)
