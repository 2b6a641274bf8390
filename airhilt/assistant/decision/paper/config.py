"""Thresholds of the AIRHILT paper's decision ladder."""

from __future__ import annotations

from dataclasses import dataclass

from airhilt.assistant.decision.threats import PAPER_TIME_TO_GO_S
from airhilt.assistant.decision.visual_tracks import AGREEING_CAMERAS, PERSISTENCE_NS, TAU_VIS
from airhilt.phraseology import TAU_ASR
from airhilt.units import SECOND_NS


@dataclass(frozen=True)
class PaperConfig:
    """Thresholds of the paper's ladder; those of arXiv 2511.18718 unless called an assumption."""

    time_to_go_s: float = PAPER_TIME_TO_GO_S
    """Time to go, in s, from which an occupied runway is a WARNING."""
    tau_asr: float = TAU_ASR
    """Confidence below which a slot of a call is in doubt, and asked for."""
    tau_vis: float = TAU_VIS
    """Least belief with which cameras show that a runway is occupied."""
    cameras: int = AGREEING_CAMERAS
    """Number of cameras that must agree (K); its value is an assumption."""
    persistence_s: float = PERSISTENCE_NS / SECOND_NS
    """Time for which one camera alone must show it, in s; an assumption."""
    vision_weight: float = 0.50
    asr_weight: float = 0.35
    context_weight: float = 0.15
    caution_from: float = 0.75
    """Score from which it is a CAUTION."""
    advisory_from: float = 0.50
    """Score from which it is an ADVISORY."""
    release_s: float = 5.0
    """Time for which a conflict must be over before that is told, in s; an assumption."""
