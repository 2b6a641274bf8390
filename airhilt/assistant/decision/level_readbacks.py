"""Levels that the controller gave and that crews read back, and where the two do not agree."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import NamedTuple

from airhilt.assistant.decision.air_tracks import AirTracks
from airhilt.assistant.decision.findings import LevelMisread
from airhilt.assistant.decision.guard import ConfidenceGuard, Doubt, RememberingGuard, call_of
from airhilt.assistant.decision.loss_prediction import SeparationStandard
from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.relative_motion import relative
from airhilt.messages import RosterEntry, Transcript
from airhilt.phraseology import Instruction, differences
from airhilt.units import FOOT, SECOND_NS

ACTIVITY_S = 600.0
"""Traffic that comes within the horizontal minimum in this time, in s, counts as activity."""
DOUBTED_NS = 120 * SECOND_NS
"""Time for which a level in doubt matters, in ns."""


class _Clearance(NamedTuple):
    """The last level that the controller gave to an aircraft."""

    said: Instruction
    transcript: Transcript
    doubt: Doubt | None
    """Doubt about the level."""


class LevelReadbacks:
    """Follows clearances of levels, and sets the cleared level of tracks.

    A level in doubt is believed once the readback agrees with the instruction, or once it was said
    again, with confidence or alike. Until then no level is expected: a climb or descent is taken to
    go on.
    """

    def __init__(self, tracks: AirTracks, guard: ConfidenceGuard) -> None:
        self._tracks = tracks
        self._guard = RememberingGuard(guard.tau_asr)
        self._ceilings_ft: dict[str, float] = {}
        self._clearances: dict[str, _Clearance] = {}
        self._doubts: dict[str, Doubt] = {}
        """The doubt about the last level of each callsign."""

    def take_roster(self, roster: Iterable[RosterEntry]) -> None:
        """Note how high the aircraft can climb."""
        self._ceilings_ft = {
            each.callsign: each.ceiling_ft for each in roster if each.ceiling_ft is not None
        }

    def take_transcript(
        self, t_ns: int, transcript: Transcript, config: SeparationStandard
    ) -> LevelMisread | None:
        """Update levels with a call, and return a wrong readback with traffic at that level."""
        call = call_of(transcript, [track.callsign for track in self._tracks], self._ceilings_ft)
        callsign, said = call.match.callsign, call.altitude
        track = self._tracks.by_callsign(callsign) if callsign else None
        if track is None:
            return None
        if call.distress or call.emergency_descent:
            if not call.match.ambiguous:
                track.in_distress, track.cleared_m = True, None
                if call.emergency_descent and not call.addressed_first:
                    track.announce_descent(t_ns, transcript.id)
            return None
        if said is None or said.altitude_ft is None:
            return None
        doubt = self._guard.doubt(call, said, transcript)
        if call.match.ambiguous:
            if doubt is not None:
                self._doubts[track.callsign] = doubt
            return None
        if call.addressed_first:
            value = self._guard.doubt_of_value(call, said, transcript)
            self._clearances[track.callsign] = _Clearance(said, transcript, value)
            self._set_doubt(track, doubt)
            return None
        given = self._clearances.get(track.callsign)
        window_ns = config.readback_window_s * SECOND_NS
        if given is not None and transcript.t_tx_ns - given.transcript.t_end_ns > window_ns:
            given = None
        if given is not None:
            doubt = self._guard.doubt_of_value(call, said, transcript)
        return self._read_back(t_ns, track, said, transcript.id, given, doubt, config)

    def _read_back(
        self,
        t_ns: int,
        track: Track,
        read: Instruction,
        radio_id: str,
        given: _Clearance | None,
        doubt: Doubt | None,
        config: SeparationStandard,
    ) -> LevelMisread | None:
        """Compare a readback with its instruction, and expect its level if it is certain."""
        altitude_ft = read.altitude_ft or 0.0
        agrees = given is not None and "altitude_ft" not in differences(given.said, read)
        if doubt is not None and not agrees:
            self._set_doubt(track, doubt)
            track.cleared_m = None
            return None
        track.clear(altitude_ft * FOOT, t_ns, radio_id)
        disputed = None if given is None or agrees else given.doubt
        self._set_doubt(track, disputed and replace(disputed, is_answered=True))
        if given is None or agrees or disputed is not None:
            return None
        threatened = self._threatened(t_ns, track, altitude_ft, config)
        if threatened is None:
            return None
        return LevelMisread(
            callsign=track.callsign,
            read_ft=altitude_ft,
            cleared_ft=given.said.altitude_ft or 0.0,
            traffic=threatened.callsign,
            radio_ids=(given.transcript.id, radio_id),
        )

    def _set_doubt(self, track: Track, doubt: Doubt | None) -> None:
        if doubt is None:
            self._doubts.pop(track.callsign, None)
        else:
            self._doubts[track.callsign] = doubt

    def doubts(self, t_ns: int, config: SeparationStandard) -> Iterator[tuple[Doubt, str]]:
        """Yield what is in doubt about a level, and who is near that level."""
        for callsign, doubt in self._doubts.items():
            since_ns = t_ns - doubt.transcript.t_end_ns
            is_due = doubt.is_answered or since_ns > config.readback_window_s * SECOND_NS
            track = self._tracks.by_callsign(callsign)
            if track is None or not is_due or since_ns > DOUBTED_NS:
                continue
            threatened = self._threatened(t_ns, track, doubt.said.altitude_ft or 0.0, config)
            if threatened is not None:
                yield doubt, threatened.callsign

    def _threatened(
        self, t_ns: int, track: Track, altitude_ft: float, config: SeparationStandard
    ) -> Track | None:
        """Return who would lose separation if the aircraft flew to the level read back."""
        own = track.at(t_ns)
        target_m = altitude_ft * FOOT
        low, high = sorted((own.altitude_m, target_m))
        for other in self._tracks:
            if other.icao24 == track.icao24:
                continue
            ahead = other.at(t_ns)
            interval = relative(own, ahead).interval_within(config.horizontal_m)
            near = interval is not None and interval[1] > 0.0 and interval[0] < ACTIVITY_S
            level = ahead.profile().at(60.0)
            if near and low - config.vertical_m < level < high + config.vertical_m:
                return ahead
        return None
