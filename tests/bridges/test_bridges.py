"""Bridges join a run to something else."""

from __future__ import annotations

import math
import runpy
import signal
import socket
import struct
import subprocess
import sys
import time
from argparse import Namespace
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, suppress
from datetime import UTC, datetime, timedelta
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from scipy.spatial.transform import Rotation

from airhilt import run
from airhilt.bus import free_endpoint
from airhilt.bus.bridge import (
    WAITING,
    Feed,
    Publish,
    WallClock,
    datagrams,
    options,
    relay,
)
from airhilt.bus.session import Bus
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.errors import BusError
from airhilt.geodesy.wgs84 import earth_centred, horizontal_axes, vertical
from airhilt.host import library
from airhilt.messages import (
    ActorTruth,
    AdsbReport,
    Clock,
    CockpitInstruments,
    RadarInfo,
    RadarPlot,
)
from airhilt.scenario import Scenario
from airhilt.units import SECOND_NS
from buses import bus_of_a_run, router_of_others

LONG_S = 120.0
"""Time that a busy machine may take to start a program."""
ON_TCP = ("avr.py", "beast.py", "sbs1.py")
BRIDGES = (*ON_TCP, "asterix.py", "gdl90.py")
"""Bridges that give out ADS-B reports as bytes."""
MIDDAY = datetime(2026, 3, 1, 12, 0, 1, 500_000, tzinfo=UTC)
REPORT = AdsbReport(
    icao24="a1b2c3", callsign="AAL123", latitude_deg=38.9, longitude_deg=-77.0,
    altitude_ft=35000.0, ground_speed_kt=450.0, track_deg=90.0, vertical_rate_fpm=-64.0,
    squawk="1325", nic=8, sil=3, nacp=9, nacv=2, receiver="centre", t_adsb_in_ns=0,
    t_adsb_out_ns=1_500_000_000,
)  # fmt: skip
OTHER = REPORT.model_copy(update={"icao24": "a4d5e6"})
ON_GROUND = REPORT.model_copy(update={"altitude_ft": None, "on_ground": True})

TRUTH = ActorTruth(
    actor="AAL123", category="aircraft", phase="final", on_ground=False, latitude_deg=38.9,
    longitude_deg=-77.0, altitude_m=304.8, height_agl_m=300.0, velocity_north_m_s=60.96,
    velocity_east_m_s=-30.48, velocity_down_m_s=3.048, roll_deg=-10.0, pitch_deg=2.5,
    heading_deg=333.0, calibrated_airspeed_m_s=72.0222,
)  # fmt: skip
INSTRUMENTS = CockpitInstruments(
    callsign="AAL123", airspeed_kt=140.0, mach=0.2, altitude_ft=1000, vertical_speed_fpm=-600,
    north="true", heading_deg=333.0, track_deg=333.0, ground_speed_kt=132.5, pitch_deg=2.5,
    roll_deg=-10.0, gear=1.0, flaps=0.75, on_ground=False, mode="glide",
    selected_altitude_ft=0, selected_airspeed_kt=140,
)  # fmt: skip


def bridge(name: str) -> dict[str, Any]:
    """Names that a bridge defines, with their values."""
    return runpy.run_path(str(library.folder("bridges") / name))


def free_port() -> int:
    return int(free_endpoint().rsplit(":", 1)[1])


def basestation(report: AdsbReport) -> list[str]:
    """Lines of a report, with a bar for the address and the times, which all of them have."""
    head = ",1,1,A1B2C3,1,2026/03/01,12:00:01.500,2026/03/01,12:00:01.500,"
    return [line.replace(head, "|") for line in bridge("sbs1.py")["lines"](report, MIDDAY)]


def test_a_report_becomes_basestation_lines_with_the_fields_of_their_types() -> None:
    assert basestation(REPORT) == [
        "MSG,1|AAL123,,,,,,,,,,,",
        "MSG,6|,35000,,,,,,1325,0,0,0,0",
        "MSG,4|,,450,90,,,-64,,,,,",
        "MSG,3|,35000,,,38.90000,-77.00000,,,0,0,0,0",
    ]
    assert basestation(ON_GROUND) == [
        "MSG,1|AAL123,,,,,,,,,,,",
        "MSG,6|,,,,,,,1325,0,0,0,-1",
        "MSG,2|,,450,90,38.90000,-77.00000,,,,,,-1",
    ]


