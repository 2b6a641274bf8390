"""Radio lines in a scenario file: frequencies, answers, and what goes wrong on the air."""

from __future__ import annotations

import copy
import json
from typing import Any

import pytest
from pydantic import TypeAdapter

from airhilt.errors import ScenarioError
from airhilt.scenario.conversation import needed_lines
from airhilt.scenario.failures import apply_failures
from airhilt.scenario.models import Failure
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.world.loading import load, load_text

DOCUMENT = load("s01a_nominal").model_dump(mode="json")
FAILURES = TypeAdapter(tuple[Failure, ...])


def changed(**lines: Any) -> dict[str, Any]:
    """Return the nominal scenario with fields of some lines changed."""
    document = copy.deepcopy(DOCUMENT)
    for line in document["radio"]["lines"]:
        line |= lines.get(line["id"], {})
    return document


def complaint(document: dict[str, Any]) -> str:
    with pytest.raises(ScenarioError) as caught:
        load_text(json.dumps(document), "test.json")
    return str(caught.value)


@pytest.mark.parametrize("frequency_khz", [118_020, 137_000, 117_975])
def test_a_frequency_is_a_channel(frequency_khz: int) -> None:
    message = complaint(changed(clearance={"frequency_khz": frequency_khz}))
    assert "radio/lines/0/frequency_khz" in message
    assert f"{frequency_khz} kHz is no channel" in message


def test_an_833_khz_channel_is_one() -> None:
    document = changed(clearance={"frequency_khz": 118_005}, readback={"frequency_khz": 118_005})
    assert load_text(json.dumps(document), "test.json").radio.lines[0].frequency_khz == 118_005


def test_a_line_is_not_named_like_a_call_that_is_not_in_the_script(
    subtests: pytest.Subtests,
) -> None:
    table = [
        "clearance.repeat-1", "clearance.say-again-12", "clearance.readback",
        "readback.correction", "readback.correction.readback", "stuck-microphone.AAL123.9.119100",
        "clearance.Repeat-1", "arrival.AAL123.1", "tells.AAL123.1", "clearance.contact",
        "clearance.end", "readback.confirmation-1.request", "seat.AAL123.1",
        "microphone.AAL123.1",
    ]  # fmt: skip
    for name in table:
        with subtests.test(name):
            message = complaint(changed(roger={"id": name}))
            assert f"radio/lines/2/id: found {name!r}" in message
            assert "calls that are not in the script" in message


def test_ids_of_lines_differ_in_more_than_case() -> None:
    message = complaint(changed(readback={"id": "Clearance"}))
    assert "radio/lines/1/id" in message
    assert "found 'Clearance', which radio/lines/0 has already, as 'clearance'" in message


def test_a_line_answers_one_before_it_on_its_frequency() -> None:
    assert "did you mean 'takeoff'" in complaint(changed(takeoff_readback={"answers": "takoff"}))
    assert "no line 'takeoff' before" in complaint(changed(clearance={"answers": "takeoff"}))
    other = changed(takeoff_readback={"answers": "takeoff"}, takeoff={"frequency_khz": 121_500})
    assert "121500 kHz" in complaint(other)


def test_the_radio_of_a_station_belongs_to_somebody_in_the_scenario() -> None:
    document = changed(clearance={"snr_db": 3.0, "wet": 0.5})
    document["radio"]["stations"] = {"AAL123": {"snr_db": 5.0}, "Washington Tower": {"wet": 0.2}}
    radio = load_text(json.dumps(document), "test.json").radio
    assert (radio.lines[0].snr_db, radio.stations["Washington Tower"].wet) == (3.0, 0.2)
    document["radio"]["stations"] = {"AAL124": {"snr_db": 5.0}}
    message = complaint(document)
    assert "radio/stations/AAL124: no actor or unit 'AAL124'; did you mean 'AAL123'" in message


