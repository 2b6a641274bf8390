"""Runs of aircraft on recorded tracks: all see them as any aircraft, and their crews obey."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt.geodesy.wgs84 import onward
from airhilt.messages import ActorTruth, AdsbReport, CockpitInstruments, Event, RadarPlot
from airhilt.record import Logged, read_log
from airhilt.scenario import Scenario
from airhilt.units import DEGREE, KNOT
from airhilt.world.loading import load_text

QUIET: dict[str, Any] = {"latency": "fixed", "speech": False, "cameras": False, "report": False}
CENTRE = (47.0, 8.0)
SPEED_M_S = 440.0 * KNOT
LONG_S = 100.0
MEET_S = 70.0
LATE_S = 20.0


def aircraft(name: str, address: str, course_deg: float, begin_s: float) -> dict[str, Any]:
    """Return an aircraft that flies over the centre on a course, level, when the two meet."""
    centre = (CENTRE[0] * DEGREE, CENTRE[1] * DEGREE)
    points = []
    for step in range(round((LONG_S - begin_s) / 4.0) + 1):
        t_s = begin_s + 4.0 * step
        place = onward(centre, course_deg * DEGREE, SPEED_M_S * (t_s - MEET_S))
        points.append([t_s, place[0] / DEGREE, place[1] / DEGREE, 31_000.0])
    return {
        "type": "aircraft", "callsign": name, "icao24": address, "aircraft": "737",
        "initial": {"type": "track", "points": points},
    }  # fmt: skip


def recorded(**changes: Any) -> Scenario:
    """Return two recorded flights on crossing tracks; the second comes later."""
    document = {
        "name": "crossing", "title": "Two recorded flights cross", "family": "S02A",
        "scene": {
            "type": "en_route",
            "centre": {"type": "geodetic", "lat_deg": CENTRE[0], "lon_deg": CENTRE[1]},
        },
        "duration_s": LONG_S,
        "actors": [aircraft("AAL1", "a00001", 90.0, 0.0), aircraft("DAL2", "a00002", 0.0, LATE_S)],
        "radars": [{
            "name": "radar", "kind": "en_route",
            "position": {"type": "from_centre", "bearing_deg": 200, "distance_nm": 10},
        }],
        "cockpits": ["AAL1", "DAL2"],
        "conflict": {
            "actors": ["AAL1", "DAL2"],
            "opens_when": {
                "type": "predicted_loss_of_separation", "actors": ["AAL1", "DAL2"], "within_s": 60
            },
            "unassisted": "collision",
        },
    }  # fmt: skip
    return load_text(json.dumps(document | changes), "crossing")


def messages(log: list[Logged], key: str, model: Any) -> list[Any]:
    return [model.model_validate_json(each.data) for each in log if each.key == key]


@pytest.fixture(scope="module")
def unassisted(tmp_path_factory: pytest.TempPathFactory) -> airhilt.Result:
    out = tmp_path_factory.mktemp("unassisted") / "run"
    return airhilt.run(recorded(), out=out, assistant="none", **QUIET)


@pytest.fixture(scope="module")
def log(unassisted: airhilt.Result) -> list[Logged]:
    return list(read_log(unassisted.folder / "log.mcap"))


def test_recorded_flights_that_meet_collide_as_any_aircraft(unassisted: airhilt.Result) -> None:
    assert unassisted.summary.collision


def test_sensors_and_truth_have_a_recorded_flight_from_its_first_point(log: list[Logged]) -> None:
    for key, model in (
        ("truth/state/DAL2", ActorTruth),
        ("adsb/a00002", AdsbReport),
        ("cockpit/DAL2", CockpitInstruments),
    ):
        times = [each.t_ns / 1e9 for each in messages(log, key, model)]
        assert LATE_S <= times[0] < LATE_S + 2.0
    states = messages(log, "truth/state/AAL1", ActorTruth)
    assert {state.phase for state in states} == {"on_track"}
    reports = messages(log, "adsb/a00001", AdsbReport)
    speeds = [report.ground_speed_kt for report in reports[5:]]
    assert speeds == pytest.approx([440.0] * len(speeds), abs=12.0)
    plots = messages(log, "radar/radar", RadarPlot)
    assert 31_000 in {plot.mode_c_ft for plot in plots}
    assert len({plot.mode_a for plot in plots if plot.mode_a}) == 2


def test_an_assistant_warns_and_the_crews_leave_their_tracks(tmp_path: Path) -> None:
    scenario = recorded(crews="ideal")
    result = airhilt.run(scenario, out=tmp_path / "run", assistant="adsb_only", **QUIET)
    assert not result.summary.collision
    assert not result.summary.nmac
    log = list(read_log(result.folder / "log.mcap"))
    reacting = [e.subject for e in messages(log, "truth/event", Event) if e.kind == "pilot_reacts"]
    assert reacting
    phases = [state.phase for state in messages(log, f"truth/state/{reacting[0]}", ActorTruth)]
    assert phases[0] == "on_track"
    assert phases[-1] == "en_route"


def test_the_same_recorded_traffic_gives_the_same_bytes(
    unassisted: airhilt.Result, tmp_path: Path
) -> None:
    again = airhilt.run(recorded(), out=tmp_path / "run", assistant="none", **QUIET)
    names = [result.folder / "log.mcap" for result in (unassisted, again)]
    assert names[0].read_bytes() == names[1].read_bytes()


@pytest.mark.parametrize(
    ("number", "field", "value", "expected"),
    [
        (3, 0, 7.0, "points/3/0: 1 s before the one before"),
        (3, 1, 50.0, "points/3/1: .* expected at most 1000 kt"),
        (3, 3, -200.0, "points/3/3: .* not above the ground"),
    ],
)
def test_a_point_that_cannot_be_is_named_with_its_place(
    number: int, field: int, value: float, expected: str
) -> None:
    first = aircraft("AAL1", "a00001", 90.0, 0.0)
    first["initial"]["points"][number][field] = value
    with pytest.raises(airhilt.AirhiltError, match=f"actors/0/initial/{expected}"):
        recorded(actors=[first, aircraft("DAL2", "a00002", 0.0, LATE_S)])
