"""What is wrong at an airport is named, with what there is instead."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from airhilt import load
from airhilt.errors import ScenarioError
from airhilt.world.loading import load_text

BASE = load("s01b_nominal").model_dump(mode="json") | {"perturbations": []}


def complaint(change: Callable[..., Any]) -> str:
    document = copy.deepcopy(BASE)
    change(document)
    with pytest.raises(ScenarioError) as caught:
        load_text(json.dumps(document), "test.json")
    return "\n".join(caught.value.problems)


def taxi(document: dict[str, Any]) -> dict[str, Any]:
    command: dict[str, Any] = document["radio"]["lines"][2]["commands"][0]["command"]
    return command


def put(*path: Any) -> Callable[..., Any]:
    """Return a change that puts the last of its arguments at the others."""
    *keys, last, value = path

    def change(document: dict[str, Any]) -> None:
        for key in keys:
            document = document[key]
        document[last] = value

    return change


def test_it_is_named_with_its_place_and_with_what_there_is(subtests: pytest.Subtests) -> None:
    table = [
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
    ]  # fmt: skip
    for change, where, what in table:
        with subtests.test(str((change, where, what))):
            message = complaint(change)
            assert where in message
            assert what in message


@pytest.mark.parametrize(("distance_nm", "what"), [(1.5, "nearest taxiway"), (20.0, "37.0 km")])
def test_an_aircraft_placed_off_the_airport_is_refused(distance_nm: float, what: str) -> None:
    place = {"type": "from_centre", "bearing_deg": 0.0, "distance_nm": distance_nm}
    standing = {"type": "standing", "position": place}
    message = complaint(put("actors", 0, "initial", standing))
    assert "actors/0/initial" in message
    assert what in message


WRONG_READBACK = {
    "type": "readback_wrong", "line": "proceed_readback", "text": "Via Hotel, Ops one.",
    "commands": [
        {"actor": "OPS1", "command": {
            "action": "taxi", "to": {"type": "node", "node": "01/19 at D"}, "via": ["H"]}},
    ],
}  # fmt: skip
CONFUSED = {"type": "callsign_confused", "line": "proceed", "meant": "OPS1", "taken_by": "OPS1"}
AT_ONCE = {"type": "time", "at_s": 5.0}


def test_what_would_only_show_in_the_middle_of_a_run_is_named_before(
    subtests: pytest.Subtests,
) -> None:
    table = [
        (put("failures", [WRONG_READBACK]), "failures/0/commands/0/command", "no taxi route"),
        (put("failures", [CONFUSED]), "failures/0/taken_by", "found 'OPS1' twice"),
        (
            put("failures", [{"type": "engine_failure", "actor": "AAL123", "engine": 2,
                              "when": AT_ONCE}]),
            "failures/0/engine", "found 2; expected 0 to 1, the engines of a 737",
        ),
        (
            put("failures", [{"type": "engine_failure", "actor": "OPS1", "engine": 0,
                              "when": AT_ONCE}]),
            "failures/0/actor", "found a vehicle; expected an aircraft",
        ),
        (
            put("radio", "lines", 0, "commands", 0, "command", "exit", "Z"),
            "radio/lines/0/commands/0/command/exit", "runway 01 has no exit 'Z'; there are: B_",
        ),
        (
            put("conflict", {"actors": ["AAL123", "OPS1"], "opens_when": {
                "type": "on_runway", "actor": "OPS1", "runway": "36"}}),
            "conflict/opens_when", "no runway '36'; it has 01",
        ),
        (
            put("actors", 0, "initial", {"type": "hold_short", "runway": "01", "taxiway": "E",
                                         "before_m": 1500.0}),
            "actors/0/initial", "nearest taxiway",
        ),
    ]  # fmt: skip
    for change, where, what in table:
        with subtests.test(where):
            message = complaint(change)
            assert f"{where}: " in message
            assert what in message


def test_a_storm_is_refused_once_for_all_that_land() -> None:
    document = copy.deepcopy(load("s01a_bad_readback").model_dump(mode="json"))
    document["weather"]["wind"] = {"from_deg": 0, "speed_kt": 90}
    with pytest.raises(ScenarioError) as caught:
        load_text(json.dumps(document), "test.json")
    (problem,) = caught.value.problems
    assert "weather/wind/speed_kt: found 90; expected at most 40" in problem


def test_nobody_is_told_to_use_a_runway_or_taxiway_en_route(subtests: pytest.Subtests) -> None:
    for command in [
        {"action": "land", "runway": "01"},
        {"action": "route", "route": [{"type": "runway", "runway": "01", "along_m": 0}]},
        {"action": "taxi", "to": {"type": "node", "node": "gate_b12"}},
    ]:
        with subtests.test(str(command)):
            document = load("s02a_headon").model_dump(mode="json")
            document["actors"][0]["commands"] = [command]
            with pytest.raises(ScenarioError, match="the scene is en route") as caught:
                load_text(json.dumps(document), "test.json")
            assert "actors/0/commands/0" in str(caught.value)


def invalid_file(tmp_path: Path, change: Callable[..., Any]) -> Path:
    document = copy.deepcopy(BASE)
    change(document)
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (put("scene", "airport", "KDCX"), "did you mean"),
        (
            put("actors", 1, "commands", [{"action": "continue"}]),
            "actors/OPS1: cannot begin like that: unable, no further clearance",
        ),
        (
            lambda d: d["actors"].append(
                {"type": "wildlife", "callsign": "DEER1", "kind": "deer", "height_ft": 60,
                 "initial": {"type": "standing", "position": {"type": "node", "node": "J/D"}}}
            ),
            "actors/DEER1: cannot begin like that: a deer does not fly",
        ),
    ],
    ids=["no airport", "nothing to continue", "flying deer"],
)  # fmt: skip
def test_on_the_command_line_it_is_told_in_words_with_exit_code_2(
    airhilt_command: Callable[..., Any], tmp_path: Path, change: Callable[..., Any], what: str
) -> None:
    told = airhilt_command("validate", invalid_file(tmp_path, change))
    assert told.returncode == 2
    assert what in told.stderr
    assert "Traceback" not in told.stderr + told.stdout


def test_names_in_instructions_lead_to_something(subtests: pytest.Subtests) -> None:
    def told(**command: Any) -> Callable[..., Any]:
        return put("radio", "lines", 2, "commands", 0, "command", command)

    def ends(**condition: Any) -> Callable[..., Any]:
        return put("end_when", [{"actor": "AAL123", **condition}])

    command = "radio/lines/2/commands/0/command"
    table = [
        (told(action="contact", unit="Nowhere Ground"), f"{command}/unit", "no unit 'Nowhere"),
        (told(action="contact"), command, "expected one of them"),
        (told(action="taxi_to", runway="01", via=["ZZ"]), f"{command}/via/0", "no taxiway 'ZZ'"),
        (told(action="taxi_to", place="gate 99"), f"{command}/place", "no stand or taxiway"),
        (told(action="taxi_to", runway="01", cross=["36"]), f"{command}/cross/0", "it has 01"),
        (told(action="hold_short", taxiway="ZZ"), f"{command}/taxiway", "no taxiway 'ZZ'"),
        (told(action="cross", runway="01", at="ZZ"), f"{command}/at", "no taxiway 'ZZ'"),
        (
            told(action="follow", whom="AAL123", hold_short=["J", "ZZ"]),
            f"{command}/hold_short/1", "no taxiway 'ZZ'",
        ),
        (ends(type="fix_passed", fix="LAMM"), "end_when/0/fix", "no fix 'LAMM'"),
        (ends(type="fix_passed", fix="runway 36"), "end_when/0/fix", "did you mean 'runway"),
        (
            ends(type="in_phase", phases=["rollout", "taxing"]),
            "end_when/0/phases/1", "no phase 'taxing'; did you mean 'taxi'?",
        ),
        (
            ends(type="in_phase", actor="OPS1", phases=["taxi"]),
            "end_when/0/phases/0", "no phase 'taxi'; known: standing, driving",
        ),
    ]  # fmt: skip
    for change, where, what in table:
        with subtests.test(f"{where} {what}"):
            message = complaint(change)
            assert f"{where}: " in message
            assert what in message


@pytest.mark.parametrize("name", ["Washington Tower", "tower", "field", "KDCA", "runway 01"])
def test_a_unit_is_named_by_its_words_and_a_fix_as_crews_know_it(name: str) -> None:
    document = copy.deepcopy(BASE)
    if "ower" in name:
        command = {"action": "contact", "unit": name}
        document["radio"]["lines"][2]["commands"][0]["command"] = command
    else:
        document["end_when"] = [{"type": "fix_passed", "actor": "AAL123", "fix": name}]
    assert load_text(json.dumps(document), "test.json").name == "s01b_nominal"