def test_an_emergency_sets_the_flags_of_a_basestation_line() -> None:
    report = REPORT.model_copy(update={"squawk": "7700", "emergency": "general"})
    assert "MSG,6|,35000,,,,,,7700,-1,-1,0,0" in basestation(report)


def test_a_basestation_line_has_no_minus_zero_and_no_360_degrees() -> None:
    report = REPORT.model_copy(
        update={"track_deg": 359.7, "vertical_rate_fpm": -0.1, "latitude_deg": -1e-7}
    )
    assert basestation(report)[2:] == [
        "MSG,4|,,450,0,,,0,,,,,",
        "MSG,3|,35000,,,0.00000,-77.00000,,,0,0,0,0",
    ]


def test_the_first_time_of_a_run_is_now_and_the_others_follow_it() -> None:
    times, before = WallClock(), datetime.now(UTC)
    first = times.at(7 * SECOND_NS)
    assert before <= first <= datetime.now(UTC)
    assert (times.at(10 * SECOND_NS) - first).total_seconds() == 3.0


def test_a_beast_packet_doubles_the_escape_in_all_that_follows_the_type() -> None:
    frame = bytes.fromhex("8d1a1a402c1a0000000000000000"[:28])
    packet = bridge("beast.py")["packet"](frame, 1_000_000_000)
    assert packet[:2] == b"\x1a3"
    content = packet[2:].replace(b"\x1a\x1a", b"\x1a")
    assert int.from_bytes(content[:6]) == 12_000_000
    assert content[7:] == frame
    assert packet.count(b"\x1a") == 1 + 2 * content.count(b"\x1a")


def test_a_frame_becomes_a_line_of_avr() -> None:
    assert bridge("avr.py")["line"](bytes.fromhex("5da1b2c306b148")) == "*5DA1B2C306B148;"


class TestGdl90:
    """The examples are those of the GDL 90 Data Interface Specification, revision A."""

    def test_the_heartbeat_of_the_specification_is_framed_as_there(self) -> None:
        framed = bridge("gdl90.py")["framed"]
        assert framed(bytes.fromhex("0081 41db d008 02")).hex() == "7e008141dbd00802b38b7e"

    def test_the_traffic_report_of_the_specification_comes_out_byte_for_byte(self) -> None:
        report = AdsbReport(
            icao24="ab4549", callsign="N825V", emitter_category="A1", latitude_deg=44.90708,
            longitude_deg=-122.99488, altitude_ft=5000.0, ground_speed_kt=123.0, track_deg=45.0,
            vertical_rate_fpm=64.0, nic=10, nacp=9, nacv=2, receiver="centre", t_adsb_in_ns=0,
            t_adsb_out_ns=0,
        )  # fmt: skip
        assert bridge("gdl90.py")["report_message"](20, report).hex() == (
            "1400ab45491fef15a889780f09a907b00120014e3832355620202000"
        )

    def test_flags_and_escapes_inside_a_message_are_stuffed(self) -> None:
        framed = bridge("gdl90.py")["framed"](bytes([0, 0x7E, 0x7D]))
        assert framed[:6] == bytes([0x7E, 0, 0x7D, 0x5E, 0x7D, 0x5D])
        assert framed[1:-1].count(0x7E) == 0

    def test_a_second_has_a_heartbeat_the_own_aircraft_and_the_others_heard_in_it(self) -> None:
        traffic = bridge("gdl90.py")["Traffic"]("a1b2c3")
        for report in (REPORT, OTHER, OTHER):
            traffic.hear(report)
        first, second = (
            [(message[0], message[2:5].hex()) for message in traffic.messages(MIDDAY)][1:]
            for _ in range(2)
        )
        assert first == [(10, "a1b2c3"), (20, "a4d5e6")]
        assert second == [(10, "a1b2c3")]

    def test_an_ownship_that_is_silent_for_five_seconds_has_no_valid_position(self) -> None:
        traffic = bridge("gdl90.py")["Traffic"]("a1b2c3")
        traffic.hear(REPORT)
        seconds = [list(traffic.messages(MIDDAY)) for _ in range(6)]
        traffic.hear(REPORT)
        seconds.append(list(traffic.messages(MIDDAY)))
        assert [heartbeat[1] >> 7 for heartbeat, _ in seconds] == [1, 1, 1, 1, 1, 0, 1]
        (_, valid), (_, silent) = seconds[4:6]
        assert silent == valid[:5] + bytes(6) + valid[11:13] + bytes([valid[13] & 0xF]) + valid[14:]

    def test_an_ownship_that_never_comes_is_named(self) -> None:
        traffic = bridge("gdl90.py")["Traffic"]("a1b2c3")
        traffic.hear(OTHER)
        assert traffic.missing().startswith("no report of a1b2c3 yet")
        traffic.hear(REPORT)
        assert traffic.missing() is None


