"""What is wrong at an airport is named, with what there is instead."""

from __future__ import annotations

import copy
import json

import pytest

from airhilt import library, load
from airhilt.errors import ScenarioError
from airhilt.scenario import parse

BASE = load("s01b_nominal").model_dump(mode="json") | {"perturbations": []}


def complaint(change) -> str:
    document = copy.deepcopy(BASE)
    change(document)
    with pytest.raises(ScenarioError) as caught:
        parse(json.dumps(document), "test.json")
    return "\n".join(caught.value.problems)


def taxi(document):
    return document["radio"]["lines"][2]["commands"][0]["command"]


def put(*path):
    """Return a change that puts the last of its arguments at the others."""
    *keys, last, value = path

    def change(document):
        for key in keys:
            document = document[key]
        document[last] = value

    return change


@pytest.mark.parametrize("name", library.names("scenarios"))
def test_every_scenario_that_ships_is_valid(name):
    load(name)


@pytest.mark.parametrize(
    ("change", "where", "what"),
    [
        (lambda d: taxi(d).update(via=["H"]), "radio/lines/2/commands/0", "no taxi route"),
        (lambda d: taxi(d).update(via=["ZZ"]), "radio/lines/2/commands/0", "no taxiway 'ZZ'"),
        (lambda d: taxi(d)["to"].update(taxiway="Q"), "command/to", "no hold short of runway"),
        (put("actors", 0, "initial", "runway", "09"), "actors/0/initial", "it has 01, 19, 04, 22"),
        (put("scene", "airport", "KDCX"), "scene/airport", "did you mean 'kdca'?"),
        (put("actors", 1, "kind", "fire_engine"), "actors/1/kind", "fire_truck"),
        (put("actors", 1, "kind", "deer"), "actors/1/kind", "kind of wildlife"),
        (
            put("actors", 1, "initial", "position", {"type": "node", "node": "gate_z"}),
            "actors/1/initial/position", "no taxiway node 'gate_z'; did you mean",
        ),
        (
            put("weather", "wind", {"from_deg": 0, "speed_kt": 90}),
            "weather/wind/speed_kt", "at most 40",
        ),
        (
            put("failures", [{"type": "dropped", "line": "hodl"}]),
            "failures/0/line", "no radio line 'hodl'",
        ),
        (
            put("failures", [{"type": "ignored", "line": "proceed", "actor": "OPS2"}]),
            "failures/0/actor", "expected OPS1",
        ),
        (
            put("radio", "lines", 2, "commands",
                [{"actor": "OPS1", "command": {"action": "land", "runway": "01"}}]),
            "command/action", "found 'land', which no vehicle does; expected taxi",
        ),
    ],
)  # fmt: skip
def test_it_is_named_with_its_place_and_with_what_there_is(change, where, what):
    message = complaint(change)
    assert where in message
    assert what in message


@pytest.mark.parametrize(("distance_nm", "what"), [(1.5, "nearest taxiway"), (20.0, "37.0 km")])
def test_an_aircraft_placed_off_the_airport_is_refused(distance_nm, what):
    place = {"type": "from_centre", "bearing_deg": 0.0, "distance_nm": distance_nm}
    standing = {"type": "standing", "position": place}
    message = complaint(put("actors", 0, "initial", standing))
    assert "actors/0/initial" in message
    assert what in message


def test_a_runway_en_route_is_refused():
    document = load("s02a_headon").model_dump(mode="json")
    document["actors"][0]["initial"] = {"type": "lined_up", "runway": "01"}
    document["perturbations"] = []
    with pytest.raises(ScenarioError, match="the scene is en route"):
        parse(json.dumps(document), "test.json")
