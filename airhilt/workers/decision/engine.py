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
    Transcript,
    WorkerDescription,
)
from airhilt.sim.worker import Input, Output
from airhilt.workers.decision.runway import RunwayWatch
from airhilt.workers.decision.separation import (
    COASTING_NS,
    SeparationConfig,
    SeparationWatch,
)
from airhilt.workers.decision.threats import RunwayConfig
from airhilt.workers.protocol import Step


@dataclass(frozen=True)
class DecisionConfig:
    """Thresholds of the reference decision worker."""

    separation: SeparationConfig = field(default_factory=SeparationConfig)
    runways: RunwayConfig = field(default_factory=RunwayConfig)


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
            ),
            latency=DeclaredLatency(median_s=0.15, sigma=0.3),
        )
        self.separation = SeparationWatch(config.separation, name)
        self.runways = RunwayWatch(config.runways, name)

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        """Take in reports and transcripts; tell what has changed."""
        advisories: list[Advisory] = []
        for item in inputs:
            advisories += self._take(t_ns, item)
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
        transcript = Transcript.model_validate_json(item.payload)
        self.runways.take_transcript(transcript)
        return self.separation.take_transcript(t_ns, item.t_in_ns, transcript)
