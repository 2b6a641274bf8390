"""Manoeuvres of one aircraft, and the paths that it flies by them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.geodesy.relative_motion import Minima, Relative, VerticalProfile
from airhilt.units import DEGREE, STANDARD_GRAVITY

RESPONSE_S = 10.0
"""Time allowed for speech and for the reactions of crew and aircraft, in s; until then all fly on.

The standard pilot of TCAS II takes 5 s (ICAO Annex 10, volume IV); the voice takes the rest."""
CHANGED_RESPONSE_S = 7.5
"""The same for what changes an earlier advisory: the standard pilot takes 2.5 s then (the same)."""
BANK_RAD = 25.0 * DEGREE
"""Bank of a turn, in rad (ICAO Doc 8168, volume II, on the parameters of turns)."""
RATE_ONE_RAD_S = 3.0 * DEGREE
"""Greatest rate of a turn, in rad/s: at slow speeds it takes less than that bank (the same)."""
HORIZON_S = 600.0
"""Time for which paths are foreseen, in s."""
STEP_S = 2.0
TIMES_S = np.arange(0.0, HORIZON_S, STEP_S)
"""Times of the points of a path, in s from now."""

SOON_S = 180.0
"""Time, in s, for which a manoeuvre must keep clear of others: what is later is told in its time,
from an ADVISORY on."""
SOON_STEPS = int(SOON_S / STEP_S)

Array = npt.NDArray[np.float64]


class Manoeuvre(NamedTuple):
    """A manoeuvre of one aircraft: a level to fly to at a rate, and a turn, positive to the right.

    Both begin after the response.
    """

    target_m: float | None = None
    rate_m_s: float = 0.0
    turn_rad: float = 0.0


NONE = Manoeuvre()


def mirrored(manoeuvre: Manoeuvre, altitude_m: float) -> Manoeuvre:
    """Return the opposite of a manoeuvre that begins at an altitude."""
    target_m = manoeuvre.target_m
    return manoeuvre._replace(
        target_m=None if target_m is None else 2.0 * altitude_m - target_m,
        turn_rad=-manoeuvre.turn_rad,
    )


class Paths(NamedTuple):
    """Paths over the ground, a row for each path and a column for each of `TIMES_S`."""

    north_m: Array
    east_m: Array
    altitude_m: Array

    def soon(self, number: int) -> Paths:
        """Return one path, for `SOON_S`."""
        return Paths(*(values[number : number + 1, :SOON_STEPS] for values in self))


def paths(
    motion: Relative,
    profile: VerticalProfile,
    manoeuvres: Sequence[Manoeuvre],
    response_s: float = RESPONSE_S,
) -> Paths:
    """Return the paths of an aircraft by each of some manoeuvres.

    Parameters
    ----------
    motion
        Position and velocity of the aircraft at present.
    profile
        Climb or descent that is expected of it, until it responds and without another level.
    response_s
        Time until the manoeuvre begins.
    """
    turns_rad, rows = np.unique([each.turn_rad for each in manoeuvres], return_inverse=True)
    north_m, east_m = _courses(motion, turns_rad, response_s)
    return Paths(north_m[rows], east_m[rows], _levels(profile, manoeuvres, response_s))


def straight_paths(motions: Sequence[Relative], profiles: Sequence[VerticalProfile]) -> Paths:
    """Return the paths of several aircraft that fly on as expected, for `SOON_S`."""
    times_s = TIMES_S[:SOON_STEPS]
    north_m, east_m, north, east = np.array(motions).reshape(-1, 4, 1).swapaxes(0, 1)
    levels = [[each.altitude_m, each.rate_m_s, each.level_off_s()] for each in profiles]
    altitude_m, rate, level_off_s = np.array(levels).reshape(-1, 3, 1).swapaxes(0, 1)
    return Paths(
        north_m + north * times_s,
        east_m + east * times_s,
        altitude_m + rate * np.minimum(times_s, level_off_s),
    )


def separations(first: Paths, second: Paths, minima: Minima) -> Array:
    """Return the least separation of each two paths, in units of the minima.

    Separation at one time is the greater one of the horizontal and the vertical distance, each
    divided by its minimum: it is lost below 1.
    """
    north = (second.north_m - first.north_m) / minima.horizontal_m
    east = (second.east_m - first.east_m) / minima.horizontal_m
    up = (second.altitude_m - first.altitude_m) / minima.vertical_m
    squares = np.maximum(north * north + east * east, up * up)
    least: Array = np.sqrt(squares.min(axis=-1))
    return least


def turn_rate_rad_s(speed_m_s: float) -> float:
    """Return the rate of a turn at a speed: that of the bank, rate one at most."""
    if speed_m_s * RATE_ONE_RAD_S <= STANDARD_GRAVITY * np.tan(BANK_RAD):
        return RATE_ONE_RAD_S
    return float(STANDARD_GRAVITY * np.tan(BANK_RAD) / speed_m_s)


def _courses(motion: Relative, turns_rad: Array, response_s: float) -> tuple[Array, Array]:
    """Return where an aircraft is that flies on, turns at a steady rate, and flies straight on."""
    north, east = motion.velocity_north_m_s, motion.velocity_east_m_s
    rate = turn_rate_rad_s(float(np.hypot(north, east)))
    flown_s = np.maximum(TIMES_S - response_s, 0.0)
    turned = np.clip(rate * flown_s, 0.0, np.abs(turns_rad)[:, None])
    straight_s = TIMES_S - turned / rate
    side = np.sign(turns_rad)[:, None]
    sin_t, cos_t = np.sin(side * turned), np.cos(turned)
    # Before the turn and after it the aircraft flies straight, on the old and on the new track.
    before_s = np.minimum(TIMES_S, response_s)
    after_s = straight_s - before_s
    arc_ahead, arc_right = side * sin_t / rate, side * (1.0 - cos_t) / rate
    ahead = before_s + arc_ahead + after_s * cos_t
    right = arc_right + after_s * sin_t
    return (
        motion.north_m + north * ahead - east * right,
        motion.east_m + east * ahead + north * right,
    )


def _levels(profile: VerticalProfile, manoeuvres: Sequence[Manoeuvre], response_s: float) -> Array:
    """Return the levels of an aircraft that flies on by its profile, and then to a target."""
    begun_m = profile.at(response_s)
    targets_m = [begun_m if each.target_m is None else each.target_m for each in manoeuvres]
    to_go_m = np.array(targets_m)[:, None] - begun_m
    rates_m_s = np.array([each.rate_m_s for each in manoeuvres])[:, None]
    flown_m = np.minimum(rates_m_s * np.maximum(TIMES_S - response_s, 0.0), np.abs(to_go_m))
    levels: Array = begun_m + np.copysign(flown_m, to_go_m)
    expected = profile.altitude_m + profile.rate_m_s * np.minimum(TIMES_S, profile.level_off_s())
    levels[:, response_s >= TIMES_S] = expected[response_s >= TIMES_S]
    levels[[each.target_m is None for each in manoeuvres]] = expected
    return levels