class TestFlightGear:
    """Places of fields are those of net_fdm.hxx of FlightGear 2020.3, version 24."""

    def test_a_packet_has_the_size_version_and_fields_of_the_published_structure(self) -> None:
        packet = bridge("flightgear.py")["packet"](TRUTH, gear=0.5, flaps=0.25)
        assert len(packet) == 408
        assert struct.unpack_from(">I", packet) == (24,)
        assert struct.unpack_from(">3d", packet, 8) == pytest.approx(
            (math.radians(-77.0), math.radians(38.9), 304.8)
        )
        height, *attitude = struct.unpack_from(">4f", packet, 32)
        assert height == 300.0
        assert attitude == pytest.approx([math.radians(angle) for angle in (-10.0, 2.5, 333.0)])
        airspeed_and_velocity = struct.unpack_from(">5f", packet, 68)
        assert airspeed_and_velocity == pytest.approx((140.0, -10.0, 200.0, -100.0, 10.0), rel=1e-5)
        assert (
            struct.unpack_from(">I", packet, 120) == struct.unpack_from(">I", packet, 284) == (0,)
        )
        assert struct.unpack_from(">I3I3f", packet, 304) == (3, 0, 0, 0, 0.5, 0.5, 0.5)
        assert struct.unpack_from(">2f", packet, 376) == (0.25, 0.25)

    def test_gear_and_flaps_are_those_of_the_instruments_of_the_aircraft(self) -> None:
        aircraft = bridge("flightgear.py")["Aircraft"]("AAL123")
        aircraft.hear(TRUTH, 0.0)
        assert wheels_and_flaps(aircraft.packet(0.0)) == (0.0, 0.0)
        aircraft.read(INSTRUMENTS.model_copy(update={"callsign": "UAL7", "flaps": 0.1}))
        aircraft.read(INSTRUMENTS)
        assert wheels_and_flaps(aircraft.packet(0.0)) == (1.0, 0.75)

    def test_the_aircraft_goes_on_between_two_states_as_it_moved_and_turned(self) -> None:
        aircraft = bridge("flightgear.py")["Aircraft"]("AAL123")
        later = {"t_ns": 200_000_000, "roll_deg": -9.0, "heading_deg": 1.0}
        aircraft.hear(TRUTH.model_copy(update={"heading_deg": 359.0}), 50.0)
        aircraft.hear(TRUTH.model_copy(update=later), 50.2)
        at_once, soon, in_a_pause, in_a_long_pause = (
            shown(aircraft.packet(now_s)) for now_s in (50.2, 50.3, 50.7, 60.0)
        )
        assert soon["north_m"] - at_once["north_m"] == pytest.approx(6.096, abs=0.02)
        assert at_once["altitude_m"] - soon["altitude_m"] == pytest.approx(0.3048)
        assert (soon["roll_deg"], soon["heading_deg"]) == pytest.approx((-8.5, 2.0), abs=1e-4)
        assert in_a_pause == in_a_long_pause

    def test_jitter_of_what_arrives_moves_nothing_much(self) -> None:
        aircraft = bridge("flightgear.py")["Aircraft"]("AAL123")
        places = []
        for count in range(50):
            now_s, place = 0.2 * count, 38.9 + 12.192 * count / 111_000.0
            update = {"t_ns": count * 200_000_000, "latitude_deg": place}
            aircraft.hear(TRUTH.model_copy(update=update), now_s + 0.04 * (count % 3))
            places.append(shown(aircraft.packet(now_s + 0.15))["north_m"])
        steps = [after - before for before, after in pairwise(places[10:])]
        assert max(steps) - min(steps) < 1.5

    def test_an_aircraft_that_never_comes_is_named(self) -> None:
        aircraft = bridge("flightgear.py")["Aircraft"]("TYPO")
        aircraft.hear(TRUTH, 0.0)
        assert aircraft.missing().startswith("no report of TYPO yet")
        assert aircraft.packet(0.0) is None
        aircraft.hear(TRUTH.model_copy(update={"actor": "TYPO"}), 0.0)
        assert aircraft.missing() is None

    def test_the_others_are_multiplayer_traffic_with_models_by_their_category(self) -> None:
        others = bridge("flightgear.py")["Others"]("AAL123")
        assert others.packet(TRUTH) is None
        assert (
            others.packet(TRUTH.model_copy(update={"actor": "D", "category": "wildlife"})) is None
        )
        other = TRUTH.model_copy(
            update={"actor": "N310TWXYZ", "icao24": "a1b2c3", "t_ns": SECOND_NS}
        )
        others.read(REPORT.model_copy(update={"emitter_category": "A5"}))
        packet = others.packet(other)
        assert len(packet) == 232
        assert struct.unpack_from(">4I", packet) == (0x46474653, 0x00010001, 7, 232)
        assert packet[24:32] == b"N310TWX\0"
        assert packet[32:128].rstrip(b"\0") == b"Aircraft/747/744-Default.xml"
        assert struct.unpack_from(">2d", packet, 128) == (1.0, 0.2)
        place = struct.unpack_from(">3d", packet, 144)
        assert place == pytest.approx(
            earth_centred((math.radians(38.9), math.radians(-77.0)), 304.8)
        )
        turn = Rotation.from_rotvec(struct.unpack_from(">3f", packet, 168))
        forward, right, below = turn.as_matrix().T
        east, north = horizontal_axes((math.radians(38.9), math.radians(-77.0)))
        up = vertical((math.radians(38.9), math.radians(-77.0)))
        assert math.degrees(math.atan2(forward @ east, forward @ north)) % 360 == pytest.approx(333)
        assert math.degrees(math.asin(forward @ up)) == pytest.approx(2.5, abs=1e-4)
        assert math.degrees(math.atan2(-(right @ up), -(below @ up))) == pytest.approx(
            -10, abs=1e-4
        )
        along = struct.unpack_from(">3f", packet, 180)
        assert turn.apply(along) @ north == pytest.approx(60.96, abs=1e-3)
        assert turn.apply(along) @ up == pytest.approx(-3.048, abs=1e-3)

    def test_the_chosen_aircraft_and_the_others_are_shown_until_the_run_ends(self) -> None:
        with ExitStack() as stack:
            bus = stack.enter_context(bus_of_a_run("recorder"))
            own, traffic = (
                stack.enter_context(socket.socket(type=socket.SOCK_DGRAM)) for _ in range(2)
            )
            for simulator in (own, traffic):
                simulator.bind(("127.0.0.1", 0))
            program = subprocess.Popen(
                [
                    *command("flightgear.py", bus.endpoint, own.getsockname()[1]),
                    "--aircraft", "AAL123", "--traffic-port", str(traffic.getsockname()[1]),
                ]
            )  # fmt: skip
            still = {f"velocity_{axis}_m_s": 0.0 for axis in ("north", "east", "down")}
            chosen = TRUTH.model_copy(update=still)
            other = chosen.model_copy(update={"actor": "UAL7", "altitude_m": 9000.0})
            heard: list[bytes] = []
            others: list[bytes] = []

            def is_heard() -> bool:
                for state in (other, chosen):
                    key = f"truth/state/{state.actor}"
                    bus.put(key, state.model_dump_json().encode())
                heard.extend(pieces(own))
                others.extend(pieces(traffic))
                return len(heard) > 2 and len(others) > 2

            wait_until(is_heard)
            end = Clock(run="run", phase="finished", pace="1x")
            bus.put("clock", end.model_dump_json().encode())
            assert program.wait(timeout=LONG_S) == 0
        assert {struct.unpack_from(">d", packet, 24)[0] for packet in heard} == {304.8}
        assert {packet[24:32].rstrip(b"\0") for packet in others} == {b"UAL7"}


