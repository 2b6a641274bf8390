"""A scenario file loads, or the message says where it is wrong, what was found and expected."""

from __future__ import annotations

import copy
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from airhilt.configuration import read_configuration
from airhilt.errors import ScenarioError
from airhilt.host import library
from airhilt.world.loading import load, load_text

HEAD_ON = load("s02a_headon").model_dump(mode="json")
VERTICAL = load("s02a_vertical").model_dump(mode="json")
FIRST, SECOND = (actor["callsign"] for actor in HEAD_ON["actors"][:2])


def changed(document: dict[str, Any], path: str, value: Any) -> dict[str, Any]:
    """Return a copy of a document with the value at a path set; ``...`` removes it."""
    document = copy.deepcopy(document)
    *parents, last = path.split("/")
    container = document
    for part in parents:
        container = container[int(part) if isinstance(container, list) else part]
    key = int(last) if isinstance(container, list) else last
    if value is ...:
        del container[key]
    else:
        container[key] = value
    return document


def complaint(document: dict[str, Any]) -> str:
    with pytest.raises(ScenarioError) as caught:
        load_text(json.dumps(document), "test.json")
    return str(caught.value)


def test_what_is_wrong_with_a_field_is_told_with_its_path(subtests: pytest.Subtests) -> None:
    for path, value, where, what in [
        ("weather", [], "weather", "found [], expected a JSON object"),
        ("actors/0", "x", "actors/0", 'found "x", expected a JSON object'),
        ("actors", {}, "actors", "found {}, expected a JSON list"),
        ("durations", 5, "durations", "unknown field; did you mean 'duration_s'?"),
        ("actors/0/calsign", "X1", "actors/0/calsign", "unknown field; did you mean 'callsign'?"),
        ("actors/0/initial/altitude", 1, "actors/0/initial/altitude", "did you mean 'altitude_ft'"),
        ("weather/wind/speed", 1, "weather/wind/speed", "did you mean 'speed_kt'?"),
        ("conflict/opens_when/withn_s", 1, "conflict/opens_when/withn_s", "unknown field"),
        ("family", "S09", "family", "found \"S09\", expected 'S01A'"),
        ("duration_s", ..., "duration_s", "missing; it is required"),
        ("actors/1/initial/cas_kt", ..., "actors/1/initial/cas_kt", "missing; it is required"),
        ("duration_s", -5, "duration_s", "found -5: input should be greater than 0"),
        ("duration_s", "long", "duration_s", 'found "long": input should be a valid number'),
        ("actors", [], "actors", "at least 1 item"),
        ("actors/0/icao24", "XYZ", "actors/0/icao24", 'found "XYZ"'),
        ("scene/centre/lat_deg", 91, "scene/centre/lat_deg", "found 91"),
        ("separation/level_tolerance_ft", 500, "separation/level_tolerance_ft", "found 500"),
    ]:
        with subtests.test(str((path, value, where, what))):
            message = complaint(changed(HEAD_ON, path, value))
            assert f"test.json: {where}: " in message
            assert what in message


def test_a_document_that_is_no_object_is_refused_with_the_fields_of_a_scenario(
    subtests: pytest.Subtests,
) -> None:
    documents: list[Any] = [[], 3, "x", None]
    for document in documents:
        with subtests.test(str(document)):
            assert complaint(document) == (
                f"test.json: (top): found {json.dumps(document)}, expected a JSON object with "
                "the fields name, title, family, scene, duration_s, actors"
            )


@pytest.mark.parametrize(
    ("path", "value", "where", "what"),
    [
        (
            "actors/0/initial/position/type",
            "geodetik",
            "actors/0/initial/position/type",
            "expected geodetic, from_centre, runway, hold_short, node; did you mean 'geodetic'?",
        ),
        ("end_when/0/type", "tim", "end_when/0/type", "did you mean 'time'?"),
        ("conflict/opens_when/type", ..., "conflict/opens_when", "'type' is missing"),
    ],
)
def test_a_wrong_discriminator_is_told_with_what_there_is(
    path: str, value: Any, where: str, what: str
) -> None:
    message = complaint(changed(HEAD_ON, path, value))
    assert f"test.json: {where}: " in message
    assert what in message


@pytest.mark.parametrize("field", ["callsign", "icao24"])
def test_two_actors_share_neither_callsign_nor_address(field: str) -> None:
    message = complaint(changed(HEAD_ON, f"actors/1/{field}", HEAD_ON["actors"][0][field]))
    assert f"actors/1/{field}: found {HEAD_ON['actors'][0][field]!r}" in message
    assert "which actors/0 has already" in message


