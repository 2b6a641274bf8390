"""An airport at one instant: what was reported, said and seen, without a worker."""

from __future__ import annotations

import math
from typing import Any

from airfield import BRIEFING, ELEVATION_M, NORTH, Axis, degrees
from airhilt.assistant.decision.aerodrome import Aerodrome, Direction, Strip
from airhilt.assistant.decision.assessment import worst_threats
from airhilt.assistant.decision.findings import Obstruction
from airhilt.assistant.decision.line_of_sight import AirFix, GroundFix
from airhilt.assistant.decision.mobiles import Mobile, Use
from airhilt.assistant.decision.occupancy import SeenAloft, SeenOnGround
from airhilt.assistant.decision.situation import RunwaySituation, SeenObstacle
from airhilt.assistant.decision.threats import RunwayConfig, Threat
from airhilt.messages import AdsbReport, SurfaceTrack
from airhilt.units import DEGREE, FOOT, KNOT, SECOND_NS
from decisions import transcript

assert BRIEFING.airport is not None
AERODROME = Aerodrome(BRIEFING.airport)
CONFIG = RunwayConfig()
BEGIN_S = 100.0
"""Time from which the times of a test count, in s."""


def at(t_s: float) -> int:
    return round((BEGIN_S + t_s) * SECOND_NS)


def runway(ident: str) -> tuple[Strip, Direction]:
    strip = AERODROME.strip_of(ident)
    assert strip is not None
    return strip, next(each for each in strip.directions if each.ident == ident)


def crossing_m(axis: Axis) -> float:
    """Return how far past a threshold the centre lines cross."""
    point = AERODROME.crossing(*AERODROME.strips)
    assert point is not None
    return runway(axis.ident)[1].along_m(point)


def surface_track(
    along_m: float, across_m: float = 0.0, speed_m_s: float = 0.0, *, t_s: float = 0.0,
    number: int = 1, axis: Axis = NORTH, turned_deg: float | None = 0.0,
    height_m: float | None = None, **given: Any,
) -> SurfaceTrack:  # fmt: skip
    """Return a track of surface surveillance without a name, unless it is given."""
    latitude, longitude = degrees(axis.local(along_m, across_m))
    usual = {
        "airport": "XFLD", "track": number, "kind": "combined", "accuracy_m": 7.5,
        "t_track_ns": round(t_s * SECOND_NS), "latitude_deg": latitude, "longitude_deg": longitude,
        "altitude_ft": None if height_m is None else (ELEVATION_M + height_m) / FOOT,
        "on_ground": height_m is None, "ground_speed_kt": speed_m_s / KNOT,
        "track_deg": None if turned_deg is None else (axis.course_deg + turned_deg) % 360.0,
        "icao24": None, "callsign": None,
    }  # fmt: skip
    return SurfaceTrack.model_validate(usual | given)


def report(
    callsign: str | None, along_m: float, across_m: float = 0.0, speed_m_s: float = 0.0, *,
    axis: Axis = NORTH, height_m: float | None = None, turned_deg: float = 0.0, t_s: float = 0.0,
    rate_fpm: float = 0.0, category: str | None = "A3", icao24: str | None = None,
) -> AdsbReport:  # fmt: skip
    latitude, longitude = degrees(axis.local(along_m, across_m))
    return AdsbReport.model_validate(
        {
            "icao24": icao24 or (callsign or "?").encode().hex()[-6:].rjust(6, "0"),
            "callsign": callsign, "t_adsb_in_ns": at(t_s), "t_adsb_out_ns": 0,
            "latitude_deg": latitude, "longitude_deg": longitude,
            "altitude_ft": None if height_m is None else (ELEVATION_M + height_m) / FOOT,
            "ground_speed_kt": speed_m_s / KNOT,
            "track_deg": (axis.course_deg + turned_deg) % 360.0, "vertical_rate_fpm": rate_fpm,
            "nacp": 9, "nacv": 2, "receiver": "tower", "on_ground": height_m is None,
            "emitter_category": category,
        }
    )  # fmt: skip


