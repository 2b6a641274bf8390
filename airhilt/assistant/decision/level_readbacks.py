"""Levels that the controller gave and that crews read back, and where the two do not agree."""

from __future__ import annotations

from dataclasses import dataclass

from airhilt.assistant.decision.air_tracks import AirTracks
from airhilt.assistant.decision.findings import LevelMisread
from airhilt.assistant.decision.loss_prediction import SeparationConfig
from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.relative_motion import relative
from airhilt.messages import Transcript
from airhilt.phraseology import Call, parse_call
from airhilt.units import FOOT, SECOND_NS

ACTIVITY_S = 600.0
"""Traffic that comes within the horizontal minimum in this time, in s, counts as activity."""


@dataclass(slots=True)
class _Clearance:
    """The last level that the controller gave to an aircraft."""

    altitude_ft: float
    t_end_ns: int


class LevelReadbacks:
    """Follows clearances of levels, and sets the cleared level of tracks."""

    def __init__(self, tracks: AirTracks) -> None:
        self._tracks = tracks
        self._clearances: dict[str, _Clearance] = {}

    def take_transcript(
        self, t_ns: int, transcript: Transcript, config: SeparationConfig
    ) -> LevelMisread | None:
        """Update levels with a call, and return a wrong readback with traffic at that level."""
        call = parse_call(transcript.text, [track.callsign for track in self._tracks])
        track = self._tracks.by_callsign(call.callsign) if call.callsign else None
        if track is not None and (call.distress or call.emergency_descent):
            track.in_distress = True
            track.cleared_m = None
            if call.emergency_descent and not call.addressed_first:
                track.descent_ns = t_ns
            return None
        if track is None or call.altitude_ft is None:
            return None
        if call.addressed_first:
            self._clearances[track.callsign] = _Clearance(call.altitude_ft, transcript.t_end_ns)
            return None
        given = self._clearances.get(track.callsign)
        track.clear(call.altitude_ft * FOOT, t_ns)
        if (
            given is None
            or call.altitude_ft == given.altitude_ft
            or transcript.t_tx_ns - given.t_end_ns > config.readback_window_s * SECOND_NS
        ):
            return None
        threatened = self._threatened(t_ns, track, call, config)
        if threatened is None:
            return None
        return LevelMisread(
            callsign=track.callsign,
            read_ft=call.altitude_ft,
            cleared_ft=given.altitude_ft,
            traffic=threatened.callsign,
        )

    def _threatened(
        self, t_ns: int, track: Track, call: Call, config: SeparationConfig
    ) -> Track | None:
        """Return who would lose separation if the aircraft flew to the level read back."""
        own = track.at(t_ns)
        target_m = (call.altitude_ft or 0.0) * FOOT
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
