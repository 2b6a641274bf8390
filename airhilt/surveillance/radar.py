"""Surveillance radar: its range, its probability of detection and its accuracy.

A primary radar measures the echo of a target's skin. A monopulse secondary radar on the same
antenna measures the reply of its transponder. Range is the slant range, azimuth is the true bearing
from the antenna.

Sources
-------
FAA
    "Airport Surveillance Radar (ASR-11)", page of the FAA at faa.gov/air_traffic/technology/asr-11:
    the primary radar reaches 60 NM.
CARDS
    Card index of radar sets, radartutorial.eu: ASR-11 (under DASR) with 60 NM and 12 turns a
    minute; ARSR-3 with 5 turns a minute, 310 to 365 pulses a second and 240 NM.
STUDY
    Next Generation Airport Surveillance Radar Definition Study, FAA, 1974 (DTIC ADA072691): an
    aircraft of 1 square metre out to 40 NM, elevation angles to 30 degrees, instrumented to 60 NM.
STANDARD
    EUROCONTROL Standard Document for Radar Surveillance in En-Route Airspace and Major Terminal
    Areas, SUR.ET1.ST01.1000-STD-01-01, edition 1.0, 1997. Primary radar: probability of detection
    above 90 % (6.4.2.1; also UK CAP 670, SUR 02.40), random errors below 120 m and 0.15 degrees
    (6.4.3.1). Secondary radar: probability of detection above 97 % (6.3.2.1); errors of a monopulse
    radar below 70 m and 0.08 degrees, valid codes above 98 % and 96 % (6.3, not checked against the
    text). The limits are taken as the values.
COVERAGE
    CAP 670, Air Traffic Services Safety Requirements, UK CAA, requirement 458 (paragraph 13.1.2 of
    its section on radar, in an edition before 2012): a primary radar detects a target of 1 square
    metre, of Swerling case 1, with a probability of 80 % where it serves, and of 90 % for
    approaches by radar.
SKOLNIK
    M. Skolnik, "Radar", Encyclopaedia Britannica, and Introduction to Radar Systems, 3rd edition,
    table 2.2: radar cross sections; 2 square metres is the least that air traffic control asks for.

The standard's 90 % is of all traffic, whatever its size. That it holds for the smallest aircraft at
the study's range is an assumption that favours the radar: COVERAGE asks for 80 % in general.

Figures called typical are usual for such radars; no specification gives them.

Not modelled: systematic errors of range and north, false plots, reflections, garbled replies,
weather, terrain, and the reduced sensitivity at short range that hides birds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from airhilt.geodesy.relative_motion import Kinematics
from airhilt.geodesy.wgs84 import (
    MEAN_RADIUS_M,
    Place,
    dot,
    earth_centred,
    horizontal_axes,
    onward,
    vertical,
)
from airhilt.messages import EmitterCategory, RadarInfo, RadarKind, RadarPlot
from airhilt.surveillance.squitters import quantise
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE

FALSE_ALARM_PROBABILITY = 1e-6
"""Probability of a false alarm in one resolution cell, a typical design value."""
RANGE_STEP_M = NAUTICAL_MILE / 256.0
"""Resolution of a plot's range, in m (EUROCONTROL ASTERIX category 048, item I048/040)."""
AZIMUTH_STEP_DEG = 360.0 / 65536.0
"""Resolution of a plot's azimuth, in degrees (EUROCONTROL ASTERIX category 048, item I048/040)."""
MODE_C_STEP_FT = 100.0
"""Resolution of the altitude in a Mode C reply, in ft (ICAO Annex 10, volume IV)."""

AIRCRAFT_CROSS_SECTION_M2: dict[EmitterCategory, float] = {
    "A0": 2.0,
    "A1": 1.0,
    "A2": 2.0,
    "A3": 20.0,
    "A5": 100.0,
}
"""Radar cross section of aircraft by emitter category, in square metres (SKOLNIK, table 2.2).

A1 is a small single-engine aircraft, A2 a four-passenger jet, A3 a medium airliner, A5 a jumbo jet.
A0, no information, is the least that radars must detect.
"""


class Accuracy(NamedTuple):
    """Standard deviations of the random errors of a plot."""

    range_m: float
    azimuth_deg: float


PRIMARY_ACCURACY = Accuracy(120.0, 0.15)
"""Random errors of a primary radar (STANDARD, 6.4.3.1)."""
SECONDARY_ACCURACY = Accuracy(70.0, 0.08)
"""Random errors of a monopulse secondary radar (STANDARD, 6.3)."""
REFERENCE_PROBABILITY = 0.90
"""Probability that a primary radar detects its reference target in one turn (STANDARD, 6.4.2.1)."""
SECONDARY_PROBABILITY = 0.97
"""Probability of detecting a transponder in one turn (STANDARD, 6.3.2.1)."""
MODE_A_PROBABILITY = 0.98
"""Probability that a detected transponder's Mode A code is valid (STANDARD, 6.3)."""
MODE_C_PROBABILITY = 0.96
"""Probability that a detected transponder's Mode C altitude is valid (STANDARD, 6.3)."""
MAXIMUM_ELEVATION_RAD = 30.0 * DEGREE
"""Elevation above which a radar sees nothing, its cone of silence, in rad (STUDY)."""


