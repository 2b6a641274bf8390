"""The rungs of the AIRHILT paper's decision ladder, for one instant (arXiv 2511.18718).

(a) A readback is wrong while the runway is in use: CAUTION. (b) The runway is occupied, and its
user has 8 s to go or is an arrival: WARNING. (c) It is not clear whom a call was for, or somebody
else took it, while the runway is in use: CAUTION. On a runway where none of these fires, a weighted
score decides. docs/baselines.md says what of this is the paper's word, and what is assumed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal, NamedTuple, get_args

from pydantic import Field

from airhilt.assistant.decision.aerodrome import Strip, Vector
from airhilt.assistant.decision.assessment import worst
from airhilt.assistant.decision.clearance_conflicts import activity_of, misread
from airhilt.assistant.decision.clearances import AmbiguousCall
from airhilt.assistant.decision.findings import Obstructs, Occupied, RecipientUnclear
from airhilt.assistant.decision.ladder import Score, ScoreConfig
from airhilt.assistant.decision.occupied_runway import named
from airhilt.assistant.decision.situation import RunwaySituation
from airhilt.assistant.decision.threats import (
    PAPER_TIME_TO_GO_S,
    RecipientGroup,
    Snapshot,
    Threat,
    obstruction,
)
from airhilt.assistant.decision.visual_tracks import (
    SightConfig,
    VisualTrack,
    VisualTracks,
    belief_in,
)
from airhilt.configuration import Configuration, Seconds, Share
from airhilt.messages import SPEAK_MIN_LEVEL, Severity
from airhilt.phraseology import TAU_ASR

Rung = Literal["readback_mismatch", "occupancy", "recipient_ambiguity", "score"]
"""Rungs of the ladder."""


class PaperConfig(Configuration):
    """Rungs and thresholds of the ladder; those of arXiv 2511.18718 unless called an assumption."""

    rules: tuple[Rung, ...] = Field(
        get_args(Rung), description="rungs that are applied, by the names that evidence gives them"
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
        get_args(RecipientGroup),
        min_length=1,
        description="who is told: the crews and drivers concerned, from a CAUTION on, and the "
        "controller; the paper leaves it open",
    )
    release_s: Seconds = Field(
        5.0,
        description="time for which a conflict must be over before that is told, in s; an "
        "assumption",
    )


class _Occupant(NamedTuple):
    """Somebody or something on a runway, by ADS-B or by cameras alone."""

    callsign: str | None
    """Its callsign by ADS-B; None if only cameras show it."""
    name: str
    """Its callsign, else `WILDLIFE` or `UNIDENTIFIED`."""
    what: str
    """Its callsign, else a word for what it is."""
    how: Obstructs
    point: Vector
    belief: float
    """Belief of the cameras that it is on the runway, from 0 to 1."""
    is_certain: bool
    """True if it is there by ADS-B, or cameras show it surely enough."""
    tracks: tuple[VisualTrack, ...]


class Ladder:
    """Finds the threats on an airport's runways by the paper's rungs."""

    def __init__(self, config: PaperConfig, visual_tracks: VisualTracks) -> None:
        self._config = config
        self._visual_tracks = visual_tracks

    def threats(self, situation: RunwaySituation, t_ns: int) -> Mapping[tuple[str, ...], Threat]:
        """Return the threats at a time, each by its key."""
        snapshot = Snapshot(situation, t_ns)
        found = (*self._by_words(snapshot), *self._by_occupancy(snapshot))
        fired = [threat for threat in found if threat.rule in self._config.rules]
        busy = {threat.strip.name for threat in fired}
        scored = [
            threat
            for strip in situation.aerodrome.strips
            for threat in self._by_score(snapshot, strip, strip.name in busy)
        ]
        return worst([*fired, *scored])

    def _by_words(self, snapshot: Snapshot) -> Iterator[Threat]:
        """Yield the threats of rungs (a) and (c): what was said does not agree, or with whom."""
        clearances = snapshot.situation.clearances
        for discrepancy in clearances.discrepancies(snapshot.t_ns):
            yield from misread(snapshot, discrepancy)
        for call in clearances.ambiguous(snapshot.t_ns):
            yield from _unclear(snapshot, call)

    def _by_occupancy(self, snapshot: Snapshot) -> Iterator[Threat]:
        """Yield the threats of rung (b): a runway is occupied, and somebody comes."""
        for use in snapshot.situation.uses.values():
            for occupant in self._occupants(snapshot, use.strip):
                time_s = snapshot.time_to_point_s(use, occupant.point)
                is_another = occupant.is_certain and occupant.callsign != use.mobile.callsign
                if time_s is None or not is_another:
                    continue
                if use.kind == "arrival" or time_s <= self._config.time_to_go_s:
                    yield obstruction(
                        use,
                        occupant.how,
                        occupant.what,
                        Severity.WARNING,
                        time_s,
                        ("vision", "adsb") if occupant.tracks else ("adsb",),
                        unnamed=None if occupant.callsign else occupant.name,
                        tracks=occupant.tracks,
                    )

    def _by_score(self, snapshot: Snapshot, strip: Strip, has_fired: bool) -> Iterator[Threat]:
        """Yield the threats of the weighted score.

        Where a rung has fired, they stay open without being told.
        """
        if "score" not in self._config.rules:
            return
        for occupant in self._occupants(snapshot, strip):
            own = occupant.callsign
            cleared = [
                each
                for each in snapshot.cleared_on(strip)
                if each.is_certain and each.callsign != own
            ]
            users = [
                use.mobile.callsign
                for use in snapshot.situation.uses.values()
                if use.strip is strip and use.mobile.callsign != own
            ]
            score = Score.of(
                self._config.score,
                vision=occupant.belief,
                asr=float(bool(cleared)),
                context=float(bool(users)),
            )
            severity = score.severity(self._config.score)
            if severity is None:
                continue
            known = [] if own is None else [own]
            parties = tuple(dict.fromkeys((*users, *(each.callsign for each in cleared), *known)))
            runway = strip.directions[0].ident
            shares = score.shares(vision=score.vision, radio=score.asr, adsb=score.context)
            yield Threat(
                key=("score", strip.name, occupant.name),
                severity=Severity.INFO if has_fired else severity,
                strip=strip,
                runway=runway,
                parties=parties,
                traffic=tuple(dict.fromkeys((*parties, occupant.name))),
                finding=Occupied(occupant.what, runway),
                rule="score",
                sources=tuple(shares),
                radio_ids=tuple(each.radio_id for each in cleared),
                tracks=occupant.tracks,
                shares=shares,
            )

    def _occupants(self, snapshot: Snapshot, strip: Strip) -> Iterator[_Occupant]:
        """Yield who or what is on a runway.

        An aircraft or vehicle on the ground is on the runway by its ADS-B position; the belief of
        the cameras is that of the pictures which show it there. All else has the position that the
        pictures give.
        """
        for obstacle in snapshot.situation.obstacles(strip):
            if obstacle.is_inside:
                own, point = obstacle.mobile.callsign, obstacle.mobile.point
                shown = tuple(t for t in self._visual_tracks if t.explained_by == own)
                yield _Occupant(own, own, own, "on", point, belief_in(shown), True, shown)
        for seen in snapshot.situation.seen(strip):
            thing = seen.thing
            how, what, name = named(thing, None)
            yield _Occupant(
                None,
                name or what,
                what,
                how,
                thing.fix.point,
                seen.weight,
                seen.is_certain,
                thing.tracks,
            )


def _unclear(snapshot: Snapshot, call: AmbiguousCall) -> Iterator[Threat]:
    """Yield the threat of a call that may be for one of several, about an active runway."""
    active = activity_of(snapshot, None, (call.said,))
    if active is None:
        return
    strip, traffic = active
    yield Threat(
        key=("ambiguous", call.transcript.id),
        severity=Severity.CAUTION,
        strip=strip,
        runway=call.said.runway or strip.directions[0].ident,
        parties=call.callsigns,
        traffic=tuple(dict.fromkeys((*call.callsigns, traffic))),
        finding=RecipientUnclear(call.callsigns, call.said, traffic),
        rule="recipient_ambiguity",
        sources=("radio", "adsb"),
        kind="readback_mismatch",
        radio_ids=(call.transcript.id,),
    )
