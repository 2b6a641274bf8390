"""Resolution advisories of TCAS II: which sense, and how strong.

Both are those of FAA, Introduction to TCAS II Version 7.1 (2011), section on the selection of
resolution advisories. Upward and downward advisories are modelled for the standard response of a
pilot, against an intruder that keeps its vertical rate. The sense with the greater separation at
the closest approach is chosen, but one that does not cross the intruder's altitude if that gives
ALIM. Of an aircraft that coordinates, the opposite of its sense is. The strength is the weakest
that gives ALIM.

Once ALIM is reached, an advisory to climb or descend is weakened to level off, if that keeps ALIM.

The sense is reversed if the one in force, strengthened, does not avoid a near collision and the
other one does (version 7.1, also against an aircraft that coordinates). So it is while the two
remain within 100 ft because the own crew goes the wrong way. FAA's text has no threshold for the
separation that fails: that of a near collision is an assumption.

Left out: limits other than level flight, and limits of the aircraft's performance. A crew that has
advisories against two threats stays with the sense that it was told first.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from airhilt.units import FOOT, FOOT_PER_MINUTE, STANDARD_GRAVITY

Sense = Literal["climb", "descend"]

RATE_M_S = 1500 * FOOT_PER_MINUTE
"""Vertical rate of a first advisory to climb or descend, in m/s."""
INCREASED_RATE_M_S = 2500 * FOOT_PER_MINUTE
"""Vertical rate of an advisory to increase the climb or descent, in m/s."""
RESPONSE_S = 5.0
"""Time until a crew responds to a first advisory, in s (ICAO Annex 10, volume IV, 4.4.2)."""
ACCELERATION_M_S2 = 0.25 * STANDARD_GRAVITY
"""Vertical acceleration of the response, in m/s^2 (as above)."""
CHANGED_RESPONSE_S = 2.5
"""Time until a crew responds to an increase or a reversal, in s (as above)."""
CHANGED_ACCELERATION_M_S2 = 0.35 * STANDARD_GRAVITY
"""Vertical acceleration of the response to an increase or a reversal, in m/s^2 (as above)."""
NEAR_COLLISION_M = 100 * FOOT
"""Separation below which an advisory has failed, in m: that of a near mid-air collision."""
NO_DESCENT_BELOW_M = 1100 * FOOT
"""Height above the ground below which there is no advisory to descend, in m."""
NO_INCREASED_DESCENT_BELOW_M = 1550 * FOOT
"""Height above the ground below which no descent is to be increased, in m."""


class Vertical(NamedTuple):
    """Altitude and vertical rate."""

    altitude_m: float
    rate_m_s: float

    def at(self, time_s: float) -> float:
        """Return the altitude after a time at the same rate."""
        return self.altitude_m + self.rate_m_s * time_s


class Resolution(NamedTuple):
    """A vertical advisory: a sense, and the least rate in it; 0 to level off."""

    sense: Sense
    rate_m_s: float


def opposite(sense: Sense) -> Sense:
    """Return the other sense."""
    return "descend" if sense == "climb" else "climb"


def select(
    own: Vertical,
    intruder: Vertical,
    time_s: float,
    alim_m: float,
    *,
    required: Sense | None,
    may_descend: bool,
) -> Resolution:
    """Return the first advisory against an intruder, by the time to the closest approach.

    The coordination with the intruder, or an advisory in force, may leave only the ``required``
    sense. Who may not descend, near the ground, is left to level off where that is required.
    """
    sense = required or _best_sense(own, intruder, time_s, alim_m)
    if sense == "descend" and not may_descend:
        if required is not None:
            return Resolution(sense, 0.0)
        sense = "climb"
    for rate_m_s in (0.0, RATE_M_S):
        resolution = Resolution(sense, rate_m_s)
        if separation_m(own, intruder, resolution, time_s, RESPONSE_S) >= alim_m:
            return resolution
    return Resolution(sense, RATE_M_S)


def is_insufficient(
    own: Vertical, intruder: Vertical, resolution: Resolution, time_s: float, alim_m: float
) -> bool:
    """Return whether an advisory that the crew carries out from now on does not give ALIM."""
    return separation_m(own, intruder, resolution, time_s, 0.0) < alim_m


def may_weaken(
    own: Vertical, intruder: Vertical, sense: Sense, time_s: float, alim_m: float
) -> bool:
    """Return whether ALIM is reached, and levelling off keeps it to the closest approach."""
    level = Resolution(sense, 0.0)
    now_m = own.altitude_m - intruder.altitude_m
    has_room = (now_m if sense == "climb" else -now_m) >= alim_m
    return has_room and separation_m(own, intruder, level, time_s, RESPONSE_S) >= alim_m


def reversal(
    own: Vertical,
    intruder: Vertical,
    present: Resolution,
    time_s: float,
    *,
    departs: bool,
    coordinates: bool,
) -> Resolution | None:
    """Return the advisory of the other sense; None if the present one is to stay.

    A crew that ``departs`` from its advisory is expected to fly on as it does, and an intruder that
    ``coordinates`` to follow the reversal then. That counts while the two are at one altitude.
    There is no reversal that nobody has the time to respond to.
    """
    if time_s <= CHANGED_RESPONSE_S:
        return None
    other = Resolution(opposite(present.sense), RATE_M_S)
    departs = departs and abs(own.altitude_m - intruder.altitude_m) < NEAR_COLLISION_M
    kept_m = own.at(time_s) if departs else _changed_m(own, present, time_s)
    there_m = intruder.at(time_s)
    follows = departs and coordinates
    expected_m = (
        _changed_m(intruder, Resolution(present.sense, RATE_M_S), time_s) if follows else there_m
    )
    up = 1.0 if present.sense == "climb" else -1.0
    fails = up * (kept_m - there_m) < NEAR_COLLISION_M
    works = up * (expected_m - _changed_m(own, other, time_s)) >= NEAR_COLLISION_M
    return other if fails and works else None


def _changed_m(own: Vertical, resolution: Resolution, time_s: float) -> float:
    return _modelled_m(own, resolution, time_s, CHANGED_RESPONSE_S, CHANGED_ACCELERATION_M_S2)


def separation_m(
    own: Vertical, intruder: Vertical, resolution: Resolution, time_s: float, response_s: float
) -> float:
    """Return the separation at the closest approach, negative on the wrong side of the intruder."""
    above_m = _modelled_m(own, resolution, time_s, response_s) - intruder.at(time_s)
    return above_m if resolution.sense == "climb" else -above_m


def _best_sense(own: Vertical, intruder: Vertical, time_s: float, alim_m: float) -> Sense:
    separations = {
        sense: separation_m(own, intruder, Resolution(sense, RATE_M_S), time_s, RESPONSE_S)
        for sense in ("climb", "descend")
    }
    best: Sense = "climb" if separations["climb"] >= separations["descend"] else "descend"
    not_crossing: Sense = "climb" if own.altitude_m >= intruder.altitude_m else "descend"
    return not_crossing if separations[not_crossing] >= alim_m else best


def _modelled_m(
    own: Vertical,
    resolution: Resolution,
    time_s: float,
    response_s: float,
    acceleration_m_s2: float = ACCELERATION_M_S2,
) -> float:
    """Return the own altitude after a time, if the crew responds as the standard pilot does."""
    up = 1.0 if resolution.sense == "climb" else -1.0
    rate_m_s = up * max(up * own.rate_m_s, resolution.rate_m_s)
    if resolution.rate_m_s == 0.0:
        rate_m_s = 0.0
    left_s = max(time_s - response_s, 0.0)
    change_m_s = rate_m_s - own.rate_m_s
    changing_s = min(abs(change_m_s) / acceleration_m_s2, left_s)
    acceleration = math.copysign(acceleration_m_s2, change_m_s)
    return (
        own.at(time_s - left_s + changing_s)
        + 0.5 * acceleration * changing_s**2
        + rate_m_s * (left_s - changing_s)
    )
