"""Bridges that give the targets of real receivers to a run as further ADS-B traffic."""

from __future__ import annotations

import random
import runpy
import socket
import subprocess
import sys
import threading
from collections.abc import Iterable
from contextlib import closing, suppress
from datetime import UTC, datetime
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt.bus import free_endpoint
from airhilt.host import library
from airhilt.messages import AdsbReport, Event, LiveReport
from airhilt.record import read_log
from airhilt.scenario import Scenario
from airhilt.surveillance import mode_s
from airhilt.surveillance.mode_s_frames import FrameSource
from recorded import ADDRESS, CALLSIGN, reports, sbs_lines, turning_climb

LONG_S = 120.0
HAS_DECODER = find_spec("pyModeS") is not None
needs_decoder = pytest.mark.skipif(
    not HAS_DECODER, reason="no pyModeS: pip install airhilt[decoders]"
)


def bridge(name: str) -> dict[str, Any]:
    return runpy.run_path(str(library.folder("bridges") / name))


def in_pieces(data: bytes, size: int) -> list[bytes]:
    return [data[at : at + size] for at in range(0, len(data), size)]


def sbs_bytes() -> bytes:
    return "".join(f"{line}\r\n" for line in sbs_lines(turning_climb(10.0))).encode()


def test_a_line_of_an_sbs_feed_becomes_a_report_though_it_comes_in_pieces() -> None:
    feed = bridge("sbs_in.py")["SbsFeed"]()
    found = [report for piece in in_pieces(sbs_bytes(), 41) for report in feed.reports(piece)]
    assert len(found) == 11
    flown, last = turning_climb(10.0)[-1], found[-1]
    assert (last.icao24, last.callsign, last.squawk) == (ADDRESS, CALLSIGN, "1000")
    assert (last.latitude_deg, last.longitude_deg) == (flown.latitude_deg, flown.longitude_deg)
    assert (last.altitude_ft, last.on_ground) == (flown.altitude_ft, False)
    assert (last.ground_speed_kt, last.track_deg, last.vertical_rate_fpm) == (440.0, 60.0, 1200.0)
    assert (last.nic, last.nacp) == (0, 0)


@pytest.mark.parametrize("line", ["", "MSG,3", "MSG,3" + "," * 17, "MSG,3,,,zz" + ",9" * 17])
def test_a_line_that_is_none_gives_no_report(line: str) -> None:
    assert list(bridge("sbs_in.py")["SbsFeed"]().reports(f"{line}\n".encode())) == []


@needs_decoder
def test_frames_of_a_beast_feed_become_reports_of_what_was_sent() -> None:
    packet, source = bridge("beast.py")["packet"], FrameSource()
    sent = list(reports(turning_climb(10.0)))
    data = b"".join(packet(each, one.t_adsb_in_ns) for one in sent for each in source.frames(one))
    feed = bridge("beast_in.py")["BeastFeed"]()
    found = [report for piece in in_pieces(data, 37) for report in feed.reports(piece)]
    last = found[-1]
    assert len(found) > 5
    assert (last.icao24, last.callsign, last.emitter_category) == (ADDRESS, CALLSIGN, "A3")
    assert last.altitude_ft in {each.altitude_ft for each in sent}
    assert last.latitude_deg == pytest.approx(sent[-1].latitude_deg, abs=0.005)
    assert last.ground_speed_kt == pytest.approx(440.0, abs=1.0)
    assert (last.nacp, last.nacv, last.sil) == (9, 2, 3)


def heard(feed: Any, sent: Iterable[AdsbReport]) -> list[LiveReport]:
    """Return what a Beast feed makes of the frames of reports."""
    packet, source = bridge("beast.py")["packet"], FrameSource()
    frames = ((frame, one.t_adsb_in_ns) for one in sent for frame in source.frames(one))
    return list(feed.reports(b"".join(packet(*each) for each in frames)))


def changed(**values: Any) -> list[AdsbReport]:
    return [each.model_copy(update=values) for each in reports(turning_climb(10.0))]


@needs_decoder
def test_every_integrity_of_a_beast_feed_is_that_of_what_was_sent() -> None:
    for nic in range(12):
        assert heard(bridge("beast_in.py")["BeastFeed"](), changed(nic=nic))[-1].nic == nic


@needs_decoder
@pytest.mark.parametrize(
    ("squawk", "sent", "expected"),
    [
        ("7700", "general", "general"),
        ("7700", "medical", "medical"),
        ("7600", "none", "no_communications"),
        ("1000", "minimum_fuel", "minimum_fuel"),
        ("1000", "none", "none"),
    ],
)
def test_an_emergency_of_a_beast_feed_is_kept(squawk: str, sent: str, expected: str) -> None:
    feed = bridge("beast_in.py")["BeastFeed"]()
    assert heard(feed, changed(squawk=squawk, emergency=sent))[-1].emergency == expected


@pytest.mark.parametrize(("squawk", "emergency"), [("7700", "general"), ("1000", "none")])
def test_an_emergency_of_an_sbs_feed_is_kept(squawk: str, emergency: str) -> None:
    data = sbs_bytes().replace(b",1000,", f",{squawk},".encode())
    *_, last = bridge("sbs_in.py")["SbsFeed"]().reports(data)
    assert last.emergency == emergency


