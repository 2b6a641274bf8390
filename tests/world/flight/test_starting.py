"""Where an aircraft may begin, and where not."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.units import FOOT, KNOT
from airhilt.world.flight import Atmosphere, load_aircraft_type
from airhilt.world.flight.airframe import Airframe
from airhilt.world.flight.guidance import GuidanceModes
from flights import in_cruise


def limits_kt(name: str, altitude_ft: float) -> tuple[float, ...]:
    modes = GuidanceModes(load_aircraft_type(name))
    return tuple(speed / KNOT for speed in modes.speed_limits_m_s(altitude_ft * FOOT))


def test_it_may_begin_at_the_least_and_at_the_greatest_airspeed() -> None:
    for airspeed_kt in limits_kt("737", 20_000):
        aircraft = in_cruise("737", altitude_ft=20_000, airspeed_kt=airspeed_kt)
        begun_kt = aircraft.state.calibrated_airspeed_m_s / KNOT
        assert begun_kt == pytest.approx(airspeed_kt, rel=1e-3)


def test_it_may_not_begin_in_more_wind_than_its_airspeed() -> None:
    with pytest.raises(ValueError, match="expected more airspeed than wind"):
        in_cruise("c172p", atmosphere=Atmosphere(wind_north_m_s=80.0))


@pytest.mark.parametrize("rate_m_s", [2.0, -2.0])
def test_a_model_that_settles_comes_by_its_rate_to_the_altitude_where_it_begins(
    rate_m_s: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    settled: list[float] = []

    def release(airframe: Airframe, *given: Any) -> None:
        settled.append(airframe.state().altitude_m)
        settled.append(airframe.state().vertical_rate_m_s)

    monkeypatch.setattr(Airframe, "release", release)
    in_cruise("c310", vertical_rate_m_s=rate_m_s)
    assert settled[0] == pytest.approx(6_000 * FOOT, abs=30.0)
    assert settled[1] == pytest.approx(rate_m_s, abs=0.3)
