"""Texts of radio lines are compared with the commands that they should mean."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from airhilt.cli.commands.validate import COMMAND
from airhilt.host import library
from airhilt.scenario import Scenario
from airhilt.world.checks.texts import doubtful_texts
from airhilt.world.loading import load

TIGHT = load("s01a_tight_timing").model_dump(mode="json")
BAD_READBACK = load("s01a_bad_readback").model_dump(mode="json")
VERTICAL = load("s02a_vertical").model_dump(mode="json")


def doubts(document: dict[str, Any], line: str, **changes: Any) -> list[str]:
    """Return the doubts about a scenario with one line changed."""
    lines = [each | changes if each["id"] == line else each for each in document["radio"]["lines"]]
    changed = document | {"radio": document["radio"] | {"lines": lines}}
    return [str(doubt) for doubt in doubtful_texts(Scenario.model_validate(changed))]


def test_texts_of_shipped_scenarios_say_what_their_commands_do() -> None:
    doubtful = {name: list(doubtful_texts(load(name))) for name in library.names("scenarios")}
    assert not any(doubtful.values()), doubtful


def test_words_that_mean_something_else_are_told(subtests: pytest.Subtests) -> None:
    for text, doubt in [
        ("American ninety nine, runway zero one, cleared to land.", "names no actor, not AAL123"),
        ("Delta four five six, runway zero one, cleared to land.", "names DAL456, not AAL123"),
        (
            "American one two three, runway one niner, cleared to land.",
            "says runway 19, where its command has 01",
        ),
        ("American one two three, good morning.", "does not say to land, as its command does"),
    ]:
        with subtests.test(text):
            (found,) = doubts(TIGHT, TIGHT["radio"]["lines"][0]["id"], text=text)
            assert found == f"radio/lines/0/text: {doubt}: {text!r}"


def test_another_order_than_the_command_is_told_both_ways() -> None:
    text = "American one two three, go around."
    lacking, besides = doubts(TIGHT, TIGHT["radio"]["lines"][0]["id"], text=text)
    assert lacking == f"radio/lines/0/text: does not say to land, as its command does: {text!r}"
    assert besides == f"radio/lines/0/text: says go around, which no command does: {text!r}"


def test_details_of_turns_routes_and_climbs_are_compared(subtests: pytest.Subtests) -> None:
    rows: list[Any] = [
        ("turn right thirty degrees", {"action": "turn", "degrees": 30.0}, ""),
        ("turn left thirty degrees", {"action": "turn", "degrees": 30.0}, "says turn_deg -30"),
        ("turn left thirty degrees", {"action": "turn", "degrees": -20.0}, "says turn_deg -30"),
        ("taxi via bravo and kilo", {"action": "taxi", "via": ["B", "K"]}, ""),
        ("taxi via bravo", {"action": "taxi", "via": ["K"]}, "says via B, where its command has K"),
        ("taxi via bravo", {"action": "taxi"}, ""),
        (
            "climb flight level three five zero at two thousand feet per minute",
            {"action": "altitude", "altitude_ft": 35_000.0, "vertical_rate_fpm": 1500.0},
            "says rate_fpm 2000, where its command has 1500",
        ),
    ]
    for words, command, doubt in rows:
        with subtests.test(str((words, command, doubt))):
            if command["action"] == "taxi":
                command = command | {"to": {"type": "node", "node": "gate"}}
            line = VERTICAL["radio"]["lines"][0]
            commands = [{"actor": "AAL123", "command": command}]
            found = doubts(
                VERTICAL, line["id"], text=f"American one two three, {words}.", commands=commands
            )
            assert len(found) == bool(doubt)
            assert all(doubt in each for each in found)


def test_an_order_that_no_command_carries_out_is_told(subtests: pytest.Subtests) -> None:
    table = [
        ("roger", "go around, climb and maintain three thousand", "go around"),
        ("roger", "descend and maintain two thousand", "altitude"),
        ("clearance", "cleared to land runway zero one, turn left heading one eight zero",
         "heading"),
        ("clearance", "cleared for takeoff runway zero one", "cleared for takeoff"),
        ("readback", "cleared to land runway zero one, go around", "go around"),
        ("readback", "cleared to land runway zero one, descend and maintain two thousand",
         "altitude"),
    ]  # fmt: skip
    for line, text, order in table:
        with subtests.test(str((line, text, order))):
            said = f"American one two three, {text}."
            if line == "readback":
                said = f"{text.capitalize()}, American one two three."
            doubted = doubts(BAD_READBACK, line, text=said)
            assert any(f"says {order}, which no command does: {said!r}" in each for each in doubted)


def test_an_order_to_go_on_as_before_needs_no_command(subtests: pytest.Subtests) -> None:
    for text in [
        "American one two three, continue approach, number two.",
        "American one two three, hold position.",
        "American one two three, maintain three thousand.",
        "American one two three, expect runway one niner.",
    ]:
        with subtests.test(text):
            assert doubts(BAD_READBACK, "roger", text=text) == []


def test_what_an_answer_does_is_not_missing_in_the_call_that_it_answers() -> None:
    text = "American one two three, runway zero one, cleared to land."
    assert doubts(BAD_READBACK, "clearance", text=text) == []
    assert doubts(BAD_READBACK, "readback", commands=[]) != []


def test_a_take_off_that_climbs_and_turns_is_one_command() -> None:
    text = "Delta four five six, fly heading one eight zero, runway zero one, cleared for takeoff."
    assert doubts(BAD_READBACK, "takeoff", text=text) == []


def test_a_level_that_is_not_the_one_flown_to_is_told() -> None:
    text = "Climb and maintain flight level three three zero, American one two three."
    (found,) = doubts(VERTICAL, "readback", text=text)
    assert "says altitude_ft 33000, where its command has 35000" in found


def test_a_wrong_readback_is_compared_with_its_own_commands() -> None:
    wrong = {
        "type": "readback_wrong", "line": "readback",
        "text": "Climb and maintain flight level three seven zero, American one two three.",
        "commands": [
            {"actor": "AAL123", "command": {"action": "altitude", "altitude_ft": 37_000}}
        ],
    }  # fmt: skip
    assert doubts(VERTICAL | {"failures": [wrong]}, "none") == []
    wrong["text"] = "Climb and maintain flight level three niner zero, American one two three."
    (found,) = doubts(VERTICAL | {"failures": [wrong]}, "none")
    assert found.startswith("failures/0/text: says altitude_ft 39000")


def test_validate_warns_and_says_valid(tmp_path: Path) -> None:
    path = tmp_path / "other.json"
    document = json.loads(json.dumps(TIGHT))
    document["radio"]["lines"][0]["text"] = "American one two three, good morning."
    path.write_text(json.dumps(document))
    done = CliRunner().invoke(COMMAND, [str(path)])
    assert done.exit_code == 0
    assert "valid: s01a_tight_timing" in done.stdout
    assert f"airhilt: warning: {path}: radio/lines/0/text: does not say to land" in done.stderr
    assert "declared in failures" in done.stderr
