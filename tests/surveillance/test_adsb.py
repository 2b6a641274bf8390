"""ADS-B as DO-260B has it: what transponders say, and what receivers make of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.geodesy.relative_motion import relative
from airhilt.surveillance import transponders
from airhilt.surveillance.receivers import Receiver
from airhilt.surveillance.squitters import (
    NACP_95_PERCENT_M,
    movement_kt,
    quantise,
)
from airhilt.surveillance.transponders import SurfaceRate, Transponder
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE, SECOND_NS
from airhilt.world.site import FixedSite

EVERYWHERE = 500.0 * NAUTICAL_MILE


@dataclass(frozen=True)
class Flying(FixedSite):
    velocity_down_m_s: float = 0.0
    heading_rad: float = 0.0


HERE = Flying(47.0 * DEGREE, 8.0 * DEGREE, 10_000.0, 150.0, -200.0, velocity_down_m_s=-5.0)


def transponder(nacp: int = 9, nacv: int = 2, seed: int = 1) -> Transponder:
    return Transponder("a1b2c3", "AAL123", nacp, nacv, np.random.default_rng(seed), "A3")


def receiver(
    name: str = "site", range_m: float = EVERYWHERE, height_m: float = 1_000.0
) -> Receiver:
    return Receiver(name, FixedSite(47.0 * DEGREE, 8.0 * DEGREE, height_m), range_m)


@settings(deadline=None)
@given(
    st.floats(-300.0, 15_000.0),
    st.floats(-300.0, 300.0),
    st.floats(-300.0, 300.0),
    st.floats(-30.0, 30.0),
)
def test_altitude_comes_in_steps_of_25_ft_and_velocity_in_knots_and_64_fpm(
    altitude_m: float, north: float, east: float, down: float
) -> None:
    state = Flying(47.0 * DEGREE, 8.0 * DEGREE, altitude_m, north, east, down)
    sender = transponder(nacv=4)
    altitude_ft = sender.position(state, 0).altitude_ft
    assert altitude_ft % 25.0 == 0.0
    assert abs(altitude_ft - altitude_m / FOOT) <= 12.5 + 1e-9
    speed, track, rate = sender.velocity(state)
    for component in (speed * math.cos(track * DEGREE), speed * math.sin(track * DEGREE)):
        assert component == pytest.approx(round(component), abs=1e-6)
    assert 0.0 <= track < 360.0
    assert rate % 64.0 == 0.0
    assert abs(rate + down / FOOT_PER_MINUTE) <= 32.0 + 1e-9


@pytest.mark.parametrize("speed_kt", [300, 301])
def test_each_knot_of_a_velocity_is_told_from_the_next(speed_kt: int) -> None:
    state = replace(HERE, velocity_north_m_s=speed_kt * KNOT, velocity_east_m_s=-speed_kt * KNOT)
    sender = transponder(nacv=4)
    velocities = [sender.velocity(state) for _ in range(200)]
    north = [speed * math.cos(track * DEGREE) for speed, track, _ in velocities]
    east = [speed * math.sin(track * DEGREE) for speed, track, _ in velocities]
    assert (np.median(north), np.median(east)) == pytest.approx((speed_kt, -speed_kt))


@settings(deadline=None)
@given(st.floats(-1e6, 1e6), st.sampled_from([1.0, 25.0, 64.0]))
def test_quantised_is_the_nearest_multiple(value: float, step: float) -> None:
    assert quantise(value, step) % step == 0.0
    assert abs(quantise(value, step) - value) <= step / 2.0


def test_even_and_odd_positions_take_turns() -> None:
    sender = transponder()
    assert [sender.position(HERE, n).position.odd for n in range(4)] == [False, True, False, True]


def position_errors_m(nacp: int, flights: int = 400) -> npt.NDArray[np.floating[Any]]:
    """How far the first decoded position of some flights is off."""
    errors = []
    for seed in range(flights):
        sender, station = transponder(nacp, nacv=4, seed=seed), receiver()
        station.decode(sender, sender.velocity(HERE), 0)
        station.decode(sender, sender.position(HERE, 0), 0)
        decoded = station.decode(sender, sender.position(HERE, 1), 1)
        if decoded is not None:
            place = FixedSite(
                decoded.position_deg[0] * DEGREE, decoded.position_deg[1] * DEGREE, 1e4
            )
            errors.append(relative(replace(HERE, altitude_m=1e4), place).distance_m)
    return np.array(errors)


def test_95_percent_of_positions_lie_within_what_the_accuracy_category_says(
    subtests: pytest.Subtests,
) -> None:
    for nacp in [6, 7, 8, 9]:
        with subtests.test(str(nacp)):
            errors = position_errors_m(nacp)
            share = np.mean(errors <= NACP_95_PERCENT_M[nacp])
            assert 0.90 <= share <= 0.99
            assert np.median(errors) > 0.2 * NACP_95_PERCENT_M[nacp]


class Constant:
    """Draws the same number of standard deviations each time."""

    def __init__(self, sigmas: float) -> None:
        self.sigmas = sigmas

    def standard_normal(self) -> float:
        return self.sigmas


@pytest.mark.parametrize("seconds", [6.0, 60.0, 120.0])
def test_a_position_error_fades_within_a_minute_and_keeps_its_size(seconds: float) -> None:
    """What is left of the old one and what is new have the variance of the category together."""
    sigma_m = 92.6 / math.sqrt(-2.0 * math.log(0.05))
    for sigmas in (0.0, 1.0):
        sender = transponder(nacp=8)
        before_m = sender._position_error(0)
        sender.generator = Constant(sigmas)  # type: ignore[assignment]
        after_m = sender._position_error(round(seconds * SECOND_NS))
        kept = math.exp(-seconds / 60.0)
        new_m = sigmas * sigma_m * math.sqrt(1.0 - kept**2)
        assert after_m == pytest.approx([kept * each + new_m for each in before_m], rel=1e-4)


def test_the_finest_velocities_are_within_30_cm_s() -> None:
    """A draw of a thousand standard deviations, to be told from the steps of a knot."""
    sender = transponder(nacv=4)
    sender.generator = Constant(1_000.0)  # type: ignore[assignment]
    still = replace(HERE, velocity_north_m_s=0.0, velocity_east_m_s=0.0)
    sigma_m_s = 0.3 / math.sqrt(-2.0 * math.log(0.05))
    speed_kt = sender.velocity(still).ground_speed_kt
    assert speed_kt * KNOT == pytest.approx(1_000.0 * sigma_m_s * math.sqrt(2.0), abs=0.6)


def test_position_errors_are_in_proportion_to_the_limits_of_their_categories(
    subtests: pytest.Subtests,
) -> None:
    """DO-260B gives them in NM up to category 8, that of 1 being 10 NM, and then in m."""
    table = [(0, 20), (2, 4), (3, 2), (4, 1), (5, 0.5), (6, 0.3), (7, 0.1), (8, 0.05),
             (9, 30 / 1852), (10, 10 / 1852), (11, 3 / 1852)]  # fmt: skip
    for nacp, limit_nm in table:
        with subtests.test(str((nacp, limit_nm))):
            coarse, fine = (transponder(each)._position_error(0) for each in (1, nacp))
            assert np.array(coarse) / np.array(fine) == pytest.approx(10.0 / limit_nm)


@pytest.mark.parametrize(("nacv", "limit_m_s"), [(1, 10.0), (2, 3.0), (3, 1.0)])
def test_velocities_spread_as_the_accuracy_category_says(nacv: int, limit_m_s: float) -> None:
    sender = transponder(nacv=nacv)
    velocities = [sender.velocity(HERE) for _ in range(2000)]
    off = [
        math.hypot(
            speed * math.cos(track * DEGREE) * KNOT - HERE.velocity_north_m_s,
            speed * math.sin(track * DEGREE) * KNOT - HERE.velocity_east_m_s,
        )
        for speed, track, _ in velocities
    ]
    assert 0.92 <= np.mean(np.array(off) <= limit_m_s) <= 0.98


# --- reception ------------------------------------------------------------------------------


def test_the_first_report_needs_an_even_and_an_odd_position_and_a_velocity() -> None:
    sender, station = transponder(), receiver()
    assert station.decode(sender, sender.position(HERE, 0), 0) is None
    assert station.decode(sender, sender.position(HERE, 1), 1) is None
    assert station.decode(sender, sender.velocity(HERE), 2) is None
    report = station.decode(sender, sender.position(HERE, 3), 3).report(9)
    assert (report.callsign, report.emitter_category) == (None, None)
    assert (report.altitude_ft is None, report.on_ground) == (False, False)
    assert (report.t_adsb_in_ns, report.t_adsb_out_ns, report.t_ns) == (3, 9, 9)
    assert report.latitude_deg == pytest.approx(47.0, abs=1e-3)
    assert report.longitude_deg == pytest.approx(8.0, abs=1e-3)


def test_a_pair_is_decoded_together_up_to_its_longest_time(subtests: pytest.Subtests) -> None:
    """DO-260B, A.1.7.7 and A.1.7.8: 10 s in the air; 25 s on the surface above 25 kt."""
    for on_surface, apart_ns, is_decoded in [
        (False, 10 * SECOND_NS, True),
        (False, 10 * SECOND_NS + 1, False),
        (True, 25 * SECOND_NS, True),
        (True, 25 * SECOND_NS + 1, False),
    ]:
        with subtests.test(str((on_surface, apart_ns, is_decoded))):
            sender, station = transponder(nacp=11), receiver()
            station.decode(sender, sender.velocity(HERE), 0)
            encode = sender.surface_position if on_surface else sender.position
            assert station.decode(sender, encode(HERE, 0), 0) is None
            assert (
                station.decode(sender, encode(HERE, apart_ns), apart_ns) is not None
            ) is is_decoded


@pytest.mark.parametrize(
    ("silent_ns", "is_followed"), [(60 * SECOND_NS, True), (60 * SECOND_NS + 1, False)]
)
def test_a_position_of_a_minute_before_is_a_reference_and_an_older_one_is_none(
    silent_ns: int, is_followed: bool
) -> None:
    """The time counts from the last position, not from the pair before it."""
    sender, station = transponder(nacp=11), receiver()
    station.decode(sender, sender.velocity(HERE), 0)
    for t_ns in (0, 1, 30 * SECOND_NS):
        station.decode(sender, sender.position(HERE, t_ns), t_ns)
    late_ns = 30 * SECOND_NS + silent_ns
    decoded = station.decode(sender, sender.position(HERE, late_ns), late_ns)
    assert (decoded is not None) is is_followed
    assert station.decode(sender, sender.position(HERE, late_ns + 1), late_ns + 1) is not None


def test_callsign_and_category_are_known_once_an_identification_came_through() -> None:
    sender, station = transponder(), receiver()
    station.decode(sender, sender.identification(), 0)
    station.decode(sender, sender.velocity(HERE), 0)
    station.decode(sender, sender.position(HERE, 0), 0)
    report = station.decode(sender, sender.position(HERE, 1), 1).report(2)
    assert (report.callsign, report.emitter_category) == ("AAL123", "A3")


@pytest.mark.parametrize(("altitude_ft", "horizon_nm"), [(1_000, 39), (10_000, 123), (35_000, 230)])
def test_a_receiver_hears_what_is_above_the_radio_horizon(
    altitude_ft: int, horizon_nm: int
) -> None:
    """1.23 times the root of the height in feet, in NM: the rule of thumb."""
    station = receiver(height_m=0.0)
    for nautical_miles, heard in ((0.97 * horizon_nm, True), (1.03 * horizon_nm, False)):
        away = nautical_miles * NAUTICAL_MILE / 6.37e6
        state = replace(HERE, latitude_rad=HERE.latitude_rad + away, altitude_m=altitude_ft * FOOT)
        assert station.in_view(state) == heard


# --- on the surface -------------------------------------------------------------------------

STANDING = Flying(47.0 * DEGREE, 8.0 * DEGREE, 400.0, heading_rad=1.0)


def taxiing(speed_m_s: float, heading_rad: float = 1.0) -> Flying:
    north, east = speed_m_s * math.cos(heading_rad), speed_m_s * math.sin(heading_rad)
    return replace(
        STANDING, velocity_north_m_s=north, velocity_east_m_s=east, heading_rad=heading_rad
    )


@settings(deadline=None)
@given(st.floats(0.0, 175.0, exclude_max=True))
def test_a_movement_is_off_by_half_a_step_that_grows_with_the_speed(speed_kt: float) -> None:
    steps_kt = {0.125: 0.125, 1: 0.146, 2: 0.25, 15: 0.5, 70: 1, 100: 2, 175: 5}
    step_kt = next(step for top, step in steps_kt.items() if speed_kt <= top)
    assert abs(movement_kt(speed_kt) - speed_kt) <= step_kt / 2 + 1e-9


def test_movements_are_those_of_the_table_in_do_260b(subtests: pytest.Subtests) -> None:
    for speed_kt, movement in [
        (0.0, 0.0),
        (0.1, 0.0625),
        (0.125, 0.0625),
        (0.13, 0.125 + 0.875 / 12),
        (1.0, 1.0 - 0.875 / 12),
        (1.1, 1.125),
        (2.0, 1.875),
        (2.1, 2.25),
        (15.0, 14.75),
        (20.3, 20.5),
        (70.0, 69.5),
        (81.0, 81.0),
        (100.0, 99.0),
        (142.0, 142.5),
        (174.9, 172.5),
        (175.0, 175.0),
        (200.0, 175.0),
    ]:
        with subtests.test(str((speed_kt, movement))):
            assert movement_kt(speed_kt) == pytest.approx(movement)


@settings(deadline=None)
@given(st.floats(0.0, 2 * math.pi))
def test_on_the_surface_the_heading_comes_in_steps_of_a_128th_of_a_circle(
    heading_rad: float,
) -> None:
    track = transponder().surface_position(taxiing(5.0, heading_rad), 0).movement.track_deg
    assert 0.0 <= track < 360.0
    assert track % (360.0 / 128.0) == 0.0
    off = (track - heading_rad / DEGREE + 180.0) % 360.0 - 180.0
    assert abs(off) <= 360.0 / 256.0 + 1e-9


def test_a_speed_on_the_surface_is_as_uncertain_as_the_accuracy_category_says() -> None:
    sender = transponder(nacv=1)
    speeds = [
        sender.surface_position(taxiing(30.0), 0).movement.ground_speed_kt * KNOT
        for _ in range(2000)
    ]
    assert np.mean(speeds) == pytest.approx(30.0, abs=0.4)
    assert np.std(speeds) == pytest.approx(10.0 / 2.4477, rel=0.1)


def test_who_stands_says_so_and_keeps_its_heading() -> None:
    squitter = transponder(nacv=0).surface_position(STANDING, 0)
    assert squitter.movement.ground_speed_kt == 0.0
    assert squitter.movement.track_deg == pytest.approx(1.0 / DEGREE, abs=1.41)


@pytest.mark.parametrize(("speed_m_s", "told_kt"), [(0.049, 0.0), (0.051, 0.0625)])
def test_a_navigation_unit_takes_less_than_5_cm_s_for_a_standstill(
    speed_m_s: float, told_kt: float
) -> None:
    sender = transponder()
    sender.generator = Constant(0.0)  # type: ignore[assignment]
    assert sender.surface_position(taxiing(speed_m_s), 0).movement.ground_speed_kt == told_kt


def test_a_speed_on_the_surface_is_never_below_a_standstill() -> None:
    sender = transponder(nacv=1)
    sender.generator = Constant(-10.0)  # type: ignore[assignment]
    assert sender.surface_position(taxiing(5.0), 0).movement.ground_speed_kt == 0.0


def test_a_surface_report_needs_no_velocity_squitter_and_has_no_altitude() -> None:
    sender, station = transponder(nacp=11), receiver()
    assert station.decode(sender, sender.surface_position(taxiing(8.0), 0), 0) is None
    report = station.decode(sender, sender.surface_position(taxiing(8.0), 1), 1).report(2)
    assert (report.on_ground, report.altitude_ft, report.vertical_rate_fpm) == (True, None, 0.0)
    assert report.ground_speed_kt * KNOT == pytest.approx(8.0, abs=4.0)
    assert report.latitude_deg == pytest.approx(47.0, abs=1e-4)
    assert report.longitude_deg == pytest.approx(8.0, abs=1e-4)


def test_an_airborne_and_a_surface_position_are_not_decoded_together() -> None:
    sender, station = transponder(), receiver()
    station.decode(sender, sender.velocity(HERE), 0)
    station.decode(sender, sender.position(HERE, 0), 0)
    assert station.decode(sender, sender.surface_position(STANDING, 1), 1) is None
    assert station.decode(sender, sender.surface_position(STANDING, 2), 2) is not None


def test_a_landing_goes_on_from_the_last_airborne_position() -> None:
    sender, station = transponder(nacp=11), receiver()
    station.decode(sender, sender.velocity(HERE), 0)
    for n in range(2):
        station.decode(sender, sender.position(HERE, n), n)
    report = station.decode(sender, sender.surface_position(taxiing(60.0), 2), 2).report(3)
    assert report.on_ground
    assert report.latitude_deg == pytest.approx(47.0, abs=1e-4)
    airborne = station.decode(sender, sender.position(HERE, 4), 4).report(5)
    assert not airborne.on_ground
    assert airborne.ground_speed_kt * KNOT == pytest.approx(60.0, abs=4.0)


def stationary(rate: SurfaceRate, north_m: float, t_s: float) -> bool:
    state = replace(STANDING, latitude_rad=STANDING.latitude_rad + north_m / 6.37e6)
    return rate.is_stationary(state, round(t_s * SECOND_NS))


def test_who_keeps_within_10_m_for_30_s_is_stationary_until_it_has_moved_10_m() -> None:
    rate, after_s = SurfaceRate(), 30.0
    assert not any(stationary(rate, 0.1 * t, t) for t in np.arange(0.0, after_s, 0.5))
    assert stationary(rate, 3.0, after_s)
    assert stationary(rate, 9.0, after_s + 5.0)
    assert not stationary(rate, 11.0, after_s + 5.5)
    assert not stationary(rate, 11.0, 2 * after_s)
    assert stationary(rate, 11.0, 2 * after_s + 6.0)


@pytest.mark.parametrize(("moved_m", "stands"), [(9.9, True), (10.0, True), (10.1, False)])
def test_who_has_moved_by_10_m_has_not_moved_by_more(
    moved_m: float, stands: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """DO-260B, 2.2.3.3: the low rate is for a position that has not changed more than 10 m."""
    rate = SurfaceRate()
    assert not rate.is_stationary(STANDING, 0)
    monkeypatch.setattr(transponders, "horizontal_distance_m", lambda *_: moved_m)
    assert rate.is_stationary(STANDING, 30 * SECOND_NS) is stands
    assert not SurfaceRate().is_stationary(STANDING, 60 * SECOND_NS)
