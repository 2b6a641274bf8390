"""The decision ladder of the AIRHILT paper (arXiv 2511.18718), for conflicts on runways."""

from __future__ import annotations

from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.guard import ConfidenceGuard
from airhilt.assistant.decision.paper_ladder import Ladder, PaperConfig
from airhilt.assistant.decision.runway import RunwayWatch
from airhilt.assistant.decision.threats import RunwayConfig
from airhilt.assistant.decision.visual_tracks import VisualTracks
from airhilt.engines import Engine
from airhilt.messages import AdsbReport, Briefing, Detections, Message, Transcript
from airhilt.units import SECOND_NS

AGAIN_NS = SECOND_NS
"""Time between two looks at an open conflict without news, in ns."""


class PaperEngine:
    """Implements `airhilt.assistant.decision.engine.DecisionEngine` by the paper's ladder.

    It perceives as the reference engine does: the same positions, visual tracks and clearances. It
    judges by the paper's rungs, again whenever anything arrives.
    """

    name = "paper"
    reads: tuple[type[Message], ...] = (Briefing, AdsbReport, Transcript, Detections)

    def __init__(self, configuration: PaperConfig | None = None) -> None:
        self.configuration = config = configuration or PaperConfig()
        self.visual_tracks = VisualTracks(config.sight)
        ladder = Ladder(config, self.visual_tracks)
        timing = RunwayConfig(
            persistence_s=0.0, release_s=config.release_s, recipients=config.recipients
        )
        self.runways = RunwayWatch(
            timing, self.visual_tracks, ConfidenceGuard(config.tau_asr), ladder.threats
        )

    def receive(self, received: ReceivedMessage) -> None:
        """Update positions, visual tracks and clearances with one message."""
        self.runways.take(received.message, received.t_ns)
        match received.message:
            case AdsbReport() as report:
                self.visual_tracks.take_report(report, received.t_ns)
            case Detections() as detections:
                self.visual_tracks.take_detections(detections, received.t_ns)
            case Briefing() as briefing:
                self.visual_tracks.take_briefing(briefing)

    def decide(self, t_ns: int) -> Decision:
        """Return the alerts that are new, have risen, or are over."""
        self.visual_tracks.forget(t_ns)
        alerts = self.runways.judge(t_ns)
        return Decision(alerts, again_ns=t_ns + AGAIN_NS if self.runways.has_conflict else None)


ENGINE = Engine(
    name="paper",
    summary="the decision ladder of the AIRHILT paper, for conflicts on runways",
    create=lambda _, configuration: PaperEngine(configuration),
    configuration=PaperConfig,
)