def test_an_unknown_aircraft_is_told_with_the_nearest() -> None:
    message = complaint(changed(HEAD_ON, "actors/0/aircraft", "B748"))
    assert "actors/0/aircraft: " in message
    assert "'B748'" in message
    assert "did you mean 'B747'?" in message


def test_an_aircraft_that_no_other_resembles_is_told_with_what_there_is() -> None:
    message = complaint(changed(HEAD_ON, "actors/0/aircraft", "A320"))
    assert "no aircraft named 'A320'; known: 737, B747, c172p, c310" in message


def test_a_file_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "marked.json"
    path.write_text(json.dumps(HEAD_ON), encoding="utf-8-sig")
    assert load(path) == load_text(json.dumps(HEAD_ON), "head-on")
    assert read_configuration(path) == HEAD_ON


def test_what_is_written_as_people_say_it_is_explained() -> None:
    frequency = complaint(changed(HEAD_ON, "radio/lines/0/frequency_khz", 120.5))
    assert "found 120.5: expected kHz, a whole number: 120.5 MHz is 120500" in frequency
    registration = complaint(changed(HEAD_ON, "actors/0/callsign", "G-ABCD"))
    assert 'found "G-ABCD": expected it without a hyphen, GABCD' in registration


@pytest.mark.parametrize("altitude_ft", [-500, 0, 1_000])
def test_an_aircraft_begins_above_the_ground(altitude_ft: int) -> None:
    document = changed(HEAD_ON, "scene/terrain_elevation_ft", 1_000)
    message = complaint(changed(document, "actors/0/initial/altitude_ft", altitude_ft))
    assert f"actors/0/initial/altitude_ft: found {altitude_ft}, which is not above" in message
    assert "scene/terrain_elevation_ft, 1000" in message


@pytest.mark.parametrize(
    ("altitude_ft", "cas_kt", "greatest_kt"),
    [(35_000, 100, "279.9"), (35_000, 290, "279.9"), (10_000, 350, "340")],
)
def test_an_aircraft_begins_at_a_speed_that_it_flies_there(
    altitude_ft: int, cas_kt: int, greatest_kt: str
) -> None:
    document = changed(HEAD_ON, "actors/0/initial/altitude_ft", altitude_ft)
    message = complaint(changed(document, "actors/0/initial/cas_kt", cas_kt))
    assert (
        f"actors/0/initial/cas_kt: found {cas_kt}; expected 200 to {greatest_kt}, "
        f"what a 737 flies at {altitude_ft} ft"
    ) in message


def test_an_aircraft_begins_below_its_ceiling() -> None:
    message = complaint(changed(HEAD_ON, "actors/0/initial/altitude_ft", 45_000))
    assert "actors/0/initial/altitude_ft: found 45000; expected at most" in message


def test_without_a_route_an_aircraft_needs_a_track() -> None:
    document = changed(HEAD_ON, "actors/0/route", [])
    document = changed(document, "actors/0/initial/track_deg", None)
    assert "actors/0/initial/track_deg: missing" in complaint(document)


MISSPELT = FIRST[:-1] + "9"


def test_an_unknown_actor_is_told_with_the_nearest(subtests: pytest.Subtests) -> None:
    table = [
        ("conflict/actors/0", MISSPELT),
        ("conflict/opens_when", {"type": "separation_below", "actors": [MISSPELT, SECOND],
                                 "horizontal_nm": 5, "vertical_ft": 1000}),
        ("conflict/opens_when", {"type": "any_of", "conditions": [
            {"type": "all_of", "conditions": [
                {"type": "bound_for_altitude", "actor": MISSPELT, "altitude_ft": 1000}]}]}),
        ("end_when", [{"type": "closest_approach_passed", "actors": [MISSPELT, SECOND]}]),
        ("radio", {"lines": [{"id": "a", "at_s": 1, "speaker": "x", "frequency_khz": 134325,
                              "text": "go", "commands": [{"actor": MISSPELT, "command":
                              {"action": "resume_route"}}]}]}),
        ("cameras", [{"name": "nose", "mount": {"type": "actor", "actor": MISSPELT}}]),
    ]  # fmt: skip
    for path, value in table:
        with subtests.test(str((path, value))):
            message = complaint(changed(HEAD_ON, path, value))
            assert f"no actor {MISSPELT!r}; did you mean {FIRST!r}?" in message
            assert f"test.json: {path.split('/')[0]}/" in message