def shown(packet: bytes) -> dict[str, float]:
    """Return where an aircraft is by a packet of the native FDM, and how it is turned."""
    _, latitude_rad, altitude_m = struct.unpack_from(">3d", packet, 8)
    roll_rad, _, heading_rad = struct.unpack_from(">3f", packet, 36)
    return {
        "north_m": latitude_rad * 6.36e6,
        "altitude_m": altitude_m,
        "roll_deg": math.degrees(roll_rad),
        "heading_deg": math.degrees(heading_rad),
    }


def wheels_and_flaps(packet: bytes) -> tuple[float, float]:
    """Return the position of the first gear and of the left flap in a packet."""
    return struct.unpack_from(">f", packet, 320)[0], struct.unpack_from(">f", packet, 376)[0]


class TestFeed:
    @pytest.fixture
    def port(self) -> int:
        return free_port()

    @pytest.fixture
    def feed(self, port: int) -> Iterator[Feed]:
        feed = Feed()
        feed.listen(port)
        yield feed
        feed.close()

    def test_a_client_that_never_reads_is_let_go_and_the_others_hear_on(
        self, feed: Feed, port: int
    ) -> None:
        with socket.create_connection(("127.0.0.1", port)):
            wait_until(lambda: fed(feed) == 1)
            while fed(feed):
                feed.send(bytes(100_000))
            with socket.create_connection(("127.0.0.1", port)) as reading:
                wait_until(lambda: fed(feed) == 1)
                feed.send(b"heard\n")
                assert reading.recv(6) == b"heard\n"

    def test_a_client_that_never_reads_does_not_hold_up_the_end(
        self, feed: Feed, port: int
    ) -> None:
        with socket.create_connection(("127.0.0.1", port)):
            wait_until(lambda: fed(feed) == 1)
            for _ in range(WAITING // 2):
                feed.send(bytes(100_000))
            feed.close()

    def test_a_program_that_listens_itself_is_connected_to_again_after_it_went(self) -> None:
        feed = Feed()
        with socket.create_server(("127.0.0.1", 0)) as server:
            feed.connect(f"127.0.0.1:{server.getsockname()[1]}")
            for _ in range(2):
                connection, _ = server.accept()
                wait_until(lambda: fed(feed) == 1)
                feed.send(b"heard\n")
                assert connection.recv(6) == b"heard\n"
                connection.close()
                while fed(feed):
                    feed.send(b"lost\n")
                    time.sleep(0.01)

    @pytest.mark.parametrize("address", ["30004", "127.0.0.1:99999", "..:3", "no such host:3"])
    def test_what_is_no_address_is_refused(self, address: str) -> None:
        with pytest.raises(BusError, match="--to"):
            Feed().connect(address)

    def test_a_program_that_does_not_answer_is_told_once_and_connected_to_when_it_does(
        self, port: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
    ) -> None:
        monkeypatch.setattr("airhilt.bus.bridge.RETRY_S", 0.01)
        feed, told = Feed(), []

        def is_told() -> bool:
            told.extend(capsys.readouterr().err.splitlines())
            return any(f"127.0.0.1:{port}" in line for line in told)

        feed.connect(f"127.0.0.1:{port}")
        wait_until(is_told)
        time.sleep(0.1)
        with socket.create_server(("127.0.0.1", port)):
            wait_until(lambda: fed(feed) == 1)
        assert is_told()
        assert sum(f"127.0.0.1:{port}" in line for line in told) == 1

    def test_datagrams_for_a_host_that_cannot_be_are_refused(self) -> None:
        with pytest.raises(BusError, match="--to"):
            datagrams("no such host", 4000)


def fed(feed: Feed) -> int:
    """Number of clients of a feed."""
    return len(feed.clients)


def wait_until(is_true: Callable[[], bool]) -> None:
    deadline = time.monotonic() + LONG_S
    while not is_true():
        assert time.monotonic() < deadline
        time.sleep(0.01)


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("beast.py", ["--to", "127.0.0.1:99999"]),
        ("gdl90.py", ["--ownship", "AAL123"]),
        ("sbs_in.py", ["--from", ".."]),
    ],
)
def test_a_target_that_cannot_be_is_one_line_and_exit_code_2(name: str, given: list[str]) -> None:
    done = subprocess.run(
        [*command(name, free_endpoint(), 30003), *given],
        capture_output=True, text=True, timeout=LONG_S,
    )  # fmt: skip
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert given[0] in line


