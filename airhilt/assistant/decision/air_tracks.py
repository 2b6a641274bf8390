"""The tracks of the aircraft in flight, and which pairs of them have news."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import NamedTuple

import numpy as np

from airhilt.assistant.decision.tracks import Track
from airhilt.assistant.decision.velocity_checks import VelocityChecks
from airhilt.geodesy.wgs84 import LEAST_CURVATURE_RADIUS_M
from airhilt.messages import AdsbReport
from airhilt.units import SECOND_NS

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
        self._velocities = VelocityChecks()
        self._heard_ns: dict[str, int] = {}
        """Time at which the last report of each in flight arrived, however old it was."""
        self._grounded: set[str] = set()
        self._updated: dict[str, None] = {}
        self._carried: dict[str, Track] = {}

    def __iter__(self) -> Iterator[Track]:
        yield from self._tracks.values()

    def take_report(self, report: AdsbReport, t_ns: int) -> None:
        """Update the track of an aircraft at a time, or note that it is on the ground."""
        report = self._velocities.checked(report)
        if (altitude_ft := report.altitude_ft) is None:
            self._grounded.add(report.icao24)
            return
        self._grounded.discard(report.icao24)
        self._heard_ns[report.icao24] = t_ns
        self._updated[report.icao24] = None
        track = self._tracks.get(report.icao24)
        if track is None:
            self._tracks[report.icao24] = Track.of(report, altitude_ft, report.t_adsb_in_ns)
        else:
            track.update(report, altitude_ft)

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

    def end_step(self) -> None:
        """Forget which tracks have news."""
        self._updated.clear()

    def present(self, icao24: str, t_ns: int) -> Track:
        """Return a track extrapolated to now, computed once a step."""
        track = self._carried.get(icao24)
        if track is None:
            track = self._carried[icao24] = self._tracks[icao24].at(t_ns)
        return track

    def pairs_with_news(
        self, t_ns: int, reach: Reach, stale_s: float, wanted: Collection[Pair]
    ) -> list[Pair]:
        """Return the pairs that have news and are wanted or could come together.

        Tracks of which nothing arrived for ``stale_s`` are dropped, but for those of pairs that are
        wanted. Most pairs of a busy sky are too far apart in level or latitude to meet within the
        look-ahead; they are left out here, where it is cheap.
        """
        self._carried.clear()
        coasting = {icao24 for pair in wanted for icao24 in pair}
        oldest_ns = t_ns - round(stale_s * SECOND_NS)
        for icao24 in list(self._tracks):
            if self._heard_ns[icao24] < oldest_ns and icao24 not in coasting:
                del self._tracks[icao24]
        names = list(self._tracks)
        places = {icao24: place for place, icao24 in enumerate(names)}
        rows = [
            (
                track.altitude_m,
                track.latitude_rad,
                abs(track.profile().rate_m_s) * reach.time_s,
                abs(track.velocity_north_m_s) * reach.time_s,
            )
            for track in self._tracks.values()
        ]
        altitude_m, latitude_rad, climb_m, north_m = np.array(rows, np.float64).reshape(-1, 4).T
        pairs: dict[Pair, None] = {}
        for icao24 in self._updated:
            own = places.get(icao24)
            if own is None:
                continue
            gap_m = np.abs(altitude_m[own] - altitude_m)
            apart_m = np.abs(latitude_rad[own] - latitude_rad) * LEAST_CURVATURE_RADIUS_M
            is_near = apart_m <= reach.horizontal_m + north_m[own] + north_m
            is_near &= gap_m <= reach.vertical_m + climb_m[own] + climb_m
            partners = [name for pair in wanted if icao24 in pair for name in pair]
            is_near[[places[name] for name in partners if name in places]] = True
            is_near[own] = False
            for place in np.flatnonzero(is_near).tolist():
                name = names[place]
                pairs[(icao24, name) if icao24 < name else (name, icao24)] = None
        return list(pairs)

    def silent(self, pairs: Collection[Pair], t_ns: int, least_ns: int) -> list[Pair]:
        """Return the pairs of which nothing has been heard for some time."""
        return [
            pair
            for pair in pairs
            if t_ns - max(self._heard_ns[icao24] for icao24 in pair) >= least_ns
        ]
