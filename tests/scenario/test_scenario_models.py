"""A scenario is JSON: what goes out comes in again."""

from __future__ import annotations

import math

import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.geodesy.positions import GeodeticPosition, RelativePosition
from airhilt.units import DEGREE, NAUTICAL_MILE
from airhilt.world import site as geometry
from airhilt.world.loading import load

bearings = st.floats(0.0, 360.0)
CENTRE = GeodeticPosition(type="geodetic", lat_deg=38.9, lon_deg=-77.0)
SETTING = geometry.ScenarioSite(CENTRE, 0.0)


@settings(deadline=None)
@given(bearings, st.floats(1.0, 200.0))
def test_a_position_lies_where_its_bearing_and_distance_lead(
    bearing: float, distance: float
) -> None:
    place = RelativePosition(type="from_centre", bearing_deg=bearing, distance_nm=distance)
    latitude, longitude = SETTING.place(place)
    line = Geodesic.WGS84.Inverse(38.9, -77.0, latitude / DEGREE, longitude / DEGREE)
    assert line["s12"] == pytest.approx(distance * NAUTICAL_MILE, abs=0.01)
    assert math.cos(line["azi1"] * DEGREE - bearing * DEGREE) == pytest.approx(1.0)


@pytest.mark.parametrize(("offset_nm", "lat_sign"), [(2.0, -1), (-2.0, 1)])
def test_an_offset_is_to_the_right_of_the_line_from_the_centre(
    offset_nm: float, lat_sign: int
) -> None:
    place = RelativePosition(
        type="from_centre", bearing_deg=90.0, distance_nm=10.0, offset_nm=offset_nm
    )
    straight = SETTING.place(place.model_copy(update={"offset_nm": 0.0}))
    aside = SETTING.place(place)
    assert (aside[0] - straight[0]) * lat_sign > 0.0
    line = Geodesic.WGS84.Inverse(*(x / DEGREE for x in (*straight, *aside)))
    assert line["s12"] == pytest.approx(2.0 * NAUTICAL_MILE, abs=0.01)


def test_the_pair_of_a_conflict_is_named_in_the_order_of_the_actors() -> None:
    scenario = load("s02a_headon")
    first, second = (actor.callsign for actor in scenario.actors[:2])
    assert scenario.pair == (first, second)
    turned = scenario.conflict.model_copy(update={"actors": (second, first)})
    assert scenario.model_copy(update={"conflict": turned}).pair == (first, second)
    assert scenario.model_copy(update={"conflict": None}).pair is None
