"""The flags of a sweep abbreviate its file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click
import pytest

from airhilt.cli.commands.sweep import COMMAND
from airhilt.cli.sweep_flags import specification_given
from airhilt.errors import AirhiltError
from airhilt.options import Options, flag_of
from airhilt.sweep.specification import read_specification


def given(*arguments: str, file: dict[str, Any] | None = None) -> dict[str, Any]:
    """Return the specification that a command line means, as a sweep file has it."""
    context = COMMAND.make_context("sweep", list(arguments))
    taken = [context.params[name] for name in ("scenarios", "seeds", "set_", "sample")]
    found: dict[str, Any] = specification_given(context, file or {}, *taken).model_dump(
        mode="json", by_alias=True, exclude_defaults=True
    )
    return found


def test_every_flag_of_a_run_that_changes_it_is_one_of_sweeps() -> None:
    context = COMMAND.make_context("sweep", ["--scenario", "x"])
    names = {parameter.name for parameter in COMMAND.get_params(context)}
    of_runs = {
        name
        for name, field in Options.model_fields.items()
        if (flag := flag_of(field)) is not None and flag.in_sweeps
    }
    assert of_runs - {"seed"} <= names
    assert not {"attach", "endpoint", "overwrite", "pace", "video"} & of_runs


def test_flags_and_a_file_say_the_same(tmp_path: Path) -> None:
    file = tmp_path / "sweep.json"
    document = {
        "scenarios": ["s01a_*", "s02a_headon"],
        "seeds": {"from": 0.0, "to": 9.0, "scale": "linear", "step": 1.0},
        "options": {"speech": False, "equipment": ["tcas", "conflict_alert"]},
        "axes": {
            "snr_db": {"from": 0.0, "to": 20.0, "step": 5.0},
            "visibility_m": [400, 800],
            "assistant": ["reference", "paper"],
            "latency": ["fixed,asr=fixed:2"],
            "assistant.tau_asr": {"from": 0.1, "to": 1.0, "scale": "log", "count": 3},
        },
    }
    file.write_text(json.dumps(document))
    by_flags = given(
        *("--scenario", "s01a_*", "--scenario", "s02a_headon", "--seeds", "10", "--no-speech"),
        *("--snr", "0:20:5", "--visibility", "400,800", "--assistant", "reference,paper"),
        *("--latency", "fixed,asr=fixed:2", "--set", "assistant.tau_asr=log:0.1:1:3"),
        *("--equipment", "tcas", "--equipment", "conflict_alert"),
    )
    by_file = read_specification(file).model_dump(mode="json", by_alias=True, exclude_defaults=True)
    assert by_flags == by_file


def test_flags_add_to_a_file_and_replace_what_it_says() -> None:
    file = {"scenarios": ["s01a_*"], "axes": {"snr_db": [1], "assistant": ["none"]}}
    found = given("--snr", "2,3", "--seeds", "4,7", file=file)
    assert found["axes"] == {"snr_db": [2, 3], "assistant": ["none"]}
    assert (found["scenarios"], found["seeds"]) == (["s01a_*"], [4, 7])


def test_intervals_are_drawn_from() -> None:
    found = given(
        "--scenario", "x", "--snr", "0:20", "--sample", "sobol:64:7", "--seeds", "10:12:1"
    )
    assert found["sample"] == {
        "method": "sobol",
        "count": 64,
        "seed": 7,
        "intervals": {"snr_db": {"from": 0.0, "to": 20.0}},
    }
    assert found["seeds"]["from"] == 10.0


def test_a_configuration_of_the_assistant_is_read_at_once(tmp_path: Path) -> None:
    file = tmp_path / "strict.json"
    file.write_text('{"tau_asr": 0.9}')
    found = given("--scenario", "x", "--assistant-config", str(file))
    assert found["options"] == {"assistant_config": {"tau_asr": 0.9}}


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ([], "--scenario"),
        (["--seeds", "0"], "at least 1"),
        (["--seeds", "0:9"], "step or a count"),
        (["--snr", "0:20"], "--sample"),
        (["--sample", "sobol"], "METHOD:COUNT"),
        (["--sample", "grid:5", "--snr", "0:20"], "lhs or sobol"),
        (["--sample", "lhs:5"], "at least 1 item"),
        (["--set", "snr_db"], "PATH=VALUES"),
        (["--snr", ""], "one is empty"),
        (["--assistant-config", "no.json"], "no.json"),
    ],
)
def test_what_cannot_be_meant_is_refused(arguments: list[str], problem: str) -> None:
    scenario = ["--scenario", "x"] if arguments else []
    with pytest.raises((AirhiltError, click.ClickException), match=problem):
        given(*scenario, *arguments)
