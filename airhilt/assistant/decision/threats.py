"""Threats on a runway, and the time until its user is there."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

from pydantic import Field, model_validator

from airhilt.assistant.decision.aerodrome import Strip, Vector
from airhilt.assistant.decision.clearances import Clearance
from airhilt.assistant.decision.findings import Finding, Obstruction, Obstructs
from airhilt.assistant.decision.ladder import ScoreConfig
from airhilt.assistant.decision.mobiles import BRAKING_M_S2, Use
from airhilt.assistant.decision.situation import RunwaySituation
from airhilt.assistant.decision.visual_tracks import VisualTrack
from airhilt.configuration import Configuration, Seconds, require_order
from airhilt.messages import Severity
from airhilt.phraseology import Action

PAPER_TIME_TO_GO_S = 8.0
"""Time to go in step (b) of the AIRHILT paper's ladder, in s (arXiv 2511.18718)."""
BEHIND_M = 30.0
"""Distance behind the user of a runway beyond which nothing is in its way, in m."""
STOPPING_MARGIN_M = 100.0
"""Room beyond the stopping distance of a landing, in m. What is farther ahead is not in its way."""
WILDLIFE = "wildlife"
"""The other party where it is an animal."""
UNIDENTIFIED = "unidentified"
"""The other party where only cameras show it."""
RunwayRule = Literal[
    "readback_mismatch",
    "recipient_ambiguity",
    "readback_missing",
    "opposed_clearances",
    "occupancy",
    "cleared_on",
    "reported_wildlife",
    "flight_path",
    "meeting",
    "score",
]
"""Rules that find threats on runways."""
RecipientGroup = Literal["concerned", "controller"]
"""Groups of recipients: the crews and drivers concerned, and the controller."""


class RunwayConfig(Configuration):
    """Rules and thresholds for conflicts on runways.

    Surface alerting first looks at an arrival 30 s before the threshold in good visibility
    (EUROCONTROL-SPEC-171). A WARNING comes 5 s before that, for the way that an advisory takes,
    and a CAUTION well ahead of it.
    """

    rules: tuple[RunwayRule, ...] = Field(
        get_args(RunwayRule),
        description="rules that are applied, by the names that evidence gives them",
    )
    recipients: tuple[RecipientGroup, ...] = Field(
        get_args(RecipientGroup),
        min_length=1,
        description="who is told: the crews and drivers concerned, from a CAUTION on, and the "
        "controller; chosen",
    )
    caution_s: Seconds = Field(
        60.0, description="time to go from which an occupied runway is a CAUTION, in s; chosen"
    )
    warning_s: Seconds = Field(
        35.0,
        description="likewise for a WARNING, in s; 5 s more than in EUROCONTROL-SPEC-171",
    )
    late_s: Seconds = Field(
        PAPER_TIME_TO_GO_S,
        description="time to go from which somebody on the runway is in the way even if about to "
        "leave, in s; time to go of arXiv 2511.18718",
    )
    leaving_margin_s: Seconds = Field(
        8.0, description="least time between somebody's leaving and the next user, in s; chosen"
    )
    crossing_margin_s: Seconds = Field(
        10.0,
        description="least time between two at the crossing of their runways, in s; chosen",
    )
    persistence_s: Seconds = Field(
        1.0, description="time for which a severity must hold before it is told, in s; chosen"
    )
    release_s: Seconds = Field(
        5.0, description="time for which a conflict must be over before that is told, in s; chosen"
    )
    score: ScoreConfig = Field(ScoreConfig(), description="weak hints together")

    @model_validator(mode="after")
    def _in_order(self) -> RunwayConfig:
        require_order(self, "warning_s", "caution_s")
        return self


@dataclass(frozen=True, slots=True)
class Threat:
    """Something that is wrong on a runway at one instant."""

    key: tuple[str, ...]
    """The same for the same conflict, from step to step."""
    severity: Severity
    """INFO if the situation is expected to resolve itself, but has not yet."""
    strip: Strip
    runway: str
    """The direction that is used."""
    parties: tuple[str, ...]
    """Callsigns of those whom it concerns."""
    traffic: tuple[str, ...]
    """The parties, and what else is in the way."""
    finding: Finding
    rule: RunwayRule
    time_to_go_s: float | None = None
    sources: tuple[str, ...] = ("adsb",)
    """Modalities that it rests on, the decisive one first."""
    kind: Literal["runway_conflict", "readback_mismatch"] = "runway_conflict"
    radio_ids: tuple[str, ...] = ()
    """Ids of the transmissions that it rests on."""
    tracks: tuple[VisualTrack, ...] = ()
    """Visual tracks that it rests on."""
    shares: Mapping[str, float] = field(default_factory=dict)
    """Share of each modality in the judgement; empty where it cannot be told."""
    provisional_ids: tuple[str, ...] = ()
    """Ids of unfinished transmissions whose words so far cause it or make it more severe."""


