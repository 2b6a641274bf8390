"""The ground law by itself: what it does with nose wheel, rudder, ailerons, brakes and levers."""

from __future__ import annotations

import math
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.units import DEGREE, FOOT
from airhilt.world.flight import load_aircraft_type
from airhilt.world.flight.ground import GroundLaw
from stand_ins import StandIn, state_at

B737 = load_aircraft_type("737")
TICK_S = 0.05


def law(airframe: StandIn, tick_s: float = TICK_S) -> GroundLaw:
    return GroundLaw(cast(Any, airframe), B737, tick_s)


@pytest.mark.parametrize(
    ("right_m", "closing_m_s"), [(2.0, 0.8), (-2.0, -0.8), (50.0, 8.0 * FOOT), (-900.0, -8 * FOOT)]
)
@pytest.mark.parametrize("speed_m_s", [21.7, 43.3, 70.1])
def test_it_is_led_to_the_line_by_0_4_m_s_for_each_metre_and_by_8_ft_s_at_most(
    right_m: float, closing_m_s: float, speed_m_s: float
) -> None:
    """An aircraft that does so already is not steered."""
    airframe = StandIn()
    state = state_at(speed_m_s=speed_m_s, track_rad=1.0 - closing_m_s / speed_m_s)
    law(airframe).follow_line(state, right_m, 1.0)
    assert airframe.got["set_rudder"] == pytest.approx((0.0,), abs=1e-9)
    assert airframe.got["set_nose_wheel"] == pytest.approx((0.0,), abs=1e-9)


@pytest.mark.parametrize("right_m", [900.0, -900.0])
@pytest.mark.parametrize("speed_m_s", [0.3, 2.0, 4.6])
def test_taxiing_slowly_it_is_led_to_the_line_at_30_degrees_at_most(
    right_m: float, speed_m_s: float
) -> None:
    """Whoever points there already is not steered."""
    airframe = StandIn()
    heading = 1.0 - math.copysign(30.0 * DEGREE, right_m)
    law(airframe).follow_line(state_at(speed_m_s=speed_m_s, track_rad=heading), right_m, 1.0)
    assert airframe.got["set_nose_wheel"] == pytest.approx((0.0,), abs=1e-9)


def test_while_it_taxies_the_nose_wheel_is_turned_alike_at_any_speed() -> None:
    angles: list[float] = []
    for speed_m_s in (2.0, 4.0, 8.0):
        airframe = StandIn()
        law(airframe).follow_line(state_at(speed_m_s=speed_m_s), 0.0, 0.1)
        angles += airframe.got["set_nose_wheel"]
    assert angles == pytest.approx([angles[0]] * 3)
    assert angles[0] > 0.0


@pytest.mark.parametrize("tick_s", [0.1, 0.05, 0.025])
def test_what_a_yaw_that_nobody_asked_for_does_to_the_rudder_in_a_second_does_not_depend_on_ticks(
    tick_s: float,
) -> None:
    airframe, yaw_rate = StandIn(yaw_rate=0.02), 0.02
    steered = law(airframe, tick_s)
    for _ in range(round(1.0 / tick_s)):
        steered.steer(state_at(speed_m_s=30.0), 0.0)
    ground = B737.ground
    expected = (ground.yaw_rate_s + ground.yaw_integral * 1.0) * yaw_rate
    assert airframe.got["set_rudder"] == pytest.approx((expected,))


@given(
    st.floats(-0.8, 0.8), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(0.0, 80.0)
)  # fmt: skip
def test_no_control_is_set_beyond_its_stop(
    roll: float, roll_rate: float, yaw_rate: float, speed_m_s: float
) -> None:
    airframe = StandIn(roll_rate=roll_rate, yaw_rate=yaw_rate)
    law(airframe).steer(state_at(speed_m_s=speed_m_s, roll_rad=roll), 0.3)
    assert abs(airframe.got["set_aileron"][0]) <= 1.0
    assert abs(airframe.got["set_rudder"][0]) <= 1.0


