"""Well clear is lost, and told of, when NASA's DAIDALUS says so."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.geodesy.relative_motion import Relative
from airhilt.surveillance.well_clear import (
    CORRECTIVE,
    LEVELS,
    PREVENTIVE,
    WARNING,
    AlertName,
    Gap,
    Volume,
    level_of,
    time_to_violation_s,
)
from airhilt.units import FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE

LEVEL = Gap(0.0, 0.0)


def meets(in_s: float, speed_kt: float, miss_nm: float = 0.0) -> Relative:
    """Return one that passes in some seconds, at a relative speed and a miss distance."""
    speed = speed_kt * KNOT
    return Relative(speed * in_s, miss_nm * NAUTICAL_MILE, -speed, 0.0)


def first_s(name: AlertName, speed_kt: float, rate_fpm: float = 0.0) -> int | None:
    """Return how long before the closest approach an alert of a level, or a worse one, begins."""
    ranks = {level.name: rank for rank, level in enumerate(LEVELS)}
    for in_s in range(200, 0, -1):
        rate = rate_fpm * FOOT_PER_MINUTE
        level = level_of(meets(in_s, speed_kt), Gap(-rate * in_s, rate))
        if level is not None and ranks[level.name] <= ranks[name]:
            return in_s
    return None


def test_alerts_begin_when_those_of_daidalus_do(subtests: pytest.Subtests) -> None:
    """DAIDALUS 2.0.2 with its configuration of DO-365B, phase I, without uncertainties."""
    for speed_kt, rate_fpm, corrective_s, warning_s in [
        (900.0, 0.0, 89, 59),
        (450.0 * math.sqrt(2.0), 0.0, 89, 59),
        (80.0, 0.0, 106, 76),
        (900.0, 2200.0, 67, 37),
        (150.0 * math.sqrt(2.0), 0.0, 93, 63),
    ]:
        with subtests.test(str((speed_kt, rate_fpm, corrective_s, warning_s))):
            assert first_s("corrective", speed_kt, rate_fpm) == pytest.approx(corrective_s, abs=1)
            assert first_s("warning", speed_kt, rate_fpm) == pytest.approx(warning_s, abs=1)


@pytest.mark.parametrize(
    ("gap_ft", "name"), [(449, "corrective"), (451, "preventive"), (701, None)]
)
def test_preventive_alerts_reach_further_in_altitude(gap_ft: float, name: str | None) -> None:
    level = level_of(meets(80.0, 900.0), Gap(gap_ft * FOOT, 0.0))
    assert (None if level is None else level.name) == name


@pytest.mark.parametrize("volume", [PREVENTIVE.volume, WARNING.volume])
def test_just_the_least_vertical_distance_is_not_well_clear(volume: Volume) -> None:
    motion = meets(20.0, 500.0)
    for gap_m in (volume.zthr_m, -volume.zthr_m):
        level, sinking = Gap(gap_m, 0.0), Gap(gap_m, -1e-9)
        assert time_to_violation_s(motion, level, volume) is not None
        if gap_m > 0.0:
            assert time_to_violation_s(motion, sinking, volume) is not None
        farther = Gap(math.nextafter(gap_m, 2.0 * gap_m), 0.0)
        assert time_to_violation_s(motion, farther, volume) is None


def test_two_that_are_too_close_already_have_violated_it() -> None:
    near = meets(1.0, 900.0)
    assert time_to_violation_s(near, LEVEL, WARNING.volume) == 0.0
    assert time_to_violation_s(meets(-5.0, 900.0), LEVEL, WARNING.volume) is None
    standing = Relative(500.0, 0.0, 0.0, 0.0)
    assert time_to_violation_s(standing, LEVEL, CORRECTIVE.volume) == 0.0
    assert time_to_violation_s(standing, Gap(800 * FOOT, 0.0), PREVENTIVE.volume) is None


@pytest.mark.parametrize(("miss_nm", "is_lost"), [(0.65, True), (0.67, False)])
def test_the_miss_distance_that_counts_is_0_66_nm(miss_nm: float, is_lost: bool) -> None:
    violation_s = time_to_violation_s(meets(60.0, 500.0, miss_nm), LEVEL, WARNING.volume)
    assert (violation_s is not None) == is_lost


def turned(motion: Relative, angle_rad: float) -> Relative:
    """Return a motion with all of it turned about the own place."""
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    north, east = motion.north_m, motion.east_m
    v_north, v_east = motion.velocity_north_m_s, motion.velocity_east_m_s
    return Relative(
        cos * north - sin * east, sin * north + cos * east,
        cos * v_north - sin * v_east, sin * v_north + cos * v_east,
    )  # fmt: skip


@settings(deadline=None)
@given(st.floats(5.0, 150.0), st.floats(50.0, 1_000.0), st.floats(0.0, 0.6),
       st.floats(0.0, math.tau))  # fmt: skip
def test_it_does_not_matter_where_the_other_comes_from(
    in_s: float, speed_kt: float, miss_nm: float, angle_rad: float
) -> None:
    motion = meets(in_s, speed_kt, miss_nm)
    found, expected = (
        time_to_violation_s(each, LEVEL, WARNING.volume)
        for each in (turned(motion, angle_rad), motion)
    )
    assert (found is None) == (expected is None)
    if found is not None and expected is not None:
        assert found == pytest.approx(expected, abs=0.01)