@needs_decoder
def test_frames_with_any_content_leave_a_beast_feed_alive() -> None:
    """They are of another aircraft: all 32 type codes, with reserved values among them."""
    packet, draw = bridge("beast.py")["packet"], random.Random(1)
    feed = bridge("beast_in.py")["BeastFeed"]()
    for code in range(32):
        for _ in range(100):
            message = code << 51 | draw.getrandbits(51)
            frame = mode_s.extended_squitter(0xABCDEF, message, on_ground=False)
            list(feed.reports(packet(frame, 0)))
    assert heard(feed, changed())


@needs_decoder
def test_reserved_accuracies_are_unknown() -> None:
    """An operational status with NACp 15, and velocities with NACv 7."""
    last = heard(bridge("beast_in.py")["BeastFeed"](), changed(nacp=15, nacv=7))[-1]
    assert (last.nacp, last.nacv) == (0, 0)


@needs_decoder
def test_a_feed_that_is_not_beast_is_told_once_and_a_beast_feed_is_heard_after_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    feed = bridge("beast_in.py")["BeastFeed"]()
    for _ in range(3):
        assert not list(feed.reports(sbs_bytes() * 10))
    (line,) = capsys.readouterr().err.splitlines()
    assert "no Beast feed" in line
    assert heard(feed, changed())


@pytest.mark.parametrize(
    ("sent", "callsign"), [("dlh9x", "DLH9X"), ("D-EABC", None), ("DLH9XLONG", None)]
)
def test_a_callsign_of_a_feed_has_the_characters_of_mode_s_or_is_none(
    sent: str, callsign: str | None
) -> None:
    data = sbs_bytes().replace(CALLSIGN.encode(), sent.encode())
    *_, last = bridge("sbs_in.py")["SbsFeed"]().reports(data)
    assert last.callsign == callsign


def test_lines_of_the_sbs1_bridge_become_the_reports_that_were_sent() -> None:
    lines = bridge("sbs1.py")["lines"]
    sent = changed(squawk="7700", emergency="general")
    when = datetime(2026, 3, 1, tzinfo=UTC)
    data = "".join(f"{line}\r\n" for one in sent for line in lines(one, when)).encode()
    found = list(bridge("sbs_in.py")["SbsFeed"]().reports(data))
    told = ("callsign", "altitude_ft", "ground_speed_kt", "track_deg", "squawk", "emergency")
    assert [one.model_dump(include={*told}) for one in found] == [
        one.model_dump(include={*told}) for one in sent
    ]


def test_lines_that_cannot_be_read_are_left_out_and_the_others_are_heard() -> None:
    lines = [line.split(b",") for line in sbs_bytes().splitlines(keepends=True)]
    broken = [
        b",".join([*fields[:at], bad, *fields[at + 1 :]])
        for fields in lines[-3:]
        for at in range(6, len(fields) - 1)
        for bad in (b"x", b"nan", b"1e400", b"\xff")
    ]
    feed = bridge("sbs_in.py")["SbsFeed"]()
    list(feed.reports(b"".join(broken) + b"\x00\n"))
    assert len(list(feed.reports(sbs_bytes()))) == 11


@pytest.mark.skipif(HAS_DECODER, reason="pyModeS is installed")
def test_without_pymodes_the_bridge_says_what_to_install() -> None:
    program = str(library.folder("bridges") / "beast_in.py")
    done = subprocess.run(
        [sys.executable, program, "--connect", free_endpoint()],
        capture_output=True, text=True, timeout=LONG_S,
    )  # fmt: skip
    assert done.returncode == 2
    assert done.stderr.splitlines() == [
        "error: Mode S frames need pyModeS, which is not installed: pip install airhilt[decoders]"
    ]


def test_a_run_takes_the_targets_of_a_receiver_but_none_of_its_own_aircraft(
    encounter: Scenario, tmp_path: Path
) -> None:
    """The receiver hears an aircraft of its own, and one of the scenario."""
    (own, _) = (actor for actor in encounter.actors if actor.type == "aircraft")
    data = sbs_bytes()
    data += data.replace(ADDRESS.upper().encode(), own.icao24.upper().encode())
    endpoint, is_over = free_endpoint(), threading.Event()

    def serve(server: socket.socket) -> None:
        with suppress(OSError):
            connection, _ = server.accept()
            with connection:
                while not is_over.wait(0.2):
                    connection.sendall(data)

    short = encounter.model_copy(update={"duration_s": 20.0})
    with socket.create_server(("127.0.0.1", 0)) as server, closing(server):
        threading.Thread(target=serve, args=(server,), daemon=True).start()
        program = str(library.folder("bridges") / "sbs_in.py")
        port = str(server.getsockname()[1])
        with subprocess.Popen(
            [sys.executable, program, "--connect", endpoint, "--port", port]
        ) as process:
            result = airhilt.run(
                short, out=tmp_path / "run", endpoint=endpoint, assistant="none", latency="fixed",
                speech=False, report=False, pace="realtime",
            )  # fmt: skip
            is_over.set()
            assert process.wait(timeout=LONG_S) == 0
    log = list(read_log(result.folder / "log.mcap"))
    heard = [
        AdsbReport.model_validate_json(each.data) for each in log if each.key == f"adsb/{ADDRESS}"
    ]
    assert heard
    assert {report.receiver for report in heard} == {"live"}
    assert all(report.t_adsb_in_ns == report.t_ns >= 0 for report in heard)
    events = [Event.model_validate_json(each.data) for each in log if each.key == "truth/event"]
    refused = [event for event in events if event.kind == "refused"]
    assert any(own.callsign in event.text for event in refused)
    of_own = [each for each in log if each.key == f"adsb/{own.icao24}"]
    assert all(b'"receiver":"live"' not in each.data for each in of_own)
