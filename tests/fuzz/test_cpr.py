"""Whatever bits are received, a position is decoded that is on the Earth, or none."""

from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st

from airhilt.surveillance.cpr import CprPosition, decode_global, decode_local, longitude_zones
from fuzzing import any_input

bits = st.integers(0, 2**17 - 1)
places = st.tuples(st.floats(-90.0, 90.0), st.floats(-180.0, 180.0))


@any_input
@given(bits, bits, bits, bits, st.booleans(), st.booleans(), places)
def test_any_pair_gives_a_place_on_the_earth_or_none(
    north: int, east: int, other_north: int, other_east: int,
    newest_is_odd: bool, surface: bool, receiver: tuple[float, float],
) -> None:  # fmt: skip
    even = CprPosition(north, east, odd=False, surface=surface)
    odd = CprPosition(other_north, other_east, odd=True, surface=surface)
    decoded = decode_global(even, odd, newest_is_odd, receiver)
    if decoded is not None:
        assert_on_the_earth(decoded)


@any_input
@given(bits, bits, st.booleans(), st.booleans(), places)
def test_any_bits_decoded_near_a_place_lie_within_half_a_zone_of_it(
    north: int, east: int, odd: bool, surface: bool, reference: tuple[float, float]
) -> None:
    position = CprPosition(north, east, odd, surface)
    latitude, longitude = decode_local(position, reference)
    assert math.isfinite(latitude)
    assert -180.0 <= longitude <= 180.0
    assert (
        abs(latitude - reference[0])
        <= (90.0 if position.surface else 360.0) / (60 - odd) / 2 + 1e-9
    )


@any_input
@given(st.floats(-90.0, 90.0))
def test_every_latitude_has_1_to_59_zones(latitude: float) -> None:
    assert 1 <= longitude_zones(latitude) <= 59


def assert_on_the_earth(place: tuple[float, float]) -> None:
    assert -90.0 <= place[0] <= 90.0
    assert -180.0 <= place[1] <= 180.0
