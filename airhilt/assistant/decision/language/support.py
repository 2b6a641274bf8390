"""Evidence that a conflict which a language model tells of may be one."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from airhilt.assistant.decision.language.question import Turn
from airhilt.assistant.decision.service_messages import AssistantRequest, TrackSlice
from airhilt.assistant.decision.slices import MS_NS
from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.relative_motion import Minima, relative, time_to_loss_s
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE

NEAR = 1.5
"""Multiple of the separation minima: two tracks that stay farther apart are in no conflict."""
LOOK_AHEAD_S = 180.0
"""Time within which they must do so, in s: that of the rules' ADVISORY."""
ANSWERED_MS = 30_000
"""Longest time from an instruction to its readback, in ms: that of the rules."""


def is_airborne_conflict(traffic: Sequence[str], request: AssistantRequest) -> bool:
    """Return whether two of some aircraft come near each other, if they fly on as they do."""
    if request.context is None:
        return False
    near = Minima(
        NEAR * request.context.horizontal_separation_nm * NAUTICAL_MILE,
        NEAR * request.context.vertical_separation_ft * FOOT,
    )
    flying = [
        track
        for each in request.tracks
        if (each.callsign or each.icao24) in traffic
        and (track := _track(each, request.ts_ms)) is not None
    ]
    return len(flying) == len(set(traffic)) and any(
        _is_near(first, second, near) for first, second in itertools.combinations(flying, 2)
    )


def _is_near(first: Track, second: Track, near: Minima) -> bool:
    """Return whether two come within some distances in time."""
    motion = relative(first, second)
    meeting_s = time_to_loss_s(motion, first.profile(), second.profile(), near)
    return meeting_s is not None and meeting_s <= LOOK_AHEAD_S


def misread_turns(turns: Sequence[Turn]) -> bool:
    """Return whether one of some calls reads another one back differently, or for another."""
    given = [turn for turn in turns if turn.call.addressed_first]
    read = [turn for turn in turns if not turn.call.addressed_first]
    return any(
        0 < answer.turn.ts_ms - call.turn.ts_ms <= ANSWERED_MS
        and (
            answer.callsign != call.callsign
            or set(answer.instructions).isdisjoint(call.instructions)
        )
        for call in given
        for answer in read
    )


def _track(report: TrackSlice, ts_ms: int) -> Track | None:
    """Return an aircraft in flight as of a time; None if it is on the ground."""
    if report.altitude_ft is None or report.on_ground:
        return None
    speed_m_s, course = report.ground_speed_kt * KNOT, report.track_deg * DEGREE
    track = Track(
        icao24=report.icao24,
        callsign=report.callsign or report.icao24,
        t_ns=report.ts_ms * MS_NS,
        latitude_rad=report.latitude_deg * DEGREE,
        longitude_rad=report.longitude_deg * DEGREE,
        altitude_m=report.altitude_ft * FOOT,
        velocity_north_m_s=speed_m_s * math.cos(course),
        velocity_east_m_s=speed_m_s * math.sin(course),
        vertical_rate_m_s=report.vertical_rate_fpm * FOOT_PER_MINUTE,
    )
    return track.at(ts_ms * MS_NS)