def arrival(
    callsign: str, to_go_s: float, *, axis: Axis = NORTH, speed_m_s: float = 70.0, **given: Any
) -> AdsbReport:
    """Return the report of one on a glide path of 3 degrees, so long before the threshold."""
    before_m = to_go_s * speed_m_s
    return report(
        callsign, -before_m, 0.0, speed_m_s, axis=axis, height_m=(before_m + 400.0) * 0.0524,
        rate_fpm=-700.0, **given,
    )  # fmt: skip


def landed(callsign: str, along_m: float, speed_m_s: float) -> tuple[AdsbReport, AdsbReport]:
    """Return the reports of one that has just touched down."""
    return (
        report(callsign, along_m - 1.0, 0.0, speed_m_s, height_m=3.0, rate_fpm=-300.0, t_s=-3.0),
        report(callsign, along_m, 0.0, speed_m_s),
    )


class Field:
    """An airport with what was reported and said at it."""

    def __init__(self, *reports: AdsbReport) -> None:
        assert BRIEFING.airport is not None
        self.situation = RunwaySituation(BRIEFING.airport, BRIEFING)
        for each in reports:
            self.situation.take_report(each, each.t_adsb_in_ns)

    def hears(self, end_s: float, text: str) -> Field:
        end_ns = at(end_s)
        given = transcript(f"at {end_s:g}", 119_100, end_ns - 2 * SECOND_NS, end_ns, text)
        self.situation.take_transcript(given)
        return self

    def mobile(self, callsign: str) -> Mobile:
        found = self.situation.mobile(callsign)
        assert found is not None
        return found

    def use(self, callsign: str) -> Use:
        found = self.situation.use(self.mobile(callsign))
        assert found is not None
        return found

    def threats(self, t_s: float = 0.0, config: RunwayConfig = CONFIG) -> list[Threat]:
        return list(worst_threats(config, self.situation, at(t_s)).values())

    def obstructions(self, t_s: float = 0.0) -> list[tuple[str, str, str, str]]:
        """Return who is obstructed, how, by what, and how severely."""
        return [
            (each.finding.user, each.finding.how, each.finding.what, each.severity.value)
            for each in self.threats(t_s)
            if isinstance(each.finding, Obstruction)
        ]

    def in_force(self) -> list[tuple[str, str]]:
        found = self.situation.clearances.in_force(at(0.0))
        return [(each.callsign, each.action) for each in found]


def seen(
    field: Field, *, label: Any = "truck", is_animal: bool = False, along_m: float = 800.0,
    **given: Any,
) -> Field:  # fmt: skip
    """Let something be seen on runway 01 that stands there for certain, unless given otherwise."""
    strip, direction = runway("01")
    fix = GroundFix(direction.point(along_m), 1.0, 1.0, 0.0)
    thing = SeenOnGround(label, is_animal, fix, 0.9, True, ())
    usual: dict[str, Any] = {"speed_m_s": 0.0, "exit_m": 20.0, "weight": 0.9, "is_certain": True}
    field.situation._seen = {strip.name: [SeenObstacle(thing, **usual | given)]}
    return field


def aloft(
    field: Field, *places: tuple[float, float, float], error_m: float = 0.0, are_birds: bool = True,
    along_m_s: float = 0.0, right_m_s: float = 0.0, up_m_s: float = 0.0, is_located: bool = True,
) -> Field:  # fmt: skip
    """Let something be seen in the air at some places: along runway 01, to the right, and up."""
    sin, cos = math.sin(NORTH.course_deg * DEGREE), math.cos(NORTH.course_deg * DEGREE)
    velocity = (along_m_s * sin + right_m_s * cos, along_m_s * cos - right_m_s * sin, up_m_s)
    fixes = tuple(
        AirFix(
            field.situation.aerodrome.locate(*degrees(NORTH.local(along_m, right_m))), height_m,
            error_m, error_m,
        )
        for along_m, right_m, height_m in places
    )  # fmt: skip
    field.situation.aloft = (SeenAloft(are_birds, fixes, velocity, is_located, at(0.0), ()),)
    return field
