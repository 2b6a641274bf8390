"""A go-around from just above the runway climbs away, and does not touch it."""

from __future__ import annotations

import pytest

from airhilt.units import DEGREE, FOOT, KNOT, wrap_angle
from airhilt.world.flight import Atmosphere
from airhilt.world.flight.aircraft import Aircraft
from flights import RUNWAY, on_final, states

TURBULENCE = Atmosphere(turbulence_wind_at_20ft_m_s=15 * KNOT, turbulence_severity=3)


def descend_to(height_ft: int, aircraft: Aircraft) -> None:
    """Fly the approach down to a height of the main wheels."""
    aircraft.procedures.land(RUNWAY)
    for state in states(aircraft, 200):
        if aircraft._airframe.main_wheel_height_m(state) < height_ft * FOOT:
            return


@pytest.mark.parametrize("air", [Atmosphere(), TURBULENCE], ids=["calm", "turbulence"])
def test_from_50_ft_it_climbs_away_without_touching(name: str, air: Atmosphere) -> None:
    aircraft = on_final(name, atmosphere=air, distance_nm=1.0)
    descend_to(50, aircraft)
    aircraft.procedures.go_around(600.0)
    assert aircraft.phase == "go_around"
    for state in states(aircraft, 150):
        assert not aircraft.on_ground
        assert aircraft._airframe.main_wheel_height_m(state) > 15 * FOOT
    assert aircraft.ended is None
    assert state.altitude_m > 350.0
    assert abs(wrap_angle(state.track_rad - RUNWAY.course_rad)) < 5 * DEGREE


def test_it_turns_when_told_and_climbs_on() -> None:
    aircraft = on_final("737", distance_nm=1.0)
    descend_to(100, aircraft)
    aircraft.procedures.go_around(900.0)
    *_, _ = states(aircraft, 20)
    aircraft.en_route.turn_by(30 * DEGREE)
    assert aircraft.phase == "go_around"
    *_, state = states(aircraft, 120)
    assert state.altitude_m == pytest.approx(900.0, abs=10.0)
    turned = wrap_angle(state.track_rad - RUNWAY.course_rad)
    assert turned == pytest.approx(30 * DEGREE, abs=1 * DEGREE)


def test_without_an_approach_it_is_refused() -> None:
    with pytest.raises(ValueError, match="go_around in phase en_route; expected glide or flare"):
        on_final("737").procedures.go_around(1_000.0)


def test_an_altitude_that_is_not_above_is_refused() -> None:
    aircraft = on_final("737")
    aircraft.procedures.land(RUNWAY)
    with pytest.raises(ValueError, match="expected more than the altitude now"):
        aircraft.procedures.go_around(50.0)
