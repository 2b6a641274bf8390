"""Recommended manoeuvres in words."""

from __future__ import annotations

from airhilt.messages import Climb, GoAround, MaintainLevel, Recommendation, Turn


def in_words(recommendation: Recommendation | None) -> str:
    """Return what somebody in flight is recommended."""
    match recommendation:
        case Climb(sense=sense, altitude_ft=altitude, vertical_rate_fpm=rate):
            return f"{sense} to {altitude:.0f} ft at {rate:.0f} ft/min"
        case MaintainLevel(altitude_ft=altitude):
            return f"maintain {altitude:.0f} ft"
        case Turn(degrees=degrees):
            return f"turn {'right' if degrees >= 0 else 'left'} {abs(degrees):.0f} degrees"
        case GoAround():
            return "go around"
        case _:
            return "maintain present level and track"
