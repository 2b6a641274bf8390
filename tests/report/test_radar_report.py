"""The report shows what the radars of a run measured."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from airhilt.cosim.simulation import run
from airhilt.options import Options
from airhilt.report import write_report
from airhilt.scenario import Scenario
from report_pages import shown


@pytest.fixture(scope="module")
def folder(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of 30 s with a radar that turns once in 4.8 s."""
    out = tmp_path_factory.mktemp("radar") / "run"
    options = Options(latency="fixed", speech=False, radar="terminal", cockpit=True, out=out)
    return run(encounter, options).folder


def data(folder: Path) -> dict[str, Any]:
    return shown(write_report(folder))


def test_each_actor_is_detected_in_most_turns(folder: Path) -> None:
    (radar,) = data(folder)["sections"]["radar"]
    for one in radar["detected"]:
        found = one["primary"] + one["secondary"] + one["combined"]
        assert one["turns"] in (6, 7)
        assert one["turns"] - 2 <= found <= one["turns"]
    assert sum(plot["actor"] is None for plot in radar["plots"]) == 0


def test_plots_lie_where_the_actor_was(folder: Path) -> None:
    page = data(folder)
    (radar,) = page["sections"]["radar"]
    tracks = {track["callsign"]: track for track in page["tracks"]}
    for plot in radar["plots"]:
        track = tracks[plot["actor"]]
        index = min(range(len(track["t"])), key=lambda i: abs(track["t"][i] - plot["t"]))
        east_nm = track["east_nm"][index] - plot["east_nm"]
        north_nm = track["north_nm"][index] - plot["north_nm"]
        assert math.hypot(east_nm, north_nm) < 0.4
        assert plot["mode_c_ft"] in (None, *range(34_000, 36_100, 100))


def test_the_instruments_of_each_cockpit_are_shown_once_a_second(folder: Path) -> None:
    west, east = data(folder)["sections"]["cockpit"]
    assert (west["callsign"], east["callsign"]) == ("AAL123", "DAL456")
    assert len(west["states"]) == 31
    first = west["states"][0]
    assert (first["t"], first["altitude_ft"], first["mode"]) == (0.0, 35_000, "en_route")
    assert first["heading_deg"] == pytest.approx(90.0, abs=2.0)
