"""ADS-B reports for tests of what is made of them."""

from __future__ import annotations

import math
from typing import get_args

from hypothesis import strategies as st

from airhilt.messages import EMERGENCY_STATES, AdsbReport, EmitterCategory
from airhilt.surveillance.squitters import SURFACE_TRACK_STEP_DEG, movement_kt
from airhilt.units import bearing_degrees

REPORT = AdsbReport(
    icao24="a1b2c3", callsign="AAL123", emitter_category="A3", latitude_deg=38.9,
    longitude_deg=-77.0, altitude_ft=35_000.0, ground_speed_kt=450.0, track_deg=90.0,
    vertical_rate_fpm=-64.0, squawk="1325", nic=8, sil=3, nacp=9, nacv=2, receiver="centre",
    t_adsb_in_ns=0, t_adsb_out_ns=1_500_000_000,
)  # fmt: skip


@st.composite
def reports(draw: st.DrawFn) -> AdsbReport:
    """A report with all that a squitter can carry, anywhere on the Earth."""
    on_ground = draw(st.booleans())
    if on_ground:
        speed_kt = movement_kt(draw(st.floats(0.0, 200.0)))
        track_deg = draw(st.integers(0, 127)) * SURFACE_TRACK_STEP_DEG
    else:
        east, north = draw(st.tuples(*[st.integers(-1000, 1000)] * 2))
        speed_kt, track_deg = math.hypot(east, north), bearing_degrees(math.atan2(east, north))
    return AdsbReport(
        icao24=f"{draw(st.integers(1, 2**24 - 2)):06x}",
        callsign=draw(st.from_regex(r"[A-Z0-9]{2,8}", fullmatch=True)),
        emitter_category=draw(st.sampled_from(get_args(EmitterCategory))),
        latitude_deg=draw(st.floats(-90.0, 90.0) | st.sampled_from([-90.0, 0.0, 90.0])),
        longitude_deg=draw(st.floats(-180.0, 180.0) | st.sampled_from([-180.0, 0.0, 180.0])),
        altitude_ft=None if on_ground else 25.0 * draw(st.integers(-40, 2007)),
        on_ground=on_ground,
        ground_speed_kt=speed_kt,
        track_deg=track_deg,
        vertical_rate_fpm=0.0 if on_ground else 64.0 * draw(st.integers(-500, 500)),
        squawk=draw(st.from_regex(r"[0-7]{4}", fullmatch=True) | st.just("7700")),
        emergency=draw(st.sampled_from(EMERGENCY_STATES)),
        nic=draw(st.integers(0, 11)),
        sil=draw(st.integers(0, 3)),
        nacp=draw(st.integers(0, 11)),
        nacv=draw(st.integers(0, 4)),
        receiver="centre",
        t_adsb_in_ns=0,
        t_adsb_out_ns=0,
    )
