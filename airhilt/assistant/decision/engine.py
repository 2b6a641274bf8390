"""The reference decision worker: what it senses goes to its watches, what they tell goes out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from airhilt.assistant.decision.fusion import FusionGate
from airhilt.assistant.decision.intruders import IntruderConfig, IntruderWatch
from airhilt.assistant.decision.runway import RunwayWatch
from airhilt.assistant.decision.separation import COASTING_NS, SeparationConfig, SeparationWatch
from airhilt.assistant.decision.threats import RunwayConfig
from airhilt.assistant.decision.visual_tracks import VisualTracks
from airhilt.messages import (
    AdsbReport,
    Advisory,
    Briefing,
    DeclaredLatency,
    Detections,
    InputSpec,
    Status,
    Transcript,
    Transmission,
    WorkerDescription,
)
from airhilt.sim.worker import Input, Output
from airhilt.workers.protocol import Step

GATE_INPUTS = (
    InputSpec(key="radio/*/tx", policy="batch"),
    InputSpec(key="status/*", policy="batch"),
)
"""What tells that a transcript is to come, or that none will."""


@dataclass(frozen=True)
class DecisionConfig:
    """Thresholds of the reference decision worker."""

    separation: SeparationConfig = field(default_factory=SeparationConfig)
    runways: RunwayConfig = field(default_factory=RunwayConfig)
    intruders: IntruderConfig = field(default_factory=IntruderConfig)
    is_gated: bool = False
    """The topology ``gated_fusion``: it tells nothing while a transcript is to come."""


class DecisionWorker:
    """Implements `airhilt.workers.Worker` for conflicts in the air and on runways.

    What cameras show goes to the lookout. It keeps what no transponder explains, and both the
    watch for intruders and the one for runways look at that.
    """

    def __init__(self, config: DecisionConfig | None = None, name: str = "decision") -> None:
        config = config or DecisionConfig()
        self.description = WorkerDescription(
            name=name,
            modality="decision",
            inputs=(
                InputSpec(key="briefing", policy="batch"),
                InputSpec(key="adsb/*", policy="batch"),
                InputSpec(key="asr/*", policy="batch"),
                InputSpec(key="vision/*", policy="batch"),
                *(GATE_INPUTS if config.is_gated else ()),
            ),
            latency=DeclaredLatency(median_s=0.15, sigma=0.3),
        )
        self.visual_tracks = VisualTracks()
        self.separation = SeparationWatch(config.separation, name)
        self.runways = RunwayWatch(config.runways, name, self.visual_tracks)
        self.intruders = IntruderWatch(
            config.intruders, name, self.visual_tracks, self.runways.runway_of_arrival
        )
        self._gate = FusionGate()
        self._withheld: list[Advisory] = []

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        """Take in reports and transcripts; tell what has changed."""
        advisories, self._withheld = self._withheld, []
        for item in inputs:
            advisories += self._take(t_ns, item)
        opens_ns = self._gate.opens_ns(t_ns)
        if opens_ns is not None:
            self._withheld = advisories
            return Step((), wake_ns=opens_ns)
        t_ready_ns = max((item.t_in_ns for item in inputs), default=t_ns)
        self.visual_tracks.forget(t_ns)
        watches = (self.separation, self.runways, self.intruders)
        for watch in watches:
            advisories += watch.judge(t_ns, t_ready_ns)
        return Step(
            tuple(
                Output(f"advisory/{advisory.recipient}", advisory.model_dump_json().encode())
                for advisory in advisories
            ),
            wake_ns=t_ns + COASTING_NS if any(watch.is_alert for watch in watches) else None,
        )

    def _take(self, t_ns: int, item: Input) -> list[Advisory]:
        """Take in one input; return what is to be told of it at once."""
        if item.key.startswith("adsb/"):
            report = AdsbReport.model_validate_json(item.payload)
            self.separation.take_report(report)
            self.runways.take_report(report)
            self.visual_tracks.take_report(report)
            return []
        if item.key.startswith("vision/"):
            self.visual_tracks.take_detections(Detections.model_validate_json(item.payload))
            return []
        if item.key == "briefing":
            briefing = Briefing.model_validate_json(item.payload)
            self.separation.take_briefing(briefing)
            self.runways.take_briefing(briefing)
            self.visual_tracks.take_briefing(briefing)
            return []
        if item.key.startswith("radio/"):
            self._gate.take_transmission(Transmission.model_validate(item.attachment))
            return []
        if item.key.startswith("status/"):
            self._gate.take_status(Status.model_validate_json(item.payload))
            return []
        transcript = Transcript.model_validate_json(item.payload)
        self._gate.take_transcript(transcript)
        self.runways.take_transcript(transcript)
        return self.separation.take_transcript(t_ns, item.t_in_ns, transcript)
