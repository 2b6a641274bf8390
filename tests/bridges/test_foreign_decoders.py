"""Programs of others read back the frames and packets of bridges."""

from __future__ import annotations

import math
import runpy
from importlib.util import find_spec
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.host import library
from airhilt.messages import EMERGENCY_STATES, ActorTruth, AdsbReport, RadarPlot
from airhilt.surveillance import cpr
from airhilt.surveillance.mode_s_frames import FrameSource
from airhilt.surveillance.transponders import EMERGENCY_CODES
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE
from reports import reports

pytestmark = pytest.mark.decoders
TRACK_CATEGORIES = {
    "A1": 1, "A2": 3, "A3": 3, "A4": 3, "A5": 5, "A6": 6, "A7": 10, "B1": 11, "B2": 12, "B3": 16,
    "B4": 15, "B6": 13, "B7": 14, "C1": 20, "C2": 21, "C3": 22,
}  # fmt: skip
METRES_PER_DEGREE = 60.0 * NAUTICAL_MILE


def steps_deg(report: AdsbReport) -> tuple[float, float]:
    """Return half a step of latitude and of longitude in the coarser of the two CPR formats."""
    span_deg = 90.0 if report.on_ground else 360.0
    zones = max(cpr.longitude_zones(min(abs(report.latitude_deg) + 1e-4, 90.0)) - 1, 1)
    return 0.5 * span_deg / 59.0 / cpr.BITS, 0.5 * span_deg / zones / cpr.BITS


@pytest.mark.skipif(
    find_spec("pyModeS") is None, reason="no pyModeS: pip install airhilt[decoders]"
)
class TestWithPyModeS:
    @settings(max_examples=500, deadline=None)
    @given(reports())
    def test_every_frame_is_read_back_as_the_report_has_it(self, report: AdsbReport) -> None:
        source = FrameSource()
        # Both the even and the odd format.
        frames = [*source.frames(report), *source.frames(report)]
        for frame in frames:
            self.check(report, frame)

    def check(self, report: AdsbReport, frame: bytes) -> None:
        import pyModeS

        place = (report.latitude_deg, report.longitude_deg)
        read = pyModeS.decode(frame.hex(), reference=place, surface_ref=place)
        assert read["icao"].lower() == report.icao24
        assert read.get("crc_valid") is not False
        said = {
            "altitude": report.altitude_ft,
            "squawk": report.squawk,
            "callsign": report.callsign,
            "vertical_rate": report.vertical_rate_fpm,
            "nac_v": report.nacv,
            "nac_p": report.nacp,
            "sil": report.sil,
            "category": int((report.emitter_category or "A0")[1]),
        }
        assert {key: read[key] for key in said.keys() & read.keys()} == {
            key: said[key] for key in said.keys() & read.keys()
        }
        if "emergency_state" in read:
            assert EMERGENCY_STATES[read["emergency_state"]] == report.emergency
        alert = report.squawk in EMERGENCY_CODES
        if read["df"] != 18:
            statuses = {"capability": 7, "flight_status": 3 if report.on_ground else 2}
            assert all((read.get(key, code) == code) >= alert for key, code in statuses.items())
            assert all((read.get(key) == code) <= alert for key, code in statuses.items())
            assert read.get("surveillance_status", alert) == alert
        if "latitude" in read:
            north, east = steps_deg(report)
            assert abs(read["latitude"] - report.latitude_deg) <= north * 1.01
            turned = (read["longitude"] - report.longitude_deg + 180.0) % 360.0 - 180.0
            assert abs(turned) <= east * 1.01
        if "groundspeed" in read and not report.on_ground:
            assert abs(read["groundspeed"] - report.ground_speed_kt) < 1.0
        if read.get("track") is not None and report.ground_speed_kt:
            assert math.cos(math.radians(read["track"] - report.track_deg)) > 0.999_999


