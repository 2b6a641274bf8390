"""The reference decision worker: what it hears goes to its watches, and what they tell goes out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from airhilt.messages import (
    AdsbReport,
    Advisory,
    Briefing,
    DeclaredLatency,
    InputSpec,
    Status,
    Transcript,
    Transmission,
    WorkerDescription,
)
from airhilt.sim.worker import Input, Output
from airhilt.workers.decision.fusion import FusionGate
from airhilt.workers.decision.runway import RunwayWatch
from airhilt.workers.decision.separation import (
    COASTING_NS,
    SeparationConfig,
    SeparationWatch,
)
from airhilt.workers.decision.threats import RunwayConfig
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
    is_gated: bool = False
    """The topology ``gated_fusion``: it tells nothing while a transcript is to come."""


class DecisionWorker:
    """Implements `airhilt.workers.Worker` for conflicts in the air and on runways."""

    def __init__(self, config: DecisionConfig | None = None, name: str = "decision") -> None:
        config = config or DecisionConfig()
        self.description = WorkerDescription(
            name=name,
            modality="decision",
            inputs=(
                InputSpec(key="briefing", policy="batch"),
                InputSpec(key="adsb/*", policy="batch"),
                InputSpec(key="asr/*", policy="batch"),
                *(GATE_INPUTS if config.is_gated else ()),
            ),
            latency=DeclaredLatency(median_s=0.15, sigma=0.3),
        )
        self.separation = SeparationWatch(config.separation, name)
        self.runways = RunwayWatch(config.runways, name)
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
        advisories += self.separation.judge(t_ns, t_ready_ns)
        advisories += self.runways.judge(t_ns, t_ready_ns)
        is_alert = self.separation.is_alert or self.runways.is_alert
        return Step(
            tuple(
                Output(f"advisory/{advisory.recipient}", advisory.model_dump_json().encode())
                for advisory in advisories
            ),
            wake_ns=t_ns + COASTING_NS if is_alert else None,
        )

    def _take(self, t_ns: int, item: Input) -> list[Advisory]:
        """Take in one input; return what is to be told of it at once."""
        if item.key.startswith("adsb/"):
            report = AdsbReport.model_validate_json(item.payload)
            self.separation.take_report(report)
            self.runways.take_report(report)
            return []
        if item.key == "briefing":
            briefing = Briefing.model_validate_json(item.payload)
            self.separation.take_briefing(briefing)
            self.runways.take_briefing(briefing)
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
