"""The reference engine: three watches, for the air, the runways, and what only cameras see."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from pydantic import Field

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.guard import ConfidenceGuard
from airhilt.assistant.decision.input_checks import InputChecks
from airhilt.assistant.decision.intruders import IntruderConfig, IntruderWatch
from airhilt.assistant.decision.loss_prediction import SeparationConfig
from airhilt.assistant.decision.runway import RunwayWatch
from airhilt.assistant.decision.separation import COASTING_NS, SeparationWatch
from airhilt.assistant.decision.threats import RunwayConfig
from airhilt.assistant.decision.visual_tracks import SightConfig, VisualTracks
from airhilt.configuration import Configuration, Share
from airhilt.engines import Engine
from airhilt.messages import (
    SPEAK_MIN_LEVEL,
    AdsbReport,
    Briefing,
    CameraInfo,
    Detections,
    Message,
    PartialTranscript,
    Severity,
    Transcript,
    TransmissionAudio,
    TransmissionOpened,
)
from airhilt.phraseology import TAU_ASR
from airhilt.units import SECOND_NS

WAITED_NS = SECOND_NS
"""Evidence that has waited this long for a busy engine, in ns, is judged by its own time."""
OBSERVED_EVERY_NS = SECOND_NS // 2
"""Least time between two such judgements, in ns: that between two position reports."""


class ReferenceConfig(Configuration):
    """Rules and thresholds of the reference engine."""

    tau_asr: Share = Field(
        TAU_ASR,
        description="confidence below which a slot of a call is in doubt and asked for; 0 believes "
        "every word; arXiv 2511.18718",
    )
    speak_min_level: Severity = Field(
        SPEAK_MIN_LEVEL,
        description="least severity that is spoken; what is below it is shown; arXiv 2511.18718",
    )
    separation: SeparationConfig = Field(SeparationConfig(), description="conflicts in the air")
    runways: RunwayConfig = Field(RunwayConfig(), description="conflicts on runways")
    intruders: IntruderConfig = Field(
        IntruderConfig(), description="aircraft that only cameras show"
    )
    sight: SightConfig = Field(SightConfig(), description="what cameras show")


class ReferenceEngine:
    """Decides by fixed rules.

    What cameras show goes to the visual tracks. They keep what no transponder explains, and both
    the watch for intruders and the one for runways look at that.
    """

    name = "reference"
    reads: tuple[type[Message], ...] = (Briefing, AdsbReport, Transcript, Detections)
    inputs: Mapping[str, object] = MappingProxyType(
        {
            "radio/*/audio": TransmissionAudio,
            "camera/*/info": CameraInfo,
            "asr/*/partial": PartialTranscript,
        }
    )

    def __init__(self, configuration: ReferenceConfig | None = None) -> None:
        self.configuration = config = configuration or ReferenceConfig()
        self.checks = InputChecks()
        self.visual_tracks = VisualTracks(config.sight)
        self._observed_ns = 0
        guard = ConfidenceGuard(config.tau_asr)
        self.separation = separation = SeparationWatch(config.separation, guard)
        self.runways = RunwayWatch(config.runways, self.visual_tracks, guard)
        self.intruders = IntruderWatch(
            config.intruders,
            self.visual_tracks,
            self.runways.runway_of_arrival,
            lambda: separation.config.standard,
        )

    def receive(self, received: ReceivedMessage) -> None:
        """Update tracks, clearances and belief with one message."""
        self._catch_up(received)
        t_ns = received.t_ns
        match received.message:
            case AdsbReport() as report if self.checks.believes_report(report, t_ns):
                self.separation.take_report(report, t_ns)
                self.runways.take(report, t_ns)
                self.visual_tracks.take_report(report, t_ns)
            case CameraInfo() as info:
                self.checks.take_camera(info)
            case Detections() as seen if self.checks.believes_detections(seen, t_ns):
                self.visual_tracks.take_detections(seen, t_ns)
            case TransmissionOpened() | PartialTranscript() as part:
                self.runways.take(part, t_ns)
            case Transcript() as transcript:
                for call in self.checks.in_order(transcript, t_ns):
                    self.runways.take(call, t_ns)
                    self.separation.take_transcript(t_ns, received.t_in_ns, call)
            case Briefing() as briefing:
                self.separation.take_briefing(briefing)
                self.runways.take(briefing, t_ns)
                self.visual_tracks.take_briefing(briefing)

    def _catch_up(self, received: ReceivedMessage) -> None:
        """Judge what was known when a message arrived that had to wait.

        A busy engine gets many messages at once. What they show together has lasted since the
        first of them, although nothing was told meanwhile.
        """
        arrived_ns = received.t_in_ns
        has_waited = received.t_ns - arrived_ns >= WAITED_NS
        if has_waited and arrived_ns - self._observed_ns >= OBSERVED_EVERY_NS:
            self._observed_ns = arrived_ns
            self.separation.observe(arrived_ns)
            self.runways.observe(arrived_ns)

    def decide(self, t_ns: int) -> Decision:
        """Return the alerts that are new, have risen, or are over."""
        self.visual_tracks.forget(t_ns)
        alerts: list[Alert] = []
        watches = (self.separation, self.runways, self.intruders)
        for watch in watches:
            alerts += watch.judge(t_ns)
        has_conflict = any(watch.has_conflict for watch in watches)
        marked = [self.checks.marked(alert, t_ns) for alert in alerts]
        return Decision(marked, again_ns=t_ns + COASTING_NS if has_conflict else None)


ENGINE = Engine(
    name="reference",
    summary="fixed rules for conflicts in the air and on runways; ships with AIRHILT",
    create=lambda _, configuration: ReferenceEngine(configuration),
    configuration=ReferenceConfig,
)