def connected_to(bus: Bus) -> Namespace:
    return options(None, 1).parse_args(["--connect", bus.endpoint])


def test_a_feed_that_fails_ends_its_bridge_with_an_error() -> None:
    def feed(_publish: Publish) -> None:
        raise KeyError("no such frame")

    with bus_of_a_run("operator") as bus, pytest.raises(BusError, match="no such frame"):
        relay(connected_to(bus), {}, feed=feed)


def test_what_is_still_missing_after_a_while_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("airhilt.bus.bridge.SILENCE_S", 0.1)
    told: list[str] = []
    with bus_of_a_run() as bus, ThreadPoolExecutor() as pool:
        relaying = pool.submit(
            relay, connected_to(bus), {}, missing=lambda: "no report of AAL123 yet"
        )

        def is_told() -> bool:
            told.extend(capsys.readouterr().err.splitlines())
            return "no report of AAL123 yet" in told

        def is_over() -> bool:
            end = Clock(run="run", phase="finished", pace="1x")
            bus.put("clock", end.model_dump_json().encode())
            return relaying.done()

        wait_until(is_told)
        wait_until(is_over)


def test_radars_have_data_sources_in_the_order_of_their_names_and_a_line_each() -> None:
    blocks = bridge("asterix.py")["Blocks"]()
    north, south = (
        RadarInfo(
            site=site, kind="terminal", latitude_deg=38.9, longitude_deg=-77.0, altitude_m=30.0,
            rotation_s=5.0, primary_range_m=1e5, secondary_range_m=4e5,
        )
        for site in ("north", "south")
    )  # fmt: skip
    assert list(blocks.number([south, north])) == [
        "radar north: data source 0/3, antenna at 38.900000 -77.000000, 30 m",
        "radar south: data source 0/4, antenna at 38.900000 -77.000000, 30 m",
    ]
    plot = RadarPlot(site="south", kind="primary", t_plot_ns=0, range_m=1.0, azimuth_deg=0.0)
    (block,) = blocks.of_plot(plot)
    assert block[4:6] == bytes([0, 4])


