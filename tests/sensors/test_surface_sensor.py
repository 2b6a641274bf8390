"""Surface surveillance: what of an airport it shows, how exactly, and in which runs it is."""

from __future__ import annotations

import json
import math
from collections import defaultdict
from pathlib import Path
from typing import Any

import pytest

from airhilt import load
from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError, ScenarioError
from airhilt.geodesy.wgs84 import distance_m
from airhilt.messages import ActorTruth, SurfaceTrack
from airhilt.options import Options
from airhilt.record import read_log
from airhilt.scenario import Scenario
from airhilt.units import DEGREE, NAUTICAL_MILE, SECOND_NS
from airhilt.world.loading import load_text
from airhilt.world.site import ScenarioSite

SECONDS = 40.0


def airport(**changes: Any) -> Scenario:
    """An arrival from 5.5 NM, a truck with and one without transponder, a deer, and a coyote."""
    document = load("s01b_noncompliance").model_dump(mode="json") | {"duration_s": SECONDS}
    arrival, ops1, ops2 = document["actors"]
    arrival["initial"]["distance_nm"] = 5.5
    ops1["transponder"]["equipped"] = False
    animals = [
        {
            "type": "wildlife", "callsign": name, "kind": kind,
            "initial": {
                "type": "standing", "heading_deg": 90.0,
                "position": {"type": "runway", "runway": "04", "along_m": 300.0, "offset_m": 80.0},
            },
        }
        for name, kind in (("DEER1", "deer"), ("COY1", "coyote"))
    ]  # fmt: skip
    document["actors"] = [arrival, ops1, ops2, *animals]
    document |= {"perturbations": [], "conflict": None, "failures": [], "end_when": []}
    document["radio"] = {"controller": "Washington Tower"}
    return load_text(json.dumps(document | changes), "airport")


def go(scenario: Scenario, folder: Path, **options: Any) -> list[SurfaceTrack]:
    run(scenario, Options(out=folder, latency="fixed", speech=False, cameras=False, **options))
    return tracks_in(folder)


def tracks_in(folder: Path) -> list[SurfaceTrack]:
    log = read_log(folder / "log.mcap")
    return [SurfaceTrack.model_validate_json(m.data) for m in log if m.key.startswith("surface/")]


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("surface") / "run"
    assert go(airport(surface_surveillance={}), folder, assistant="none")
    return folder


def by_track(tracks: list[SurfaceTrack]) -> dict[int, list[SurfaceTrack]]:
    found: dict[int, list[SurfaceTrack]] = defaultdict(list)
    for track in tracks:
        found[track.track].append(track)
    return found


def truth_of(folder: Path, actor: str) -> dict[int, ActorTruth]:
    return {
        m.t_ns: ActorTruth.model_validate_json(m.data)
        for m in read_log(folder / "log.mcap")
        if m.key == f"truth/state/{actor}"
    }


def error_m(track: SurfaceTrack, truth: ActorTruth) -> float:
    return distance_m(
        (track.latitude_deg * DEGREE, track.longitude_deg * DEGREE),
        (truth.latitude_deg * DEGREE, truth.longitude_deg * DEGREE),
    )


