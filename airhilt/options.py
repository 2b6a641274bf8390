"""How a run is asked for: the options of a person, and what a replay puts in their place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from airhilt.assistant.reference import ASR, DETECTOR, TTS, AssistantName
from airhilt.record import Loss
from airhilt.scenario.models import Topology
from airhilt.sensors.cameras import AUTO
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sim import LatencySpec
from airhilt.workers.pool import Participant


@dataclass(frozen=True)
class Options:
    """How a scenario is run. The defaults are those of the command line."""

    seed: int = 0
    out: Path | None = None
    overwrite: bool = False
    assistant: AssistantName | None = None
    """None: ``reference``, or ``external`` where one of the attached programs may decide."""
    pace: str | None = None
    """None: ``virtual``, or ``realtime`` where an attached program takes no grants."""
    latency: str = "measured"
    cameras: bool = True
    speech: bool = True
    strict: bool = False
    listen: str | None = None
    attach: tuple[str, ...] = ()
    attach_timeout_s: float = 60.0
    step_timeout_s: float = 5.0
    run_name: str | None = None
    snr_db: float | None = None
    """None: that of the scenario."""
    radio_profile: str | None = None
    """None: that of the scenario."""
    topology: Topology | None = None
    """None: that of the scenario."""
    asr: str = ASR
    """Engine, as in the command line."""
    tts: str = TTS
    """Engine, as in the command line."""
    renderer: str = AUTO
    """Name of what draws the pictures of cameras."""
    detector: str = DETECTOR
    """Engine, as in the command line."""
    video: bool = False
    """Whether to write what each camera saw as a video."""


@dataclass(frozen=True)
class UnregisteredMessage:
    """A message that an unregistered program published in an earlier run."""

    key: str
    t_ns: int
    data: bytes


@dataclass(frozen=True)
class Recorded:
    """What a replay puts in the place of other processes."""

    latency: LatencySpec | None = None
    """Instead of that of the options."""
    end_ns: int | None = None
    """Where the earlier run broke off."""
    sound: RadioBackend | None = None
    """Instead of voices and channel; None where those of the options speak again."""
    workers: tuple[Participant, ...] = ()
    programs: tuple[str, ...] = ()
    """Names of those that took no grants."""
    losses: Mapping[str, Loss] = field(default_factory=dict)
    foreign: tuple[UnregisteredMessage, ...] = ()
    unavailable_reason: str = ""
    """Why no pictures could be drawn from the start."""
    cameras_lost: tuple[int, str] | None = None
    """When there were no more pictures (ns), and why."""
    has_pictures: bool = False
    """Whether there were any, which nobody of this run may look at."""