def test_a_receiver_belongs_to_somebody_in_the_scenario_who_listens() -> None:
    document = changed()
    document["radio"]["receivers"] = {"AAL123": {"snr_db": 3.0}, "Washington Tower": {"snr_db": 9}}
    radio = load_text(json.dumps(document), "test.json").radio
    assert radio.receivers["AAL123"].snr_db == 3.0
    document["radio"]["receivers"] = {"AAL124": {"snr_db": 3.0}}
    message = complaint(document)
    assert "radio/receivers/AAL124: no actor or unit 'AAL124'; did you mean 'AAL123'" in message
    document["radio"]["receivers"] = {"ASSISTANT": {"snr_db": 3.0}}
    assert "radio/receivers/ASSISTANT: no actor or unit" in complaint(document)
    deer = load("s01c_nominal").model_dump(mode="json")
    deer["radio"]["receivers"] = {"DEER1": {"snr_db": 3.0}}
    assert "radio/receivers/DEER1: no actor or unit" in complaint(deer)


def test_a_microphone_sticks_on_a_frequency() -> None:
    document = changed()
    document["actors"].append(
        document["actors"][0] | {"callsign": "UAL7", "icao24": "abcdef", "on_roster": False}
    )
    document["failures"] = [{"type": "stuck_microphone", "actor": "UAL7", "at_s": 1, "for_s": 600}]
    assert "'UAL7' is on no frequency" in complaint(document)
    document["failures"][0]["actor"] = "UAL8"
    assert "no actor 'UAL8'" in complaint(document)
    document["failures"][0] |= {"actor": "AAL123", "for_s": 4000}
    assert "failures/0/for_s" in complaint(document)


def test_a_blocked_line_does_not_wait_for_the_frequency() -> None:
    scenario = load("s01a_nominal")
    failures = FAILURES.validate_python([{"type": "blocked", "line": "takeoff"}])
    effective = apply_failures(scenario.model_copy(update={"failures": failures}))
    listens = {each.declared.id: each.listens_first for each in effective}
    assert listens.pop("takeoff") is False
    assert all(listens.values())


def test_a_readback_needs_the_call_that_it_reads_back() -> None:
    needed = needed_lines(load("s01a_nominal"))
    assert needed["readback"] == ("clearance",)
    assert needed["takeoff_readback"] == ("takeoff",)
    assert needed["clearance"] == ()


def test_a_call_that_comes_of_a_report_needs_the_report() -> None:
    assert needed_lines(load("s01c_deer_delayed_warning"))["go_around"] == ("report",)


def test_a_readback_by_somebody_else_names_what_it_reads_back() -> None:
    assert needed_lines(load("s01a_misaddressed"))["go_around_readback"] == ("go_around",)


def test_a_profile_of_the_radio_is_one_of_those_that_there_are() -> None:
    document = changed()
    document["radio"]["profile"] = "vfh"
    message = complaint(document)
    assert "radio/profile" in message
    for name in PROFILES:
        assert name in message
    profiles: tuple[str | None, ...] = (*PROFILES, "simugan.onnx", None)
    for profile in profiles:
        document["radio"]["profile"] = profile
        assert load_text(json.dumps(document), "test.json").radio.profile == profile


def test_a_controller_is_of_a_unit_with_a_frequency_that_is_its_own(
    subtests: pytest.Subtests,
) -> None:
    table = [
        ({"AAL123": {}}, "controllers/AAL123: it is an actor; expected the name of a unit"),
        ({"Washington Towr": {}}, "controllers/Washington Towr: no unit 'Washington Towr'; did"),
        (
            {"Approach": {"frequencies_khz": [119_100]}},
            "controllers/Approach: it is on 119100 kHz, and so is 'Washington Tower'; expected one",
        ),
        (
            {"Approach": {"frequencies_khz": [124_720]}},
            "controllers/Approach/frequencies_khz/0: 124720 kHz is no channel",
        ),
        ({"Washington Tower": {"compliance": 1.5}}, "controllers/Washington Tower/compliance"),
        (
            {"Washington Tower": {"acts_on": ["weather"]}},
            'controllers/Washington Tower/acts_on/0: found "weather", expected '
            "'loss_of_separation', 'readback_mismatch', 'runway_conflict', 'clarification' or "
            "'conflict_alert'",
        ),
    ]
    for controllers, expected in table:
        with subtests.test(str(controllers)):
            assert expected in complaint(DOCUMENT | {"controllers": controllers})
    document = DOCUMENT | {"controllers": {"Approach": {"frequencies_khz": [124_700]}}}
    assert load_text(json.dumps(document), "test.json").controllers["Approach"].frequencies_khz == (
        124_700,
    )
