"""Surface surveillance of an airport: coverage, probability of detection and accuracy.

A surface movement radar receives the echo of whatever stands or moves on the airport. Receivers
around the airport locate each transponder by multilateration, and terminal radars add arrivals. All
of it is fused into one track for each target.

Sources
-------
AIM
    FAA Aeronautical Information Manual, 4-5-5 (ASDE-X and ASSC): the radar covers the surface and
    the airspace up to 200 ft above it, and shows aircraft and vehicles, both moving and fixed.
FAA
    FAA on the 35th ASDE-X, 2011 (avstop.com): aircraft flying within 5 miles of the airport.
OFCOM
    Final report on radars in the United Kingdom (yumpu.com 9312788, 3.2.3.4): surface movement
    radars have a range of about 2.5 NM.
ICAO
    Doc 9830, A-SMGCS Manual: positions once a second.
MOPS
    EUROCAE ED-116 (surface movement radar) and ED-117 (multilateration), as their limits are
    commonly quoted; neither was checked against its text. Radar: a target of 1 square metre,
    detected in 90 % of the turns. Multilateration: detected with 99.9 % within 2 s; error of 7.5 m
    (95 %) on runways and taxiways, 20 m on approach. The limits are taken as the values.

What is called an assumption has no published source.

Not modelled: false targets, reflections, shadows of buildings, rain, and targets that merge.
"""

from __future__ import annotations

import math

from airhilt.surveillance.transponders import SIGMA_PER_95_PERCENT
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS

PERIOD_NS = SECOND_NS
"""Period of the tracks, in ns (ICAO)."""
LATENCY_NS = SECOND_NS // 2
"""Time from a measurement to its track, in ns: an assumption."""
RADAR_RANGE_M = 2.5 * NAUTICAL_MILE
"""Distance from the airport within which the radar sees, in m (OFCOM)."""
RADAR_HEIGHT_M = 200.0 * FOOT
"""Height up to which the radar sees, in m (AIM)."""
TRANSPONDER_RANGE_M = 5.0 * NAUTICAL_MILE
"""Distance from the airport within which transponders are located, in m (FAA)."""
TRANSPONDER_HEIGHT_M = 2500.0 * FOOT
"""Height up to which transponders are located, in m: an assumption, that of class D airspace."""
LEAST_CROSS_SECTION_M2 = 1.0
"""Least radar cross section of a target, in square metres (MOPS): coyotes and birds are below it.

The radar never shows anything smaller: an assumption."""
RADAR_PROBABILITY = 0.90
"""Probability that the radar detects a target in one second (MOPS)."""
TRANSPONDER_PROBABILITY = 0.97
"""Probability that a transponder is located in one second: 99.9 % in two (MOPS)."""
SURFACE_95_PERCENT_M = 7.5
"""95 % position error on the ground, in m (MOPS)."""
APPROACH_95_PERCENT_M = 20.0
"""95 % position error in the air, in m (MOPS)."""
SPEED_95_PERCENT_M_S = 1.5
"""95 % velocity error of a track, in m/s: an assumption, 3 kt."""
CORRELATION_S = 5.0
"""Time constant of the errors, in s, because tracks are filtered: an assumption."""
KEPT_CORRELATION = math.exp(-PERIOD_NS / SECOND_NS / CORRELATION_S)
"""Part of an error that is left in the next track of a target."""
LOST_AFTER_NS = 5 * SECOND_NS
"""Time without detection after which a target gets a new track number, in ns: an assumption."""


def sigma(ninety_five_percent: float) -> float:
    """Return the standard deviation of each axis of an error, for its 95 % radius."""
    return ninety_five_percent * SIGMA_PER_95_PERCENT