def test_to_stand_it_brakes_softly_and_then_sets_the_brakes() -> None:
    airframe = StandIn()
    stopping = law(airframe)
    stopping.hold_speed(state_at(speed_m_s=5.0), 0.0)
    (softly,) = airframe.got["set_brakes"]
    stopping.hold_speed(state_at(speed_m_s=0.1), 0.0)
    assert airframe.got["set_brakes"] == (1.0,)
    assert 0.2 < softly < 0.5


class Taxiing:
    """A ground law that holds 5 m/s."""

    def __init__(self) -> None:
        self.airframe = StandIn()
        self._law = law(self.airframe)

    def lever_after(self, seconds: float, speed_m_s: float) -> float:
        """Return the lever after some time at a speed."""
        for _ in range(round(seconds / TICK_S)):
            self._law.hold_speed(state_at(speed_m_s=speed_m_s), 5.0)
        (lever,) = self.airframe.got["set_throttle"]
        return float(lever)


def test_at_its_taxi_speed_it_keeps_the_power_that_brought_it_there() -> None:
    taxiing = Taxiing()
    assert taxiing.lever_after(20.0, speed_m_s=4.5) > 0.1
    kept = taxiing.lever_after(1.0, speed_m_s=5.0)
    assert kept > 0.05
    assert taxiing.lever_after(10.0, speed_m_s=5.0) == pytest.approx(kept)


def test_a_second_of_braking_does_not_cost_it_the_power_to_taxi_on() -> None:
    taxiing = Taxiing()
    taxiing.lever_after(20.0, speed_m_s=4.5)
    before = taxiing.lever_after(1.0, speed_m_s=5.0)
    assert taxiing.lever_after(1.0, speed_m_s=6.5) == 0.0
    assert taxiing.airframe.got["set_brakes"][0] > 0.0
    assert taxiing.lever_after(TICK_S, speed_m_s=5.0) > 0.5 * before


def test_the_nose_is_lowered_by_more_elevator_at_low_pressure_up_to_four_times(
    subtests: pytest.Subtests,
) -> None:
    """It is to come down by 2 degrees a second, and stands still."""
    table = [(4.0, 0.25), (1.0, 1.0), (0.3, 1 / 0.3), (0.2, 4.0),
                                             (0.0, 4.0)]  # fmt: skip
    for part, scale in table:
        with subtests.test(str((part, scale))):
            pitch = B737.gains.pitch
            airframe = StandIn(dynamic_pressure_pa=part * pitch.reference_pressure_pa)
            law(airframe).lower_nose()
            error = -2.0 * DEGREE
            expected = -scale * (0.5 * pitch.rate_s + pitch.rate_integral * TICK_S) * error
            assert airframe.got["set_elevator"] == pytest.approx((expected,))
            assert expected > 0.0  # That pitches down.


@pytest.mark.parametrize(("before", "after"), [(0.5, 0.475), (-0.3, -0.275), (0.11, 0.1)])
def test_a_nose_wheel_on_the_ground_is_pressed_to_it_softly(before: float, after: float) -> None:
    """The elevator moves by half of its way a second, to a tenth down."""
    airframe = StandIn(nose_on_ground=True, elevator=before)
    law(airframe).lower_nose()
    assert airframe.got["set_elevator"] == pytest.approx((after,))


def test_it_brakes_the_more_the_longer_it_is_too_fast_and_never_more_than_fully() -> None:
    airframe = StandIn()
    braking = law(airframe)
    pedals = []
    for _ in range(200):
        braking.slow_down(state_at(speed_m_s=50.0), 3.0)
        pedals.append(airframe.got["set_brakes"][0])
    assert pedals[:2] == pytest.approx([0.0, 0.3 * TICK_S * 3.0])
    assert pedals[2] == pytest.approx(2.0 * pedals[1])
    assert pedals[-1] == 1.0
    assert airframe.got["set_throttle"] == (0.0,)
    for tick in range(5):
        braking.slow_down(state_at(speed_m_s=50.0 - 10.0 * TICK_S * tick), 3.0)
    assert airframe.got["set_brakes"][0] < 1.0


