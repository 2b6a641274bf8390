"""Usual spreads: the distribution of a perturbation that names none, by the kind of its number.

`USUAL_SPREADS` is the table. A spread without a source is called assumed. A scenario that would
be another one within a usual spread gives a narrower distribution of its own.
"""

from __future__ import annotations

from collections.abc import Mapping

from airhilt.scenario.models.scenario import Distribution, Normal, Uniform


def _normal(sigma: float, limit: float) -> Normal:
    return Normal(type="normal", sigma=sigma, limit=limit)


def _uniform(limit: float, least: float | None = None) -> Uniform:
    return Uniform(type="uniform", limit=limit, least=least)


ALONG_TRACK_NM = _normal(1.0, 2.0)
"""Along track, in flight: 15 s at 480 kt either way. Equipment that is told when to be at a point
meets that time within 30 s in 95 % (RTCA DO-236C, time of arrival control en route)."""
CROSS_TRACK_NM = _normal(0.05, 0.1)
"""Across track, in flight: within 0.1 NM in 95 %, as RNP AR APCH with RNP 0.1 asks for (ICAO Doc
9613, volume II, part C, chapter 6). That satellite navigation with an autopilot is as good en route
is assumed."""
FINAL_NM = _uniform(0.1)
"""Distance on final: 2.5 s at 140 kt. Assumed."""
LEVEL_FT = _normal(25.0, 50.0)
"""Level that is kept: an automatic height-keeping system keeps it within 65 ft (ICAO Doc 9574,
RVSM). Less here: two that are a level apart stay within the tolerance of 100 ft in `Separation`."""
AIRSPEED_KT = _uniform(10.0)
"""Calibrated airspeed: a change of less than 5 % of the true airspeed is none that a flight plan
states (ICAO Doc 4444, appendix 2, item 15); 10 kt are 4 % at 250 kt."""
LOAD = _uniform(0.05)
"""Mass: a twentieth of that of a 737 is about 28 people with baggage. Assumed."""
PLACE_M = _uniform(20.0)
"""Place on the ground: assumed."""
HEADING_DEG = _uniform(10.0)
"""Direction in which somebody stands: assumed."""
CALL_S = _uniform(4.0, least=0.0)
"""Time of a call: up to 4 s later, as speakers are busy. Assumed."""
RESPONSE_S = _uniform(1.0)
"""Delay from a call to what is done about it: half of the `CALL_S` of the response models. Assumed.
"""
EVENT_S = _uniform(3.0)
"""Time of an event, and time before a threshold at which something begins. Assumed."""
WIND_KT = _uniform(10.0)
"""Speed of the wind: forecasts differ from what aircraft meet by several m/s (root mean square of
the vector; Schwartz, Benjamin, Green and Jardin, Weather and Forecasting 15, 2000, 313-326)."""
WIND_DEG = _uniform(30.0)
"""Direction of the wind: assumed."""
GUSTS_KT = _uniform(5.0)
"""Wind at 20 ft that sets the turbulence: assumed."""

USUAL_SPREADS: Mapping[str, Distribution] = {
    "position/distance_nm": ALONG_TRACK_NM,
    "offset_nm": CROSS_TRACK_NM,
    "initial/distance_nm": FINAL_NM,
    "initial/altitude_ft": LEVEL_FT,
    "cas_kt": AIRSPEED_KT,
    "load": LOAD,
    "along_m": PLACE_M,
    "offset_m": PLACE_M,
    "before_m": PLACE_M,
    "heading_deg": HEADING_DEG,
    "lines/*/at_s": CALL_S,
    "delay_s": RESPONSE_S,
    "when/at_s": EVENT_S,
    "within_s": EVENT_S,
    "wind/speed_kt": WIND_KT,
    "from_deg": WIND_DEG,
    "wind_at_20ft_kt": GUSTS_KT,
}
"""Distributions by the end of a path; ``*`` stands for one name."""


def usual_spread(path: str) -> Distribution | None:
    """Return the usual distribution of the number that a path leads to, None if it has none."""
    chunks = path.strip("/").split("/")
    for end, spread in USUAL_SPREADS.items():
        pattern = end.split("/")
        last = chunks[-len(pattern) :]
        if len(last) == len(pattern) and all(
            asked in ("*", found) for asked, found in zip(pattern, last, strict=True)
        ):
            return spread
    return None