def test_an_unknown_field_deep_in_a_condition_is_told_with_its_whole_path() -> None:
    inner = {"type": "time", "at_s": 1, "ats": 1}
    value = {"type": "any_of", "conditions": [{"type": "time", "at_s": 1}, inner]}
    message = complaint(changed(HEAD_ON, "conflict/opens_when", value))
    assert "test.json: conflict/opens_when/conditions/1/ats: unknown field" in message
    assert "did you mean 'at_s'?" in message


def test_an_unknown_radio_line_is_told_with_the_nearest() -> None:
    value = {"type": "line_ended", "line": "readbak"}
    message = complaint(changed(VERTICAL, "conflict/opens_when", value))
    assert "conflict/opens_when/line: no radio line 'readbak'; did you mean 'readback'?" in message


def test_a_pair_is_of_two() -> None:
    for path in ("conflict/actors", "end_when/0/actors"):
        message = complaint(changed(HEAD_ON, path, [FIRST, FIRST]))
        assert f"{path}: found {FIRST!r} twice" in message


UNIFORM = {"type": "uniform", "limit": 1.0}


def test_a_perturbation_leads_to_a_number(subtests: pytest.Subtests) -> None:
    for path, what in [
        (f"actors/{FIRST}/initial/cas_kts", "no 'cas_kts' there; did you mean 'cas_kt'?"),
        (f"actors/{MISSPELT}/initial/cas_kt", f"did you mean {FIRST!r}?"),
        ("actors/7/initial/cas_kt", "no '7' there"),
        ("actors/²/initial/cas_kt", "no '²' there"),
        ("duration_s/more", "no 'more' there"),
        ("nowhere", "no 'nowhere' there"),
        ("title", "expected the path of a number"),
        (f"actors/{FIRST}/initial", "expected the path of a number"),
        (f"actors/{FIRST}/transponder/equipped", "expected the path of a number"),
    ]:
        with subtests.test(path):
            message = complaint(
                changed(HEAD_ON, "perturbations", [{"path": path, "distribution": UNIFORM}])
            )
            assert "test.json: perturbations/0/path: " in message
            assert what in message


def test_a_perturbation_has_bounds(subtests: pytest.Subtests) -> None:
    for perturbation, what in [
        ({"path": "duration_s"}, "'duration_s' is of no kind that has a usual spread"),
        ({"path": "actors/*/initial/cas_kts"}, "'actors/*/initial/cas_kts' leads nowhere"),
        ({"path": "duration_s", "distribution": UNIFORM | {"limit": -1.0}}, "greater than 0"),
        ({"path": "duration_s", "distribution": UNIFORM | {"least": 1.0}}, "less than or equal"),
        ({"path": "duration_s", "distribution": {"type": "even", "limit": 1.0}}, "found"),
    ]:
        with subtests.test(what):
            message = complaint(changed(HEAD_ON, "perturbations", [perturbation]))
            assert "test.json: perturbations/0/" in message
            assert what in message


def test_a_number_is_perturbed_once() -> None:
    twice = [{"path": "duration_s", "distribution": UNIFORM}] * 2
    assert "perturbations/1/path: found 'duration_s'" in complaint(
        changed(HEAD_ON, "perturbations", twice)
    )


def test_of_many_problems_the_first_is_told_in_one_line_and_all_are_kept() -> None:
    actors = [dict(HEAD_ON["actors"][0], colour="red") for _ in range(12)]
    with pytest.raises(ScenarioError) as caught:
        load_text(json.dumps(changed(HEAD_ON, "actors", HEAD_ON["actors"] + actors)), "test.json")
    message = str(caught.value)
    assert message.count("unknown field") == 1
    assert "\n" not in message
    assert "11 more: see airhilt validate" in message
    assert len(caught.value.problems) == 12


def test_what_is_not_json_is_told_with_line_and_column(subtests: pytest.Subtests) -> None:
    for text, where in [
        ("{", "1:2"),
        ('{\n  "name": "a",\n  "x" 5\n}', "3:7"),
        ("", "1:1"),
        ("\ufeff{}", "1:1"),
    ]:
        message = rf"^test\.json:{where}: not valid JSON"
        with subtests.test(text), pytest.raises(ScenarioError, match=message):
            load_text(text, "test.json")


