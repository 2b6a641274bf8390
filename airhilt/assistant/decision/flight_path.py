"""Birds in the air, and aircraft that only cameras show, in the path of a runway's user."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.assistant.decision.aerodrome import Vector
from airhilt.assistant.decision.findings import Obstructs
from airhilt.assistant.decision.line_of_sight import AirFix
from airhilt.assistant.decision.mobiles import FINAL_M, TOUCHDOWN_M, Use
from airhilt.assistant.decision.occupancy import SeenAloft
from airhilt.assistant.decision.threats import (
    UNIDENTIFIED,
    WILDLIFE,
    Outlook,
    Threat,
    obstruction,
)
from airhilt.messages import Severity

FLIGHT_PATH_M = 60.0
"""Birds that will be no farther beside the flight path, in m, are in it."""
FLIGHT_PATH_HEIGHT_M = 40.0
"""Likewise no farther above or below, in m."""
BIRDS_WANDER_M_S = 3.0
"""Rate at which birds stray from a straight line, in m/s."""
BIRDS_BESIDE_M = 300.0
"""Birds in the air that are no farther beside the flight path, in m, may get into it."""
BIRDS_ABOVE_M = 100.0
"""Likewise no farther above it, in m."""
BIRDS_FORESEEN_S = 25.0
"""Time for which birds are taken to fly straight on, in s."""
CLIMB_OUT_HEIGHT_M = 150.0
"""Height below which birds over a runway are in the way of a departure, in m."""
LEAST_CLOSING = 0.1
"""Least closing speed, as a share of the arrival's speed, at which something ahead is met."""
BIRDS_LIKELY = 0.3
"""Share of the places of birds of unknown distance that must be in the path."""


def in_flight_path(outlook: Outlook, use: Use) -> Iterator[Threat]:
    """Yield what is, or will be, in the air where a runway's user flies."""
    if use.kind == "rollout" or use.is_climbing:
        return
    how: Obstructs = "airborne on final for" if use.kind == "arrival" else "airborne over"
    for thing in outlook.situation.aloft:
        severity, time_to_go_s = _urgency(outlook, use, thing)
        if severity is not None:
            yield obstruction(
                use,
                how,
                "birds" if thing.are_birds else "unidentified aircraft",
                severity,
                time_to_go_s,
                ("vision", "adsb"),
                unnamed=WILDLIFE if thing.are_birds else UNIDENTIFIED,
                tracks=thing.tracks,
                rule="flight_path",
            )


def _urgency(outlook: Outlook, use: Use, thing: SeenAloft) -> tuple[Severity | None, float | None]:
    """Return how severe it is that something is in the air, and the time until it is met."""
    times = (_meets_s(outlook, use, thing, place) for place in thing.places)
    met = [time_s for time_s in times if time_s is not None]
    if met and len(met) >= BIRDS_LIKELY * len(thing.places):
        time_to_go_s = min(met)
        severity = outlook.urgency(use, time_to_go_s)
        if severity is Severity.WARNING and not thing.is_located:
            severity = Severity.CAUTION
        return severity, time_to_go_s
    if thing.is_located:
        abeam_s = _time_abeam_s(outlook, use, thing.places[0])
        if abeam_s is not None and _are_beside(outlook, use, thing.places[0]):
            return outlook.urgency(use, abeam_s) and Severity.CAUTION, abeam_s
    return None, None


def _meets_s(outlook: Outlook, use: Use, thing: SeenAloft, place: AirFix) -> float | None:
    """Return the time until a runway's user meets what flies straight on; None if it does not."""
    east, north, up = thing.velocity
    ahead = use.direction.ahead
    time_s = _time_abeam_s(outlook, use, place, east * ahead.east + north * ahead.north)
    if time_s is None:
        return None
    flown_s = min(time_s, BIRDS_FORESEEN_S)
    point = Vector(place.point.east + east * flown_s, place.point.north + north * flown_s)
    low_m, high_m = sorted((place.height_m, max(place.height_m + up * flown_s, 0.0)))
    room_m = 2.0 * place.error_m + BIRDS_WANDER_M_S * flown_s * thing.is_located
    if abs(use.direction.across_m(point)) > FLIGHT_PATH_M + room_m:
        return None
    room_m += FLIGHT_PATH_HEIGHT_M
    path_m = _height_m(outlook, use, use.direction.along_m(point))
    if use.mobile.on_ground:  # Until then it may be anywhere below.
        return time_s if low_m <= CLIMB_OUT_HEIGHT_M + room_m else None
    return time_s if low_m - room_m <= path_m <= high_m + room_m else None


def _are_beside(outlook: Outlook, use: Use, place: AirFix) -> bool:
    """Return whether birds in the air are near enough to get into the flight path."""
    path_m = _height_m(outlook, use, use.direction.along_m(place.point))
    is_near = abs(use.direction.across_m(place.point)) <= BIRDS_BESIDE_M
    return is_near and place.height_m <= path_m + BIRDS_ABOVE_M


def _time_abeam_s(
    outlook: Outlook, use: Use, place: AirFix, ahead_m_s: float = 0.0
) -> float | None:
    """Return the time until a runway's user is abeam of a moving position; None if never."""
    along_m = use.direction.along_m(place.point)
    if not -FINAL_M <= along_m <= use.direction.length_m:
        return None
    time_s = use.time_to_s(along_m, outlook.t_ns)
    if time_s is None or use.kind != "arrival":
        return time_s
    closing = 1.0 - ahead_m_s / max(use.mobile.speed_m_s, 1.0)
    return time_s / closing if closing > LEAST_CLOSING else None


def _height_m(outlook: Outlook, use: Use, along_m: float) -> float:
    """Return the height of an arrival above the ground at a distance past the threshold, in m."""
    mobile = use.mobile
    if mobile.altitude_m is None:
        return 0.0
    left_m = TOUCHDOWN_M - use.along_m
    height_m = mobile.altitude_m - outlook.situation.aerodrome.ground_m
    return height_m * max(TOUCHDOWN_M - along_m, 0.0) / left_m if left_m > 0.0 else 0.0
