"""Data that a replay puts in the place of other processes and services."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from airhilt.messages import DroppedMessages, Event
from airhilt.record import Loss
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sim import LatencySpec
from airhilt.workers.pool import Participant


@dataclass(frozen=True)
class UnregisteredMessage:
    """A message that an unregistered program published in the earlier run."""

    key: str
    t_ns: int
    data: bytes


@dataclass(frozen=True)
class Recorded:
    """Parts of an earlier run that a replay takes from its record.

    Attributes
    ----------
    latency
        Replaces the latency source of the options.
    end_ns
        Time at which the earlier run broke off; None if it came to its end.
    sound
        Replaces voices and channel; None where those of the options speak again.
    workers
        Workers whose results come from the record.
    programs
        Names of the attached programs that took no grants.
    losses
        Losses of these programs, by name.
    unregistered
        Messages of unregistered programs.
    refused
        Events of messages that the earlier run refused: they have key and cause of each.
    stalls
        Events of stalls, in which the earlier run lost time.
    dropped
        Numbers of messages that the earlier run dropped.
    unavailable_reason
        Why no pictures could be drawn from the start; empty if they could.
    cameras_lost
        Time from which there were no more pictures (ns), and why.
    has_pictures
        True if there were pictures, even if no worker looks at them in the replay.
    """

    latency: LatencySpec | None = None
    end_ns: int | None = None
    sound: RadioBackend | None = None
    workers: tuple[Participant, ...] = ()
    programs: tuple[str, ...] = ()
    losses: Mapping[str, Loss] = field(default_factory=dict)
    unregistered: tuple[UnregisteredMessage, ...] = ()
    refused: tuple[Event, ...] = ()
    stalls: tuple[Event, ...] = ()
    dropped: tuple[DroppedMessages, ...] = ()
    unavailable_reason: str = ""
    cameras_lost: tuple[int, str] | None = None
    has_pictures: bool = False

    @property
    def is_replay(self) -> bool:
        """True if the run repeats an earlier one, whose latencies it then has."""
        return self.latency is not None