def test_json_that_is_no_scenario_is_refused(subtests: pytest.Subtests) -> None:
    for text in ["[" * 100_000, "5", "null", '"text"', "[]"]:
        with subtests.test(text), pytest.raises(ScenarioError, match=r"^test\.json: "):
            load_text(text, "test.json")


def test_numbers_are_finite(subtests: pytest.Subtests) -> None:
    for number in ["NaN", "Infinity", "-Infinity", "1e999"]:
        with subtests.test(number):
            text = json.dumps(changed(HEAD_ON, "duration_s", "HERE")).replace('"HERE"', number)
            with pytest.raises(ScenarioError, match=r"test\.json: duration_s: found"):
                load_text(text, "test.json")


def test_a_number_of_five_thousand_digits_is_refused() -> None:
    text = json.dumps(changed(HEAD_ON, "duration_s", "HERE")).replace('"HERE"', "1" * 5_000)
    with pytest.raises(ScenarioError, match=r"test\.json"):
        load_text(text, "test.json")


def test_what_a_run_could_not_hold_is_refused_with_its_path(subtests: pytest.Subtests) -> None:
    table = [
        ("radio/lines/0/at_s", 1e308, "found 1e+308: input should be less than or equal to 86400"),
        ("end_when/0", {"type": "time", "at_s": 1e308}, "less than or equal to 86400"),
        ("perturbations", [{"path": "duration_s", "distribution":
                            {"type": "uniform", "limit": 1e308}}], "less than or equal to 1000000"),
        ("duration_s", True, "found true: input should be a valid number"),
        ("actors/0/initial/cas_kt", "290", 'found "290": input should be a valid number'),
        ("actors/0/transponder", {"equipped": 1}, "found 1: input should be a valid boolean"),
        ("actors/0/transponder", {"nacp": 9.0}, "found 9.0: input should be a valid integer"),
        ("daylight", {"date": 5}, "found 5: expected a date"),
        ("daylight", {"date": "0001-01-01"}, "expected a date from 1900-01-01 to 2100-12-31"),
        ("adsb", {"outages_s": [[20, 10]]}, "it ends before it begins"),
        ("radio/lines/0/at_s", 300, "found 300, when the run has ended; expected less than"),
        ("radio/lines/0/when", {"type": "line_ended", "line": "clearance"}, "this line itself"),
        ("radio/lines/0/when", {"type": "line_begun", "line": "clearance"}, "never comes true"),
        ("radio/lines/0/when", {"type": "time", "at_s": 300}, "or for a time after the run"),
        ("radio/lines/0/speaker", "Nobody", "no actor or unit 'Nobody'"),
        ("radio/lines/0/to", "AAL124", "no actor or unit 'AAL124'; did you mean 'AAL123'?"),
        ("radio/controller", "AAL123", "found 'AAL123', which is an actor"),
        ("radio/lines/1/commands/0/actor", "AAL124", "no actor 'AAL124'; did you mean 'AAL123'?"),
        ("radio/lines/1/commands/0/command/altitude_ft", -5000, "greater than or equal to -1500"),
        ("radio/lines/1/commands/0/command/altitude_ft", 0, "found 0, which is not above the gro"),
        ("actors/0/commands", [{"action": "emergency_descent", "altitude_ft": -100}], "found -100"),
        ("title", "\ud800", "half of a surrogate pair"),
        ("title", "\x00", "a control character"),
        ("radio/lines/0/text", "x" * 30_000, "found a text of 30,000 characters"),
        ("sensors", {"mine": {"a": [1e999]}}, "not finite"),
    ]  # fmt: skip
    for path, value, what in table:
        with subtests.test(str((path, value, what))):
            message = complaint(changed(VERTICAL, path, value))
            assert message.startswith(f"test.json: {path}")
            assert what in message
            assert len(message) <= 500


def test_two_lines_do_not_wait_for_each_other() -> None:
    document = changed(VERTICAL, "radio/lines/0/when", {"type": "line_ended", "line": "readback"})
    document = changed(document, "radio/lines/1/when", {"type": "line_begun", "line": "clearance"})
    assert "radio/lines/0/when: found a condition that never comes true" in complaint(document)


def test_a_line_may_wait_for_one_of_two_things_of_which_one_can_be() -> None:
    conditions = [{"type": "line_ended", "line": "clearance"}, {"type": "time", "at_s": 5}]
    either = {"type": "any_of", "conditions": conditions}
    load_text(json.dumps(changed(VERTICAL, "radio/lines/0/when", either)), "test.json")
    both = {"type": "all_of", "conditions": conditions}
    assert "radio/lines/0/when" in complaint(changed(VERTICAL, "radio/lines/0/when", both))