@dataclass(frozen=True, kw_only=True)
class RadarModel:
    """Performance of one kind of radar.

    Attributes
    ----------
    rotation_s
        Time of one turn of the antenna.
    minimum_range_m, primary_range_m, secondary_range_m
        Slant ranges between which there are plots.
    reference_cross_section_m2, reference_range_m
        Design point of the primary radar: the target, and the range at which it is detected in one
        turn with `REFERENCE_PROBABILITY`.
    clutter_speed_m_s
        Radial speed below which the primary radar takes a target for the ground, where it sees the
        ground: one Doppler filter of eight, wavelength times pulse rate over 16.
    """

    rotation_s: float
    minimum_range_m: float
    primary_range_m: float
    secondary_range_m: float
    reference_cross_section_m2: float
    reference_range_m: float
    clutter_speed_m_s: float

    def detection_probability(self, cross_section_m2: float, range_m: float) -> float:
        """Return the probability that the primary radar detects a target in one turn.

        The radar equation gives the signal-to-noise ratio from that of the design point; the target
        fluctuates from turn to turn (Swerling case 1: COVERAGE; SKOLNIK, section 2.8), for which
        the probability is that of a false alarm to the power of 1 / (1 + ratio).
        """
        false_alarm = math.log(FALSE_ALARM_PROBABILITY)
        reference = false_alarm / math.log(REFERENCE_PROBABILITY) - 1.0
        size = cross_section_m2 / self.reference_cross_section_m2
        ratio = reference * size * (self.reference_range_m / range_m) ** 4
        return math.exp(false_alarm / (1.0 + ratio))


RADARS: dict[RadarKind, RadarModel] = {
    # Modelled on the ASR-11. Primary range: FAA. 12.5 turns a minute (CARDS: 12), the least range,
    # the secondary range, and 1200 pulses a second at 0.107 m are typical.
    "terminal": RadarModel(
        rotation_s=4.8,
        minimum_range_m=0.5 * NAUTICAL_MILE,
        primary_range_m=60.0 * NAUTICAL_MILE,
        secondary_range_m=120.0 * NAUTICAL_MILE,
        reference_cross_section_m2=1.0,
        reference_range_m=40.0 * NAUTICAL_MILE,
        clutter_speed_m_s=8.0,
    ),
    # Modelled on the ARSR-4. Rotation, and 340 pulses a second at 0.23 m: those of the ARSR-3
    # (CARDS). The ranges, 5 to 250 NM, are typical. The design point is the least target of
    # SKOLNIK at 200 NM, a range that is typical too.
    "en_route": RadarModel(
        rotation_s=12.0,
        minimum_range_m=5.0 * NAUTICAL_MILE,
        primary_range_m=250.0 * NAUTICAL_MILE,
        secondary_range_m=250.0 * NAUTICAL_MILE,
        reference_cross_section_m2=2.0,
        reference_range_m=200.0 * NAUTICAL_MILE,
        clutter_speed_m_s=5.0,
    ),
}
"""Performance of each kind of radar."""


class LineOfSight(NamedTuple):
    """Direction and distance of a target from an antenna."""

    range_m: float
    """Slant range."""
    azimuth_rad: float
    """True azimuth, in [0, 2 pi)."""
    elevation_rad: float
    """Elevation above the antenna's horizontal plane, without refraction."""

    @property
    def horizontal_m(self) -> float:
        """Distance in the antenna's horizontal plane."""
        return self.range_m * math.cos(self.elevation_rad)


class Antenna:
    """The place of a radar's antenna, and the directions seen from it."""

    def __init__(self, latitude_rad: float, longitude_rad: float, altitude_m: float) -> None:
        self.latitude_rad = latitude_rad
        self.longitude_rad = longitude_rad
        self.altitude_m = altitude_m
        place = (latitude_rad, longitude_rad)
        self._place = earth_centred(place, altitude_m)
        self._axes = (*horizontal_axes(place), vertical(place))

    def to(self, target: Kinematics) -> LineOfSight:
        """Return the line of sight to a target."""
        x, y, z = earth_centred((target.latitude_rad, target.longitude_rad), target.altitude_m)
        line = (x - self._place[0], y - self._place[1], z - self._place[2])
        east, north, up = (dot(line, axis) for axis in self._axes)
        return LineOfSight(
            math.hypot(east, north, up),
            math.atan2(east, north) % math.tau,
            math.atan2(up, math.hypot(east, north)),
        )


def plot_place(info: RadarInfo, plot: RadarPlot) -> tuple[Place, float]:
    """Return the place of a plot, and its height in m.

    Without an altitude in the reply it is taken to be as high as the antenna.
    """
    height_m = info.altitude_m if plot.mode_c_ft is None else plot.mode_c_ft * FOOT
    antenna = info.latitude_deg * DEGREE, info.longitude_deg * DEGREE
    ground_m = _ground_range_m(plot.range_m, info.altitude_m, height_m)
    return onward(antenna, plot.azimuth_deg * DEGREE, ground_m), height_m


def _ground_range_m(slant_m: float, antenna_m: float, height_m: float) -> float:
    """Return the distance along the ground to a target at a slant range and a height, in m."""
    first, second = MEAN_RADIUS_M + antenna_m, MEAN_RADIUS_M + height_m
    cosine = (first**2 + second**2 - slant_m**2) / (2.0 * first * second)
    return MEAN_RADIUS_M * math.acos(min(max(cosine, -1.0), 1.0))


def mode_c_ft(altitude_m: float) -> int:
    """Return the pressure altitude as a Mode C reply has it, in ft."""
    return round(quantise(altitude_m / FOOT, MODE_C_STEP_FT))


def discrete_code(icao24: str) -> str:
    """Return a Mode A code for an aircraft to which the scenario gives none.

    It is a discrete code (not ending in 00) below 7000, so none of those with a meaning.
    """
    number = int(icao24, 16)
    return f"{0o10 + number % 48:02o}{1 + number // 48 % 63:02o}"
