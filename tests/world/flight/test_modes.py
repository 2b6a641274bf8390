"""Guidance modes with the rates, speeds and ceiling of a type's file."""

from __future__ import annotations

import pytest

from airhilt.units import FOOT, KNOT
from airhilt.world.flight import InitialCondition, load_aircraft_type
from airhilt.world.flight.guidance import AltitudeClearance, GuidanceModes
from stand_ins import state_at

KIND = load_aircraft_type("737")
MODES = GuidanceModes(KIND)
SPEEDS = KIND.speeds
CEILING_M = SPEEDS.service_ceiling_ft * 0.3048
FPM = 0.3048 / 60.0


def begun(rate_m_s: float) -> AltitudeClearance:
    initial = InitialCondition(0.8, 0.1, 3_000.0, 0.0, 130.0, rate_m_s)
    return MODES.initial_altitude(initial, 450.0).clearance


@pytest.mark.parametrize(
    ("rate_m_s", "expected"),
    [
        (0.0, (3_000.0, SPEEDS.climb_rate_fpm * FPM)),
        (4.0, (CEILING_M, 4.0)),
        (-4.0, (450.0, 4.0)),
    ],
)
def test_a_flight_begins_level_or_on_the_way_to_the_ceiling_or_to_the_ground(
    rate_m_s: float, expected: tuple[float, float]
) -> None:
    assert begun(rate_m_s) == pytest.approx(expected)


def test_the_greatest_rates_are_those_of_the_file() -> None:
    up, down = SPEEDS.maximum_climb_rate_fpm * FPM, SPEEDS.maximum_descent_rate_fpm * FPM
    assert MODES.steepest_climb(5_000.0).clearance == pytest.approx((5_000.0, up))
    assert MODES.steepest_climb(30_000.0).clearance == pytest.approx((CEILING_M, up))
    assert MODES.steepest_descent(2_000.0).clearance == pytest.approx((2_000.0, down))
    usual = SPEEDS.climb_rate_fpm * FPM
    assert MODES.altitude_at_usual_rate(2_000.0).clearance == pytest.approx((2_000.0, usual))


def test_the_slowest_clean_climb_is_not_below_the_safety_speed() -> None:
    kt = max(SPEEDS.minimum_clean_kt, SPEEDS.climb_safety_kt)
    assert MODES.clean_climb_speed().target_m_s == pytest.approx(kt * 1852.0 / 3600.0)


def test_low_the_greatest_speed_is_vmo_and_high_that_of_the_greatest_mach_number() -> None:
    slowest, fastest = MODES.speed_limits_m_s(1_000.0)
    assert (slowest / KNOT, fastest / KNOT) == pytest.approx(
        (SPEEDS.minimum_clean_kt, SPEEDS.maximum_kt)
    )
    _, high = MODES.speed_limits_m_s(38_000 * FOOT)
    assert high / KNOT < SPEEDS.maximum_kt - 50.0
    limited = MODES.airspeed(high + 20.0)
    at_limit = state_at(speed_m_s=high, mach=SPEEDS.maximum_mach)
    assert limited.airspeed(at_limit) == pytest.approx(high)
