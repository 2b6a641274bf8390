"""Thresholds of the AIRHILT paper's decision ladder."""

from __future__ import annotations

from typing import Literal, get_args

from pydantic import Field

from airhilt.assistant.decision.ladder import ScoreConfig
from airhilt.assistant.decision.threats import PAPER_TIME_TO_GO_S, RECIPIENT_GROUPS, RecipientGroup
from airhilt.assistant.decision.visual_tracks import SightConfig
from airhilt.configuration import Configuration, Seconds, Share
from airhilt.messages import SPEAK_MIN_LEVEL, Severity
from airhilt.phraseology import TAU_ASR

Rung = Literal["readback_mismatch", "occupancy", "recipient_ambiguity", "score"]
"""Rungs of the ladder."""
RUNGS: tuple[Rung, ...] = get_args(Rung)


class PaperConfig(Configuration):
    """Rungs and thresholds of the ladder; those of arXiv 2511.18718 unless called an assumption."""

    rules: tuple[Rung, ...] = Field(
        RUNGS, description="rungs that are applied, by the names that evidence gives them"
    )
    tau_asr: Share = Field(
        TAU_ASR,
        description="confidence below which a slot of a call is in doubt and asked for; 0 believes "
        "every word; arXiv 2511.18718",
    )
    time_to_go_s: Seconds = Field(
        PAPER_TIME_TO_GO_S,
        description="time to go from which an occupied runway is a WARNING, in s; arXiv 2511.18718",
    )
    sight: SightConfig = Field(SightConfig(), description="what cameras show")
    score: ScoreConfig = Field(ScoreConfig(), description="weak hints together")
    speak_min_level: Severity = Field(
        SPEAK_MIN_LEVEL,
        description="least severity that is spoken; what is below it is shown; arXiv 2511.18718",
    )
    recipients: tuple[RecipientGroup, ...] = Field(
        RECIPIENT_GROUPS,
        min_length=1,
        description="who is told: the crews and drivers concerned, from a CAUTION on, and the "
        "controller; the paper leaves it open",
    )
    release_s: Seconds = Field(
        5.0,
        description="time for which a conflict must be over before that is told, in s; an "
        "assumption",
    )