@pytest.mark.parametrize("name", ON_TCP)
def test_a_port_that_is_taken_is_one_line_and_exit_code_2(name: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        done = subprocess.run(
            command(name, free_endpoint(), port), capture_output=True, text=True, timeout=LONG_S
        )
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert f"127.0.0.1:{port}" in line
    assert "--port" in line


def command(name: str, endpoint: str, port: int) -> list[str]:
    """Return the command that starts a bridge."""
    program = str(library.folder("bridges") / name)
    return [sys.executable, program, "--connect", endpoint, "--port", str(port)]


@pytest.fixture(scope="module")
def received() -> dict[str, bytes]:
    """Bytes that each bridge gave out of a run of two aircraft, while a client of it hung."""
    with ExitStack() as stack:
        bus = stack.enter_context(bus_of_a_run())
        ports = {name: free_port() for name in BRIDGES}
        clients = {}
        for name in set(BRIDGES) - set(ON_TCP):
            clients[name] = stack.enter_context(socket.socket(type=socket.SOCK_DGRAM))
            clients[name].bind(("127.0.0.1", ports[name]))
        programs = [subprocess.Popen(command(name, bus.endpoint, ports[name])) for name in BRIDGES]
        for name in ON_TCP:
            stack.enter_context(connected(ports[name]))
            clients[name] = stack.enter_context(connected(ports[name]))
        heard = dict.fromkeys(BRIDGES, b"")

        def is_heard_everywhere() -> bool:
            for report in (REPORT, OTHER):
                bus.put(f"adsb/{report.icao24}", report.model_dump_json().encode())
            for name, client in clients.items():
                heard[name] += b"".join(pieces(client))
            return all(is_of_both(data) for data in heard.values())

        wait_until(is_heard_everywhere)
        bus.put("clock", Clock(run="run", phase="finished", pace="1x").model_dump_json().encode())
        assert {program.wait(timeout=LONG_S) for program in programs} == {0}
        return heard


def test_a_bridge_ends_with_a_run_that_goes_without_a_word() -> None:
    port = free_port()
    with bus_of_a_run() as bus:
        program = subprocess.Popen(command("sbs1.py", bus.endpoint, port))
        with connected(port) as client:

            def is_heard() -> bool:
                bus.put("adsb/a1b2c3", REPORT.model_dump_json().encode())
                return bool(list(pieces(client)))

            wait_until(is_heard)
    assert program.wait(timeout=LONG_S) == 0


def is_of_both(data: bytes) -> bool:
    """Return whether both aircraft are in what a bridge gave out, as text or as bytes."""
    return all(
        report.icao24.upper().encode() in data or bytes.fromhex(report.icao24) in data
        for report in (REPORT, OTHER)
    )


def connected(port: int) -> socket.socket:
    """Return a connection with a bridge as soon as it listens."""
    connections: list[socket.socket] = []

    def is_connected() -> bool:
        with suppress(OSError):
            connections.append(socket.create_connection(("127.0.0.1", port)))
        return bool(connections)

    wait_until(is_connected)
    return connections[0]


def pieces(client: socket.socket) -> Iterator[bytes]:
    """Yield what has come for a client."""
    client.setblocking(False)
    with suppress(BlockingIOError):
        while piece := client.recv(100_000):
            yield piece


def test_every_bridge_gives_out_both_aircraft_and_ends_with_the_run(
    received: dict[str, bytes],
) -> None:
    assert {name for name, data in received.items() if is_of_both(data)} == set(BRIDGES)


def test_the_lines_of_a_run_are_of_today(received: dict[str, bytes]) -> None:
    lines = [line.split(",") for line in received["sbs1.py"].decode().splitlines()]
    today, yesterday = (datetime.now(UTC) - timedelta(days=days) for days in (0, 1))
    assert lines[-1][6] in {f"{day:%Y/%m/%d}" for day in (today, yesterday)}


class UntilAllHear(Observer):
    """Holds up a run until a client of every bridge has heard it, and then stops a bridge."""

    def __init__(self, clients: dict[str, socket.socket], stopped: subprocess.Popen[bytes]) -> None:
        self.silent = set(clients)
        self._clients = clients
        self._stopped = stopped

    def snapshot(self, snapshot: Snapshot) -> None:
        if self.silent:
            time.sleep(1.0)
            self.silent -= {name for name, client in self._clients.items() if any(pieces(client))}
            if not self.silent:
                self._stopped.send_signal(signal.SIGSTOP)


def test_bridges_beside_a_run_leave_its_log_as_it_is_even_if_one_hangs(
    encounter: Scenario, tmp_path: Path
) -> None:
    """Clients of the others never read, but for one of each."""
    settings: dict[str, Any] = {"seed": 3, "latency": "fixed", "share_truth": True, "report": False}
    alone = run(encounter, out=tmp_path / "alone", **settings)
    endpoint = free_endpoint()
    with ExitStack() as stack:
        router = stack.enter_context(router_of_others())
        ports = {name: free_port() for name in (*BRIDGES, "flightgear.py")}
        if find_spec("foxglove"):
            ports["foxglove_websocket.py"] = free_port()
        if find_spec("rosbags") and find_spec("xxhash"):
            ports["ros2.py"] = int(router.rsplit(":", 1)[1])
        clients = {}
        for name in {*BRIDGES, "flightgear.py"} - set(ON_TCP):
            clients[name] = stack.enter_context(socket.socket(type=socket.SOCK_DGRAM))
            clients[name].bind(("127.0.0.1", ports[name]))
        programs = {
            name: subprocess.Popen(
                command(name, endpoint, port)
                + (["--aircraft", "AAL123"] if name == "flightgear.py" else [])
            )
            for name, port in ports.items()
        }
        for name in ON_TCP:
            stack.enter_context(connected(ports[name]))
            clients[name] = stack.enter_context(connected(ports[name]))
        observer = UntilAllHear(clients, programs["sbs1.py"])
        beside = run(
            encounter, out=tmp_path / "beside", endpoint=endpoint, observer=observer, **settings
        )
        programs["sbs1.py"].send_signal(signal.SIGCONT)
        codes = {name: program.wait(timeout=LONG_S) for name, program in programs.items()}
    assert not observer.silent
    assert codes == dict.fromkeys(ports, 0)
    log, other = (folder.folder / "log.mcap" for folder in (alone, beside))
    assert log.read_bytes() == other.read_bytes()