@pytest.mark.skipif(
    find_spec("asterix") is None, reason="no asterix-decoder: pip install airhilt[decoders]"
)
class TestWithAsterixDecoder:
    @settings(max_examples=200, deadline=None)
    @given(reports())
    def test_reports_are_read_back_in_categories_021_and_062(self, report: AdsbReport) -> None:
        adsb, track = (parsed(block) for block in asterix()["Blocks"]().of_report(report))
        assert (adsb["category"], track["category"]) == (21, 62)
        assert adsb["I080"]["TAddr"].lower() == report.icao24
        assert track["I380"]["ADR"]["ADR"].lower() == report.icao24
        for item in (adsb["I070"], track["I060"]):
            assert item["Mode3A"] == report.squawk
        for item in (adsb["I170"], track["I245"]):
            assert item["TId"].rstrip() == report.callsign
        for item, step_deg in ((adsb["I131"], 1.7e-7), (track["I105"], 5.4e-6)):
            assert item["Lat"] == pytest.approx(report.latitude_deg, abs=step_deg)
            assert item["Lon"] == pytest.approx(report.longitude_deg, abs=step_deg)
        assert EMERGENCY_STATES[adsb["I200"]["PS"]] == report.emergency
        assert EMERGENCY_STATES[track["I380"]["SAB"]["STAT"]] == report.emergency
        assert bool(adsb["I040"]["GBS"]) == bool(track["I380"]["SAB"]["GBS"]) == report.on_ground
        category = report.emitter_category or "A0"
        assert track["I380"].get("EMC", {}).get("ECAT") == TRACK_CATEGORIES.get(category)
        assert (adsb["I040"]["SIM"], track["I080"]["SIM"]) == (1, 1)
        quality = adsb["I090"]
        assert (
            quality["NUCp_or_NIC"], quality["SIL"], quality["NACp"], quality["NUCr_or_NACv"]
        ) == (report.nic, report.sil, report.nacp, report.nacv)  # fmt: skip
        assert adsb["I160"]["GS"] * 3600.0 == pytest.approx(report.ground_speed_kt, abs=0.12)
        assert adsb["I160"]["TA"] == pytest.approx(report.track_deg, abs=0.006)
        speed_m_s = math.hypot(track["I185"]["Vx"], track["I185"]["Vy"])
        assert speed_m_s == pytest.approx(report.ground_speed_kt * KNOT, abs=0.2)
        if report.altitude_ft is not None:
            assert adsb["I145"]["FL"] * 100.0 == track["I136"]["MFL"] == report.altitude_ft
            assert adsb["I155"]["BVR"] == pytest.approx(report.vertical_rate_fpm, abs=3.2)
            assert track["I220"]["RoC"] == pytest.approx(report.vertical_rate_fpm, abs=3.2)

    @given(
        st.floats(0.0, 460_000.0),
        st.floats(0.0, 359.99),
        st.from_regex(r"[0-7]{4}", fullmatch=True),
        st.integers(-10, 600),
    )
    def test_a_plot_is_read_back_in_category_048(
        self, range_m: float, azimuth_deg: float, squawk: str, level: int
    ) -> None:
        plot = RadarPlot(
            site="tower", kind="combined", t_plot_ns=0, range_m=range_m,
            azimuth_deg=azimuth_deg, mode_a=squawk, mode_c_ft=100 * level,
        )  # fmt: skip
        (block,) = asterix()["Blocks"]().of_plot(plot)
        read = parsed(block)
        assert read["category"] == 48
        assert read["I020"]["TYP"] == 3
        assert read["I040"]["RHO"] == pytest.approx(range_m / NAUTICAL_MILE, abs=1 / 512)
        turned = (read["I040"]["THETA"] - azimuth_deg + 180.0) % 360.0 - 180.0
        assert abs(turned) <= 180.0 / 2**16
        assert read["I070"]["Mode3A"] == squawk
        assert read["I090"]["FL"] == level


@st.composite
def states(draw: st.DrawFn) -> ActorTruth:
    """The true state of an aircraft anywhere on the Earth."""
    speeds = st.floats(-400.0, 400.0)
    return ActorTruth(
        actor="AAL123", category="aircraft", phase="cruise", on_ground=draw(st.booleans()),
        latitude_deg=draw(st.floats(-90.0, 90.0)), longitude_deg=draw(st.floats(-180.0, 180.0)),
        altitude_m=draw(st.floats(-400.0, 15_000.0)), height_agl_m=draw(st.floats(0.0, 15_000.0)),
        velocity_north_m_s=draw(speeds), velocity_east_m_s=draw(speeds),
        velocity_down_m_s=draw(speeds), roll_deg=draw(st.floats(-180.0, 180.0)),
        pitch_deg=draw(st.floats(-90.0, 90.0)),
        heading_deg=draw(st.floats(0.0, 360.0, exclude_max=True)),
        calibrated_airspeed_m_s=draw(st.none() | st.floats(0.0, 300.0)),
    )  # fmt: skip


@pytest.mark.skipif(
    find_spec("flightgear_python") is None,
    reason="no flightgear-python: pip install airhilt[decoders]",
)
@settings(deadline=None)
@given(states(), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_flightgear_python_reads_a_state_back(state: ActorTruth, gear: float, flaps: float) -> None:
    from flightgear_python.fdm_v24 import fdm_struct

    packet = runpy.run_path(str(library.folder("bridges") / "flightgear.py"))["packet"]
    data = packet(state, gear, flaps)
    assert len(data) == fdm_struct.sizeof()
    read = fdm_struct.parse(data)
    angles = ("lat_rad", state.latitude_deg), ("lon_rad", state.longitude_deg)
    assert all(read[name] == angle * DEGREE for name, angle in angles)
    assert read.alt_m == state.altitude_m
    said = {
        "agl_m": state.height_agl_m,
        "phi_rad": state.roll_deg * DEGREE,
        "theta_rad": state.pitch_deg * DEGREE,
        "psi_rad": state.heading_deg * DEGREE,
        "vcas": (state.calibrated_airspeed_m_s or 0.0) / KNOT,
        "climb_rate_ft_per_s": -state.velocity_down_m_s / FOOT,
        "v_north_ft_per_s": state.velocity_north_m_s / FOOT,
        "v_east_ft_per_s": state.velocity_east_m_s / FOOT,
        "v_down_ft_per_s": state.velocity_down_m_s / FOOT,
        "left_flap": flaps,
        "right_flap": flaps,
    }
    assert {name: read[name] for name in said} == pytest.approx(said, rel=1e-6, abs=1e-30)
    assert (read.num_engines, read.num_tanks, read.num_wheels) == (0, 0, 3)
    assert list(read.wow) == [state.on_ground] * 3
    assert list(read.gear_pos) == pytest.approx([gear] * 3, rel=1e-6, abs=1e-30)


def asterix() -> dict[str, Any]:
    """Names that the bridge defines, with their values."""
    return runpy.run_path(str(library.folder("bridges") / "asterix.py"))


def parsed(block: bytes) -> dict[str, Any]:
    """Return the only record of a data block, its items as plain values."""
    import asterix

    (record,) = asterix.parse(block)
    return {key: plain(item) for key, item in record.items()}


def plain(item: Any) -> Any:
    if not isinstance(item, dict):
        return item
    if "val" in item:
        return item["val"]
    return {key: plain(value) for key, value in item.items()}
