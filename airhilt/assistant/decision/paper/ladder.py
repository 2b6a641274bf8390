"""The rungs of the AIRHILT paper's decision ladder, for one instant (arXiv 2511.18718).

(a) A readback is wrong while the runway is in use: CAUTION. (b) The runway is occupied, and its
user has 8 s to go or is an arrival: WARNING. (c) It is not clear whom a call was for, or somebody
else took it, while the runway is in use: CAUTION. On a runway where none of these fires, a weighted
score decides. docs/decision.md says what of this is the paper's word, and what is assumed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from airhilt.assistant.decision.aerodrome import Strip
from airhilt.assistant.decision.assessment import worst
from airhilt.assistant.decision.clearance_conflicts import activity_of, misread
from airhilt.assistant.decision.clearances import Clearance
from airhilt.assistant.decision.findings import Obstructs, Occupied, RecipientUnclear
from airhilt.assistant.decision.ladder import Score
from airhilt.assistant.decision.mobiles import Use
from airhilt.assistant.decision.paper.ambiguity import AmbiguousCall, AmbiguousCalls
from airhilt.assistant.decision.paper.config import PaperConfig
from airhilt.assistant.decision.paper.occupants import Occupant, occupants
from airhilt.assistant.decision.situation import RunwaySituation
from airhilt.assistant.decision.threats import Snapshot, Threat, cameras_of, obstruction
from airhilt.assistant.decision.visual_tracks import VisualTracks
from airhilt.messages import Severity


class Ladder:
    """Finds the threats on an airport's runways by the paper's rungs."""

    def __init__(
        self, config: PaperConfig, visual_tracks: VisualTracks, ambiguous: AmbiguousCalls
    ) -> None:
        self._config = config
        self._visual_tracks = visual_tracks
        self._ambiguous = ambiguous

    def threats(self, situation: RunwaySituation, t_ns: int) -> Mapping[tuple[str, ...], Threat]:
        """Return the threats at a time, each by its key."""
        snapshot = Snapshot(situation, t_ns)
        found = (*self._by_words(snapshot), *self._by_occupancy(snapshot))
        fired = [threat for threat in found if not set(threat.rules).isdisjoint(self._config.rules)]
        busy = {threat.strip.name for threat in fired}
        scored = [
            threat
            for strip in situation.aerodrome.strips
            for threat in self._by_score(snapshot, strip, strip.name in busy)
        ]
        return worst([*fired, *scored])

    def _by_words(self, snapshot: Snapshot) -> Iterator[Threat]:
        """Yield the threats of rungs (a) and (c): what was said does not agree, or with whom."""
        for discrepancy in snapshot.situation.clearances.discrepancies(snapshot.t_ns):
            yield from misread(snapshot, discrepancy)
        for call in self._ambiguous.open(snapshot.t_ns):
            yield from _unclear(snapshot, call)

    def _by_occupancy(self, snapshot: Snapshot) -> Iterator[Threat]:
        """Yield the threats of rung (b): a runway is occupied, and somebody comes."""
        for use in snapshot.situation.uses.values():
            for occupant in self._occupants(snapshot, use.strip):
                time_s = _time_to_go_s(snapshot, use, occupant)
                if time_s is None or not occupant.is_certain:
                    continue
                if use.kind == "arrival" or time_s <= self._config.time_to_go_s:
                    yield _in_way(use, occupant, Severity.WARNING, time_s)

    def _by_score(self, snapshot: Snapshot, strip: Strip, has_fired: bool) -> Iterator[Threat]:
        """Yield the threats of the weighted score.

        Where a rung has fired, they stay open without being told.
        """
        if "score" not in self._config.rules:
            return
        for occupant in self._occupants(snapshot, strip):
            score = self._score(snapshot, strip, occupant)
            severity = score.severity(self._config.score)
            if severity is not None:
                yield _scored(
                    snapshot, strip, occupant, score, Severity.INFO if has_fired else severity
                )

    def _score(self, snapshot: Snapshot, strip: Strip, occupant: Occupant) -> Score:
        cleared, users = _others(snapshot, strip, occupant)
        return Score.of(
            self._config.score,
            vision=occupant.belief,
            asr=float(bool(cleared)),
            context=float(bool(users)),
        )

    def _occupants(self, snapshot: Snapshot, strip: Strip) -> Iterator[Occupant]:
        return occupants(snapshot.situation, strip, self._visual_tracks)


def _time_to_go_s(snapshot: Snapshot, use: Use, occupant: Occupant) -> float | None:
    """Return the time until a user is where an occupant is, in s; None if it is not, or itself."""
    if use.mobile.callsign == occupant.callsign:
        return None
    return snapshot.time_to_point_s(use, occupant.point)


def _others(
    snapshot: Snapshot, strip: Strip, occupant: Occupant
) -> tuple[list[Clearance], list[str]]:
    """Return the certain clearances of others on to a runway, and who else uses it."""
    cleared = [
        each
        for each in snapshot.cleared_on(strip)
        if each.is_certain and each.callsign != occupant.callsign
    ]
    users = [
        use.mobile.callsign
        for use in snapshot.situation.uses.values()
        if use.strip is strip and use.mobile.callsign != occupant.callsign
    ]
    return cleared, users


def _unclear(snapshot: Snapshot, call: AmbiguousCall) -> Iterator[Threat]:
    """Yield the threat of a call that may be for one of several, about an active runway."""
    strip, activity = activity_of(snapshot, None, (call.said,))
    if strip is None:
        return
    yield Threat(
        key=("ambiguous", call.id),
        severity=Severity.CAUTION,
        strip=strip,
        runway=call.said.runway or strip.directions[0].ident,
        parties=call.callsigns,
        traffic=tuple(dict.fromkeys((*call.callsigns, activity[0]))),
        finding=RecipientUnclear(call.callsigns, call.said, activity[0]),
        sources=("radio", "adsb"),
        kind="readback_mismatch",
        radio_ids=(call.id,),
        rules=("recipient_ambiguity",),
    )


def _in_way(use: Use, occupant: Occupant, severity: Severity, time_s: float | None) -> Threat:
    """Return the threat that an occupant is in the way of a runway's user."""
    sources = ("vision",) if occupant.tracks else ()
    how: Obstructs = "on"
    if occupant.callsign is None:
        how = "animal on" if occupant.is_animal else "unidentified on"
    return obstruction(
        use,
        how,
        occupant.callsign or occupant.label,
        severity,
        time_s,
        (*sources, "adsb"),
        unnamed=None if occupant.callsign else occupant.name,
        tracks=occupant.tracks,
    )


def _scored(
    snapshot: Snapshot, strip: Strip, occupant: Occupant, score: Score, severity: Severity
) -> Threat:
    """Return the threat of a runway that is occupied by the weighted score."""
    cleared, users = _others(snapshot, strip, occupant)
    known = [] if occupant.callsign is None else [occupant.callsign]
    parties = tuple(dict.fromkeys((*users, *(each.callsign for each in cleared), *known)))
    runway = strip.directions[0].ident
    shares = score.shares(vision=score.vision, radio=score.asr, adsb=score.context)
    return Threat(
        key=("score", strip.name, occupant.name),
        severity=severity,
        strip=strip,
        runway=runway,
        parties=parties,
        traffic=tuple(dict.fromkeys((*parties, occupant.name))),
        finding=Occupied(occupant.callsign or occupant.label, runway),
        sources=tuple(shares),
        radio_ids=tuple(each.radio_id for each in cleared),
        cameras=cameras_of(occupant.tracks),
        rules=("score",),
        shares=shares,
    )