def test_a_target_has_a_track_about_once_a_second_half_a_second_late(flown: Path) -> None:
    fire_truck = [track for track in tracks_in(flown) if track.callsign == "OPS2"]
    assert 0.9 * SECONDS <= len(fire_truck) <= SECONDS
    assert {track.t_ns - track.t_track_ns for track in fire_truck} == {SECOND_NS // 2}
    assert len({track.track for track in fire_truck}) == 1


def test_a_truck_without_a_transponder_is_a_target_without_a_name(flown: Path) -> None:
    (where,) = {(t.latitude_deg, t.longitude_deg) for t in truth_of(flown, "OPS1").values()}
    unnamed = [track for track in tracks_in(flown) if track.callsign is None]
    place = (where[0] * DEGREE, where[1] * DEGREE)
    nearby = [
        track
        for track in unnamed
        if distance_m((track.latitude_deg * DEGREE, track.longitude_deg * DEGREE), place) < 25.0
    ]
    assert len(nearby) > 0.7 * SECONDS
    assert {(track.kind, track.icao24, track.on_ground) for track in nearby} == {
        ("primary", None, None)
    }
    assert {(track.ground_speed_kt, track.track_deg) for track in nearby} == {(0.0, None)}


def test_a_deer_is_seen_and_a_coyote_is_too_small(flown: Path) -> None:
    places = {name: next(iter(truth_of(flown, name).values())) for name in ("OPS1", "DEER1")}
    for each in by_track(tracks_in(flown)).values():
        if each[0].callsign is None:
            assert min(error_m(each[0], place) for place in places.values()) < 30.0
    # The coyote stands beside the deer and would have a track of its own.
    seconds = [t.t_track_ns for t in tracks_in(flown) if error_m(t, places["DEER1"]) < 30.0]
    assert seconds
    assert len(seconds) == len(set(seconds))


def test_positions_have_the_accuracy_that_they_state(flown: Path) -> None:
    truth = {name: truth_of(flown, name) for name in ("AAL123", "OPS2")}
    for name, accuracy_m in (("AAL123", 20.0), ("OPS2", 7.5)):
        tracks = [track for track in tracks_in(flown) if track.callsign == name]
        assert {track.accuracy_m for track in tracks} == {accuracy_m}
        errors = [
            error_m(track, truth[name][track.t_track_ns])
            for track in tracks
            if track.t_track_ns in truth[name]
        ]
        assert len(errors) > 20
        assert max(errors) < 2.0 * accuracy_m
        assert 0.0 < sum(errors) / len(errors) < accuracy_m


def test_speeds_are_in_tenths_of_a_knot_neither_finer_nor_coarser(flown: Path) -> None:
    arrival = [track for track in tracks_in(flown) if track.callsign == "AAL123"]
    tenths = [round(10.0 * track.ground_speed_kt) for track in arrival]
    assert [track.ground_speed_kt for track in arrival] == pytest.approx([t / 10 for t in tenths])
    assert math.gcd(*tenths) == 1


def test_an_arrival_is_shown_with_its_height_from_five_miles_on(flown: Path) -> None:
    arrival = [track for track in tracks_in(flown) if track.callsign == "AAL123"]
    assert all(not track.on_ground and track.altitude_ft for track in arrival)
    runway = ScenarioSite.of(load("s01b_noncompliance")).runway("01")
    first = truth_of(flown, "AAL123")[arrival[0].t_track_ns]
    place = first.latitude_deg * DEGREE, first.longitude_deg * DEGREE
    assert distance_m(place, runway.start) / NAUTICAL_MILE == pytest.approx(5.0, abs=0.1)


def test_a_replay_shows_the_same(flown: Path) -> None:
    assert replay(flown).identical


def test_an_outage_hides_all_targets_and_they_come_back_under_new_numbers(tmp_path: Path) -> None:
    outage = {"outages_s": [[10.0, 20.0]]}
    short = airport(surface_surveillance=outage, duration_s=30.0)
    tracks = go(short, tmp_path / "run", assistant="none")
    assert not [t for t in tracks if 10.0 <= t.t_track_ns / SECOND_NS < 20.0]
    numbers = {t.track for t in tracks if t.callsign == "OPS2"}
    assert len(numbers) == 2


def test_there_is_none_unless_somebody_asks(tmp_path: Path) -> None:
    short = airport(duration_s=3.0)
    assert go(short, tmp_path / "none") == []
    assert go(short, tmp_path / "asked", surface_surveillance=True)


def test_an_airspace_without_an_airport_has_no_surface(tmp_path: Path) -> None:
    with pytest.raises(AirhiltError, match="'s02a_headon' is en route; expected a scenario at"):
        go(load("s02a_headon"), tmp_path / "run", surface_surveillance=True)
    document = load("s02a_headon").model_dump(mode="json") | {"surface_surveillance": {}}
    with pytest.raises(ScenarioError, match="surface_surveillance: the scene is en route"):
        load_text(json.dumps(document), "headon")
