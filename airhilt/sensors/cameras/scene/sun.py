"""The direction of the sun."""

from __future__ import annotations

import datetime
import math

import numpy as np
import numpy.typing as npt


def sun_direction(
    latitude_rad: float, date: datetime.date, solar_time_h: float
) -> npt.NDArray[np.float64]:
    """Return the unit vector towards the sun: east, north, up.

    Parameters
    ----------
    solar_time_h
        Local apparent solar time: the sun is highest at 12.

    Notes
    -----
    Declination by the Fourier series of J. W. Spencer, Search 2 (1971) 172, to 0.01 degrees, as in
    NOAA, General Solar Position Calculations. Refraction is left out.
    """
    year = math.tau / 365.0 * (date.timetuple().tm_yday - 1 + (solar_time_h - 12.0) / 24.0)
    declination = (
        0.006918
        - 0.399912 * math.cos(year)
        + 0.070257 * math.sin(year)
        - 0.006758 * math.cos(2.0 * year)
        + 0.000907 * math.sin(2.0 * year)
        - 0.002697 * math.cos(3.0 * year)
        + 0.00148 * math.sin(3.0 * year)
    )
    hour_angle = (solar_time_h - 12.0) * math.tau / 24.0
    east = -math.cos(declination) * math.sin(hour_angle)
    north = math.sin(declination) * math.cos(latitude_rad) - math.cos(declination) * math.cos(
        hour_angle
    ) * math.sin(latitude_rad)
    up = math.sin(declination) * math.sin(latitude_rad) + math.cos(declination) * math.cos(
        hour_angle
    ) * math.cos(latitude_rad)
    return np.array((east, north, up))