def test_a_unit_besides_the_controller_is_declared() -> None:
    document = changed(VERTICAL, "radio/lines/0/speaker", "Ops one")
    message = complaint(document)
    assert 'declared in radio/stations: {"Ops one": {}}' in message
    load_text(json.dumps(changed(document, "radio/stations", {"Ops one": {}})), "test.json")


def test_two_stations_do_not_share_a_name() -> None:
    receiver = {"name": "mast", "position": HEAD_ON["actors"][0]["initial"]["position"]}
    message = complaint(changed(HEAD_ON, "adsb", {"receivers": [receiver, receiver]}))
    assert "adsb/receivers/1/name: found 'mast', which adsb/receivers/0 has already" in message


def test_a_field_is_given_once() -> None:
    text = json.dumps(changed(VERTICAL, "radio/stations", {"AAL123": {}, "DAL456": {}}))
    with pytest.raises(ScenarioError, match="radio/stations: found field 'AAL123' twice"):
        load_text(text.replace('"DAL456": {}', '"AAL123": {}'), "test.json")


def test_conditions_are_nested_in_few_levels(subtests: pytest.Subtests) -> None:
    for depth in [20, 50, 200, 100_000]:
        with subtests.test(str(depth)):
            text = json.dumps(changed(HEAD_ON, "end_when", ["HERE"]))
            opening, closing = '{"type": "all_of", "conditions": [', "]}"
            inner = opening * depth + '{"type": "time", "at_s": 5}' + closing * depth
            with pytest.raises(
                ScenarioError, match="nested too deeply; expected at most 24"
            ) as caught:
                load_text(text.replace('"HERE"', inner), "test.json")
            assert len(str(caught.value)) <= 500


def test_a_file_has_a_greatest_size(tmp_path: Path) -> None:
    path = tmp_path / "large.json"
    path.write_text(" " * 5_000_001, encoding="utf-8")
    with pytest.raises(ScenarioError, match="cannot be read: has over 5,000,000 bytes"):
        load(path)
    path.write_text(f"[{'0,' * 600_000}0]", encoding="utf-8")
    with pytest.raises(ScenarioError, match="found over 500,000 values"):
        load(path)


def test_a_file_that_is_not_utf_8_is_told(tmp_path: Path) -> None:
    path = tmp_path / "latin.json"
    path.write_bytes(b'{"name": "caf\xe9"}')
    with pytest.raises(ScenarioError, match=r"latin\.json: not UTF-8 text \(byte 13\)"):
        load(path)


def test_a_file_loads_from_its_path(tmp_path: Path) -> None:
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(HEAD_ON), encoding="utf-8")
    assert load(path) == load(str(path)) == load("s02a_headon")


def test_a_file_that_is_not_there_is_told_with_the_names_that_are(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"none\.json: no such file.*s02a_headon"):
        load(tmp_path / "none.json")


def test_an_unknown_name_is_told_with_the_nearest() -> None:
    with pytest.raises(ScenarioError, match=r"named 's02a_headone'; did you mean 's02a_headon'\?"):
        load("s02a_headone")


def test_each_shipped_scenario_is_called_what_its_file_is_and_reads_back_the_same(
    subtests: pytest.Subtests,
) -> None:
    for name in library.names("scenarios"):
        with subtests.test(name):
            scenario = load(name)
            assert scenario.name == name
            assert load_text(scenario.model_dump_json(), "again") == scenario


def test_a_file_may_name_its_schema_and_is_the_same_scenario() -> None:
    document = {"$schema": "../docs/schemas/scenario.json"} | HEAD_ON
    scenario = load_text(json.dumps(document), "test.json")
    assert "$schema" not in scenario.model_dump_json()
    assert json.loads(scenario.model_dump_json()) == HEAD_ON


def test_a_misspelt_schema_field_is_answered_with_its_name() -> None:
    message = complaint({"$shema": "scenario.json"} | HEAD_ON)
    assert "$shema: unknown field; did you mean '$schema'?" in message


def test_reading_a_file_does_not_load_the_world() -> None:
    loaded = subprocess.run(
        [sys.executable, "-c", "import sys, airhilt.scenario.loading; print(*sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()
    assert "airhilt.scenario.loading" in loaded
    assert not [name for name in loaded if name.startswith(("airhilt.world", "airhilt.sensors"))]
