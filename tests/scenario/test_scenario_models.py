"""A scenario is JSON: what goes out comes in again."""

from __future__ import annotations

import math
from typing import Any

import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from airhilt.geodesy import wgs84
from airhilt.geodesy.positions import GeodeticPosition, Position, RelativePosition
from airhilt.scenario import Scenario
from airhilt.scenario.models import AircraftSpec, Condition, EnRouteScene
from airhilt.units import DEGREE, NAUTICAL_MILE
from airhilt.world import site as geometry
from airhilt.world.loading import load

bearings = st.floats(0.0, 360.0)
positions = st.builds(
    RelativePosition,
    type=st.just("from_centre"),
    bearing_deg=bearings,
    distance_nm=st.floats(0.0, 500.0),
    offset_nm=st.floats(-100.0, 100.0),
) | st.builds(
    GeodeticPosition,
    type=st.just("geodetic"),
    lat_deg=st.floats(-90.0, 90.0),
    lon_deg=st.floats(-180.0, 180.0),
)
callsigns = st.from_regex(r"\A[A-Z0-9]{2,8}\Z")
altitude_commands = st.fixed_dictionaries(
    {"action": st.just("altitude"), "altitude_ft": st.floats(0.0, 45_000.0)},
    optional={"vertical_rate_fpm": st.none() | st.floats(1.0, 6_000.0)},
)
commands = altitude_commands | st.fixed_dictionaries(
    {"action": st.just("turn"), "degrees": st.floats(-180.0, 180.0)}
)
actors = st.builds(
    lambda callsign, address, position, told, equipped: AircraftSpec.model_validate(
        {
            "type": "aircraft",
            "callsign": callsign,
            "icao24": f"{address:06x}",
            "aircraft": "737",
            "initial": {
                "type": "airborne",
                "position": position.model_dump(),
                "altitude_ft": 30_000,
                "cas_kt": 280,
            },
            "commands": told,
            "transponder": {"equipped": equipped},
        }
    ),
    callsigns,
    st.integers(0, 0xFFFFFF),
    positions,
    st.lists(commands, max_size=3),
    st.booleans(),
)
simple = st.one_of(
    st.builds(lambda t: {"type": "time", "at_s": t}, st.floats(0.0, 86_400.0)),
    st.builds(
        lambda a, b, d: {
            "type": "separation_below", "actors": [a, b], "horizontal_nm": d, "vertical_ft": 10 * d,
        },
        callsigns, callsigns, st.floats(0.1, 50.0),
    ),
    st.builds(
        lambda a, h: {"type": "bound_for_altitude", "actor": a, "altitude_ft": h},
        callsigns, st.floats(-1e3, 5e4),
    ),
)  # fmt: skip
conditions = st.recursive(
    simple,
    lambda inner: st.builds(
        lambda kind, parts: {"type": kind, "conditions": parts},
        st.sampled_from(["all_of", "any_of"]),
        st.lists(inner, min_size=1, max_size=3),
    ),
    max_leaves=6,
)


def there_and_back(annotation: Any, value: Any) -> Any:
    adapter = TypeAdapter(annotation)
    return adapter.validate_json(adapter.dump_json(value))


@settings(deadline=None)
@given(positions)
def test_a_position_survives_json(position: GeodeticPosition | RelativePosition) -> None:
    assert there_and_back(Position, position) == position


@settings(deadline=None)
@given(conditions)
def test_a_condition_survives_json(document: dict[Any, Any]) -> None:
    condition = TypeAdapter(Condition).validate_python(document)
    assert there_and_back(Condition, condition) == condition


@settings(deadline=None)
@given(st.lists(actors, min_size=1, max_size=4), conditions, st.floats(1.0, 86_400.0))
def test_a_scenario_survives_json(
    some: list[AircraftSpec], condition: dict[Any, Any], duration_s: float
) -> None:
    ends = TypeAdapter(Condition).validate_python(condition)
    scenario = load("s02a_headon").model_copy(
        update={"actors": tuple(some), "end_when": (ends,), "duration_s": duration_s}
    )
    assert Scenario.model_validate_json(scenario.model_dump_json()) == scenario


def test_a_scenario_cannot_be_changed() -> None:
    with pytest.raises(ValidationError, match="frozen"):
        load("s02a_headon").duration_s = 5.0  # type: ignore[misc]


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


def test_an_azimuth_is_that_at_which_the_way_begins() -> None:
    assert wgs84.azimuth((0.0, 0.0), (0.0, 1.0)) == pytest.approx(90.0 * DEGREE)
    assert wgs84.azimuth((0.0, 0.0), (1.0, 0.0)) == pytest.approx(0.0)


def test_a_scene_has_a_centre() -> None:
    assert EnRouteScene(type="en_route", centre=CENTRE).terrain_elevation_ft == 0.0


def test_the_pair_of_a_conflict_is_named_in_the_order_of_the_actors() -> None:
    scenario = load("s02a_headon")
    first, second = (actor.callsign for actor in scenario.actors[:2])
    assert scenario.pair == (first, second)
    turned = scenario.conflict.model_copy(update={"actors": (second, first)})
    assert scenario.model_copy(update={"conflict": turned}).pair == (first, second)
    assert scenario.model_copy(update={"conflict": None}).pair is None
