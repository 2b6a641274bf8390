"""Surface surveillance: what of an airport it shows, how exactly, and in which runs it is."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from airhilt import load
from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError, ScenarioError
from airhilt.messages import SurfaceTrack
from airhilt.options import Options
from airhilt.record import read_log
from airhilt.scenario import Scenario
from airhilt.world.loading import load_text

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


def test_a_replay_shows_the_same(flown: Path) -> None:
    assert replay(flown).identical


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
