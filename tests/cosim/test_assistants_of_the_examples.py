"""The assistants of the examples, started as their first lines say, in closed loop."""

from __future__ import annotations

import json
import socket
import time
from pathlib import Path
from typing import Any

import pytest

from airhilt import Scenario, load, run
from airhilt.bus import free_endpoint
from airhilt.metrics.result import Result
from airhilt.world.loading import load_text
from paths import EXAMPLES
from processes import process

OPTIONS: dict[str, Any] = {"latency": "fixed:0.2", "speech": False, "cameras": False}
CALLSIGNS = {"AAL77", "DLH9"}


def meeting(longitude_deg: float) -> Scenario:
    """Two airliners head-on at one level over the equator, which meet at a longitude."""

    def place(east_deg: float) -> dict[str, Any]:
        wrapped = (longitude_deg + east_deg + 180.0) % 360.0 - 180.0
        return {"type": "geodetic", "lat_deg": 0.0, "lon_deg": wrapped}

    actors = [
        {
            "type": "aircraft", "callsign": callsign, "icao24": icao24, "aircraft": "737",
            "initial": {
                "type": "airborne", "position": place(-0.25 * side), "altitude_ft": 31_000,
                "cas_kt": 280, "track_deg": 180.0 - 90.0 * side,
            },
            "route": [place(1.0 * side)],
        }
        for callsign, icao24, side in (("AAL77", "a77a77", 1), ("DLH9", "3c6444", -1))
    ]  # fmt: skip
    document = {
        "name": "meeting", "title": "Two that meet at a longitude", "family": "S02A",
        "scene": {"type": "en_route", "centre": place(0.0)}, "duration_s": 120.0,
        "actors": actors, "end_when": [],
        "conflict": {
            "actors": sorted(CALLSIGNS),
            "opens_when": {
                "type": "predicted_loss_of_separation", "actors": sorted(CALLSIGNS), "within_s": 120
            },
        },
    }  # fmt: skip
    return load_text(json.dumps(document), "meeting")


def advised(example: str, scenario: Scenario, out: Path) -> Result:
    """Return a run of a scenario whose assistant is the process of an example."""
    if example == "sdk_worker.py":
        endpoint = free_endpoint()
        with process(EXAMPLES / example, endpoint):
            return run(scenario, out=out, endpoint=endpoint, attach=("simple",), **OPTIONS)
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    with process(EXAMPLES / example, str(port)):
        url = f"http://127.0.0.1:{port}/advise"
        _await(port)
        return run(scenario, out=out, assistant=url, **OPTIONS)


def _await(port: int) -> None:
    """Wait until something listens."""
    until_s = time.monotonic() + 20.0
    while True:
        try:
            socket.create_connection(("127.0.0.1", port), timeout=1.0).close()
        except OSError:
            assert time.monotonic() < until_s
            time.sleep(0.05)
        else:
            return


@pytest.mark.parametrize("example", ["http_assistant.py", "sdk_worker.py"])
def test_it_warns_at_the_antimeridian_when_it_warns_at_greenwich(
    example: str, tmp_path: Path
) -> None:
    told = [
        advised(example, meeting(longitude_deg), tmp_path / f"{longitude_deg:.0f}").summary
        for longitude_deg in (0.0, 180.0)
    ]
    for summary in told:
        assert summary.avoided
        assert {name for each in summary.advisories for name in each.traffic} == CALLSIGNS
    greenwich_s, antimeridian_s = ([each.t_first_s for each in s.advisories] for s in told)
    assert greenwich_s
    assert antimeridian_s == pytest.approx(greenwich_s, abs=1.0)


@pytest.mark.parametrize("example", ["http_assistant.py", "sdk_worker.py"])
def test_it_keeps_separation_in_the_scenario_that_it_names_with_one_advice(
    example: str, tmp_path: Path
) -> None:
    """Also when the two are past each other and return to their levels."""
    assert "--scenario s02a_headon" in (EXAMPLES / example).read_text()
    scenario = load("s02a_headon").model_copy(update={"end_when": ()})
    summary = advised(example, scenario, tmp_path / "run").summary
    assert summary.avoided
    assert not summary.loss_of_separation
    assert [each.severity for each in summary.advisories] == ["CAUTION"]
    assert summary.advisories[0].revisions <= 2, "advice, and that it is over"
