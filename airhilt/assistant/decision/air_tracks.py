"""The tracks of the aircraft in flight, and which pairs of them have news."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import NamedTuple

from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.wgs84 import LEAST_CURVATURE_RADIUS_M
from airhilt.messages import AdsbReport

Pair = tuple[str, str]
"""Addresses of two aircraft, in order."""


class Reach(NamedTuple):
    """Distances and times beyond which two aircraft need not be looked at together."""

    horizontal_m: float
    vertical_m: float
    time_s: float


class AirTracks:
    """A track of each aircraft that reports a pressure altitude."""

    def __init__(self) -> None:
        self._tracks: dict[str, Track] = {}
        self._heard_ns: dict[str, int] = {}
        """Time at which the last report of each in flight arrived, however old it was."""
        self._grounded: set[str] = set()
        self._updated: dict[str, None] = {}
        self._carried: dict[str, Track] = {}

    def __iter__(self) -> Iterator[Track]:
        yield from self._tracks.values()

    def __getitem__(self, icao24: str) -> Track:
        return self._tracks[icao24]

    def take_report(self, report: AdsbReport, t_ns: int) -> None:
        """Update the track of an aircraft at a time, or note that it is on the ground."""
        if report.altitude_ft is None:
            self._grounded.add(report.icao24)
            return
        self._grounded.discard(report.icao24)
        self._heard_ns[report.icao24] = t_ns
        self._updated[report.icao24] = None
        track = self._tracks.get(report.icao24)
        if track is None:
            self._tracks[report.icao24] = Track.of(report, report.altitude_ft)
        else:
            track.update(report, report.altitude_ft)

    def addresses(self, *callsigns: str) -> tuple[str, ...]:
        """Return the addresses of the aircraft that have some callsigns."""
        found = (self.by_callsign(callsign) for callsign in callsigns)
        return tuple(track.icao24 for track in found if track is not None)

    def by_callsign(self, callsign: str) -> Track | None:
        """Return the track of a callsign, None if there is none."""
        return next((t for t in self._tracks.values() if t.callsign == callsign), None)

    def is_grounded(self, track: Track) -> bool:
        """Return whether an aircraft was on the ground by its last report."""
        return track.icao24 in self._grounded

    def begin_step(self, oldest_ns: int, kept: Collection[Pair]) -> None:
        """Drop the tracks of which nothing arrived since a time, but for pairs that are kept."""
        self._carried.clear()
        stale = [icao24 for icao24 in self._tracks if self._heard_ns[icao24] < oldest_ns]
        coasting = {icao24 for pair in kept for icao24 in pair} if stale else set()
        for icao24 in stale:
            if icao24 not in coasting:
                del self._tracks[icao24]

    def end_step(self) -> None:
        """Forget which tracks have news."""
        self._updated.clear()

    def present(self, icao24: str, t_ns: int) -> Track:
        """Return a track extrapolated to now, computed once a step."""
        track = self._carried.get(icao24)
        if track is None:
            track = self._carried[icao24] = self._tracks[icao24].at(t_ns)
        return track

    def pairs_with_news(self, reach: Reach, wanted: Collection[Pair]) -> Iterator[Pair]:
        """Yield the pairs that have news and are wanted or could come together.

        Most pairs of a busy sky are too far apart in level or latitude to meet within the
        look-ahead; they are left out here, where it is cheap.
        """
        seen = set()
        for icao24 in self._updated:
            own = self._tracks.get(icao24)
            if own is None:
                continue
            level_m = reach.vertical_m + abs(own.profile().rate_m_s) * reach.time_s
            north_m = reach.horizontal_m + abs(own.velocity_north_m_s) * reach.time_s
            for name, other in self._tracks.items():
                pair = (icao24, name) if icao24 < name else (name, icao24)
                if name == icao24 or pair in seen:
                    continue
                gap_m = abs(own.altitude_m - other.altitude_m)
                apart_m = abs(own.latitude_rad - other.latitude_rad) * LEAST_CURVATURE_RADIUS_M
                if pair in wanted or (
                    apart_m <= north_m + abs(other.velocity_north_m_s) * reach.time_s
                    and gap_m <= level_m + abs(other.profile().rate_m_s) * reach.time_s
                ):
                    seen.add(pair)
                    yield pair

    def silent_ns(self, pair: Pair, t_ns: int) -> int:
        """Return how long nothing has been heard of either of a pair."""
        return t_ns - max(self._heard_ns[icao24] for icao24 in pair)