class Snapshot:
    """The situation at one instant, with who is cleared where and who will be where when."""

    def __init__(self, situation: RunwaySituation, t_ns: int) -> None:
        self.situation = situation
        self.t_ns = t_ns
        self.in_force = tuple(situation.clearances.in_force(t_ns))

    def time_to_point_s(self, use: Use, point: Vector) -> float | None:
        """Return the time until a runway's user is where something is, in s.

        None if the user does not come there; infinite if it stops before.
        """
        along_m = use.direction.along_m(point)
        if use.is_climbing or along_m < use.along_m - BEHIND_M:
            return None
        return self.time_to_go_s(use, along_m)

    def time_to_go_s(self, use: Use, along_m: float) -> float:
        """Return the time until a runway's user is there; infinite if it stops before.

        For an arrival it is the time to the threshold.
        """
        if use.kind == "arrival":
            return use.time_to_threshold_s(self.t_ns)
        if use.kind == "rollout":
            braked_m = use.mobile.speed_m_s**2 / (2.0 * BRAKING_M_S2) + STOPPING_MARGIN_M
            if along_m - use.along_m > braked_m:
                return math.inf
            return max(along_m - use.along_m, 0.0) / use.mobile.speed_m_s
        time_s = use.time_to_s(max(along_m, use.along_m), self.t_ns)
        return math.inf if time_s is None else time_s

    def cleared_on(self, strip: Strip) -> list[Clearance]:
        """Return the clearances in force on to a runway."""
        strip_of = self.situation.aerodrome.strip_of
        return [each for each in self.in_force if strip_of(each.runway) is strip]

    def cleared_to(self, callsign: str | None, strip: Strip) -> set[Action]:
        """Return what somebody is cleared to do on a runway; to cross it, only if that is certain.

        A clearance to cross allows the presence on the runway; the others only show a destination.
        """
        return {
            clearance.action
            for clearance in self.cleared_on(strip)
            if clearance.callsign == callsign
            and (clearance.is_certain or clearance.action != "cross")
        }


class Outlook(Snapshot):
    """The situation at one instant, judged by the thresholds of the reference engine."""

    def __init__(self, situation: RunwaySituation, config: RunwayConfig, t_ns: int) -> None:
        super().__init__(situation, t_ns)
        self.config = config

    def coming(self, use: Use, point: Vector) -> tuple[Severity, float] | None:
        """Return how severe it is that something is where a runway's user goes, and its time to go.

        None if the user does not come there, or not soon.
        """
        time_to_go_s = self.time_to_point_s(use, point)
        if time_to_go_s is None:
            return None
        severity = self.urgency(use, time_to_go_s)
        return None if severity is None else (severity, time_to_go_s)

    def urgency(self, use: Use, time_to_go_s: float) -> Severity | None:
        """Return how severe it is that the runway's user finds it occupied."""
        if math.isinf(time_to_go_s):
            return None
        if use.kind != "arrival" or time_to_go_s <= self.config.warning_s:
            return Severity.WARNING
        return Severity.CAUTION if time_to_go_s <= self.config.caution_s else None


def obstruction(
    use: Use,
    how: Obstructs,
    what: str,
    severity: Severity,
    time_to_go_s: float | None,
    sources: tuple[str, ...] = ("adsb",),
    *,
    unnamed: str | None = None,
    where: str | None = None,
    tracks: tuple[VisualTrack, ...] = (),
    radio_ids: tuple[str, ...] = (),
    rule: RunwayRule = "occupancy",
    shares: Mapping[str, float] | None = None,
) -> Threat:
    """Return the threat that somebody or something is in the way of a runway's user.

    Parameters
    ----------
    what
        Callsign, or a word for what has none.
    unnamed
        `WILDLIFE` or `UNIDENTIFIED` for what has no callsign.
    where
        Runway on which it is; None: the one that is used.
    """
    own, other, runway = use.mobile.callsign, unnamed or what, use.direction.ident
    return Threat(
        key=("runway", *sorted((own, other))),
        severity=severity,
        strip=use.strip,
        runway=runway,
        parties=(own,) if unnamed else (own, other),
        traffic=(own, other),
        finding=Obstruction(own, use.kind, runway, how, what, where or runway),
        rule=rule,
        time_to_go_s=time_to_go_s,
        sources=sources,
        radio_ids=radio_ids,
        tracks=tracks,
        shares=shares or {},
    )
