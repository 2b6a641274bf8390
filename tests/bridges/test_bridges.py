"""Bridges join a real run to something else."""

from __future__ import annotations

import runpy
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from airhilt import run
from airhilt.bus import free_endpoint
from airhilt.host import library
from airhilt.messages import AdsbReport
from airhilt.scenario import Scenario


def test_a_report_becomes_a_basestation_line() -> None:
    bridge = runpy.run_path(str(library.folder("bridges") / "sbs1.py"))
    report = AdsbReport(
        icao24="a1b2c3", callsign="AAL123", latitude_deg=38.9, longitude_deg=-77.0,
        altitude_ft=35000.0, ground_speed_kt=450.0, track_deg=90.0, vertical_rate_fpm=-64.0,
        nacp=9, nacv=2, receiver="centre", t_adsb_in_ns=0, t_adsb_out_ns=1_500_000_000,
    )  # fmt: skip
    assert bridge["line"](report) == (
        "MSG,3,1,1,A1B2C3,1,1970/01/01,00:00:01.500,1970/01/01,00:00:01.500,AAL123,35000,450,90,"
        "38.90000,-77.00000,-64,,0,0,0,0"
    )
    on_ground = report.model_copy(update={"altitude_ft": None, "on_ground": True})
    assert bridge["line"](on_ground) == (
        "MSG,2,1,1,A1B2C3,1,1970/01/01,00:00:01.500,1970/01/01,00:00:01.500,AAL123,,450,90,"
        "38.90000,-77.00000,-64,,0,0,0,-1"
    )


def test_a_client_of_the_feed_hears_both_aircraft(encounter: Scenario, tmp_path: Path) -> None:
    endpoint = free_endpoint()
    port = int(free_endpoint().rsplit(":", 1)[1])
    heard: list[str] = []

    def listen() -> None:
        bridge = subprocess.Popen(
            [sys.executable, library.folder("bridges") / "sbs1.py",
             "--connect", endpoint, "--port", str(port)],
        )  # fmt: skip
        deadline = time.monotonic() + 20.0
        while time.monotonic() < deadline:
            try:
                with socket.create_connection(("127.0.0.1", port)) as client:
                    heard.extend(client.makefile().readlines())
                    break
            except OSError:
                time.sleep(0.05)
        assert bridge.wait(timeout=20.0) == 0

    listener = threading.Thread(target=listen)
    listener.start()
    short = encounter.model_copy(update={"duration_s": 8.0})
    run(short, out=tmp_path / "run", endpoint=endpoint, pace="realtime", assistant="none")
    listener.join(timeout=30.0)
    assert {line.split(",")[4] for line in heard} == {"A1B2C3", "A4D5E6"}
    assert heard[-1].split(",")[11] == pytest.approx("35000")