@pytest.mark.parametrize(("crab_deg", "kept_deg"), [(1.0, 1.0), (-1.0, -1.0), (8.0, 1.5)])
def test_in_a_crosswind_the_nose_may_point_off_the_track_by_a_degree_and_a_half(
    crab_deg: float, kept_deg: float
) -> None:
    """Once it has pointed there for long, it is not steered."""
    airframe = StandIn()
    steered = law(airframe)
    state = state_at(speed_m_s=50.0, track_rad=0.0, heading_rad=crab_deg * DEGREE % math.tau)
    for _ in range(round(20.0 / TICK_S)):
        steered.follow_line(state, 0.0, (crab_deg - kept_deg) * DEGREE)
    straight = law(StandIn())
    straight.follow_line(state, 0.0, (crab_deg - kept_deg) * DEGREE, slipping=False)
    assert steered._slip == pytest.approx(kept_deg * DEGREE, rel=1e-3)
    assert straight._slip == 0.0
    for speed_m_s, may_slip in ((9.9, False), (10.1, True)):
        rolling = law(StandIn())
        at = state_at(speed_m_s=speed_m_s, heading_rad=crab_deg * DEGREE % math.tau)
        rolling.follow_line(at, 0.0, 0.0)
        assert (rolling._slip != 0.0) is may_slip


@pytest.mark.parametrize(
    ("roll_deg", "roll_rate", "aileron"),
    [(2.0, 0.0, -0.1745), (0.0, 0.1, -0.15), (20.0, 0.0, -1.0)],
)
def test_it_keeps_the_wings_level(roll_deg: float, roll_rate: float, aileron: float) -> None:
    airframe = StandIn(roll_rate=roll_rate)
    law(airframe).steer(state_at(speed_m_s=30.0, roll_rad=roll_deg * DEGREE), 0.0)
    assert airframe.got["set_aileron"] == pytest.approx((aileron,), abs=1e-4)


@pytest.mark.parametrize("speed_m_s", [5.0, 20.0])
def test_the_nose_wheel_has_the_angle_of_the_turn_that_is_asked_for(speed_m_s: float) -> None:
    """A wheelbase of 15 m, and a circle with the radius of the speed over the yaw rate."""
    yaw_rate = 0.05
    airframe = StandIn(yaw_rate=yaw_rate)
    law(airframe).steer(state_at(speed_m_s=speed_m_s), yaw_rate)
    expected = math.atan(15.0 / (speed_m_s / yaw_rate))
    assert airframe.got["set_nose_wheel"] == pytest.approx((expected,))


def test_no_turn_is_tighter_than_2_5_m_s2_to_the_side() -> None:
    airframe = StandIn(yaw_rate=2.5 / 20.0)
    law(airframe).steer(state_at(speed_m_s=20.0), 1.0)
    assert airframe.got["set_rudder"] == pytest.approx((0.0,), abs=1e-9)


def test_it_coasts_while_it_is_little_too_fast_and_brakes_then(subtests: pytest.Subtests) -> None:
    """It is to lose 1.5 m/s each second for each m/s too much; coasting takes 0.3 of that."""
    table = [(0.1, 0.0), (0.2, 0.0), (1.0, 1.2 / 4.5),
                                                  (5.0, 1.0)]  # fmt: skip
    for over_m_s, brakes in table:
        with subtests.test(str((over_m_s, brakes))):
            airframe = StandIn()
            law(airframe).hold_speed(state_at(speed_m_s=5.0 + over_m_s), 5.0)
            assert airframe.got["set_brakes"] == pytest.approx((brakes,))
            assert airframe.got["set_throttle"] == (0.0,)


def test_the_lever_of_one_who_taxies_stays_below_half() -> None:
    airframe = StandIn()
    taxied = law(airframe)
    for _ in range(2000):
        taxied.hold_speed(state_at(speed_m_s=0.0), 8.0)
    assert airframe.got["set_throttle"] == (0.5,)
    assert airframe.got["set_brakes"] == (0.0,)
