"""Aircraft and vehicles known by ADS-B, and whether what a camera shows is one of them."""

from __future__ import annotations

import math

from airhilt.assistant.decision.line_of_sight import BOX_ERROR_PX, PictureGeometry, Ray
from airhilt.assistant.decision.velocity_checks import VelocityChecks
from airhilt.geodesy.wgs84 import offset_m
from airhilt.messages import AdsbReport, Box, CameraView, EmitterCategory
from airhilt.surveillance.squitters import NACP_95_PERCENT_M
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS

STALE_NS = 15 * SECOND_NS
STALE_ON_GROUND_NS = 30 * SECOND_NS
"""Silence after which reports are forgotten, in ns. A standing mobile squitters every 5 s."""
HALF_SIZE_M: dict[EmitterCategory | None, float] = {
    "A1": 8.0, "A2": 14.0, "A3": 21.0, "A5": 38.0, "C1": 7.0, "C2": 7.0,
}  # fmt: skip
UNKNOWN_HALF_SIZE_M = 38.0
ALTITUDE_ERROR_M = 25.0
"""Error of a difference of pressure altitudes, in m: 25 ft steps, and altimeters that differ."""
DRIFT_M_S = 3.0
"""Growth of the error of an extrapolated position, in m/s."""
EXPLAINED_SIGMAS = 2.0
LARGER_THAN_IT_IS = 3.0
"""Factor on the size in the picture above which something is another, nearer thing."""
SMALLEST_PX = 4.0
ON_GROUND_HEIGHT_M = 2.0
"""Height of the middle of a mobile on the ground, in m, roughly."""
OWN_RANGE_M = 30.0
"""Distance from a camera, in m, within which a mobile is its carrier."""


class Traffic:
    """The last report of everybody with a transponder."""

    def __init__(self) -> None:
        self.ground_m: float | None = None
        """Pressure altitude of the ground, in m; None while it is not known."""
        self._reports: dict[str, AdsbReport] = {}
        self._heard_ns: dict[str, int] = {}
        self._velocities = VelocityChecks()

    def take_report(self, report: AdsbReport, t_ns: int) -> None:
        """Keep the last report of an aircraft or a vehicle, which arrived at a time."""
        self._heard_ns[report.icao24] = t_ns
        self._reports[report.icao24] = self._velocities.checked(report)

    def forget(self, t_ns: int) -> None:
        """Forget those of whom nothing arrived for a while."""
        for icao24, report in list(self._reports.items()):
            stale_ns = STALE_ON_GROUND_NS if report.on_ground else STALE_NS
            if t_ns - self._heard_ns[icao24] > stale_ns:
                del self._reports[icao24], self._heard_ns[icao24]

    def carrier(self, view: CameraView) -> AdsbReport | None:
        """Return the last report of the carrier of a camera, None if there is none."""
        return next((r for r in self._reports.values() if _name(r) == view.carrier), None)

    def addresses(self, *callsigns: str | None) -> tuple[str, ...]:
        """Return the addresses of those who are known by callsigns."""
        return tuple(r.icao24 for r in self._reports.values() if _name(r) in callsigns)

    def learn_ground(self, view: CameraView, t_ns: int) -> None:
        """Update the pressure altitude of the ground from the camera of an aircraft in flight."""
        report = self.carrier(view)
        if report is not None and report.altitude_ft is not None:
            climbed_m = report.vertical_rate_fpm * FOOT_PER_MINUTE * _age_s(report, t_ns)
            self.ground_m = report.altitude_ft * FOOT + climbed_m - view.height_m

    def explaining(self, geometry: PictureGeometry, box: Box, t_ns: int) -> str | None:
        """Return the callsign of whoever should be seen where a box is; None if nobody."""
        for report in self._reports.values():
            is_carrier = _name(report) == geometry.view.carrier
            if not is_carrier and self._fits(report, geometry, box, t_ns):
                return _name(report)
        return None

    def _fits(self, report: AdsbReport, geometry: PictureGeometry, box: Box, t_ns: int) -> bool:
        view, age_s = geometry.view, _age_s(report, t_ns)
        track, speed = report.track_deg * DEGREE, report.ground_speed_kt * KNOT
        north_m, east_m = offset_m(
            (view.latitude_deg * DEGREE, view.longitude_deg * DEGREE),
            (report.latitude_deg * DEGREE, report.longitude_deg * DEGREE),
        )
        north_m += speed * math.cos(track) * age_s
        east_m += speed * math.sin(track) * age_s
        up_m = self._height_m(report, age_s)
        up_m = None if up_m is None else up_m - view.height_m
        range_m = math.hypot(north_m, east_m, up_m or 0.0)
        if range_m < OWN_RANGE_M:
            return False
        if up_m is None:  # The direction alone counts.
            slope = math.tan(geometry.middle(box).elevation_rad)
            up_m = math.hypot(north_m, east_m) * slope
        place = geometry.pixel(Ray.towards(east_m, north_m, up_m))
        if place is None:
            return False
        half_size_m = HALF_SIZE_M.get(report.emitter_category, UNKNOWN_HALF_SIZE_M)
        error_m = NACP_95_PERCENT_M[report.nacp] + DRIFT_M_S * abs(age_s) + half_size_m
        room_px = EXPLAINED_SIGMAS * BOX_ERROR_PX
        across_px = error_m / range_m * geometry.focal_px + room_px
        along_px = (error_m + ALTITUDE_ERROR_M) / range_m * geometry.focal_px + room_px
        largest_px = (
            LARGER_THAN_IT_IS * 2.0 * half_size_m / range_m * geometry.focal_px + SMALLEST_PX
        )
        return (
            box[0] - across_px <= place[0] <= box[2] + across_px
            and box[1] - along_px <= place[1] <= box[3] + along_px
            and max(box[2] - box[0], box[3] - box[1]) <= largest_px
        )

    def _height_m(self, report: AdsbReport, age_s: float) -> float | None:
        """Return the height above the ground by a report; None if it is not known."""
        if report.altitude_ft is None:
            return ON_GROUND_HEIGHT_M
        if self.ground_m is None:
            return None
        climbed_m = report.vertical_rate_fpm * FOOT_PER_MINUTE * age_s
        return report.altitude_ft * FOOT + climbed_m - self.ground_m


def _age_s(report: AdsbReport, t_ns: int) -> float:
    return (t_ns - report.t_adsb_in_ns) / SECOND_NS


def _name(report: AdsbReport) -> str:
    return report.callsign or report.icao24
