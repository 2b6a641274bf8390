"""The flags of a sweep abbreviate its file."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import pytest

from airhilt.cli.commands.cosim import COMMAND as COSIM
from airhilt.cli.commands.sweep import COMMAND
from airhilt.cli.run_flags import run_flags
from airhilt.cli.station_flags import PageOptions
from airhilt.cli.sweep_flags import specification_given, value_flags
from airhilt.errors import AirhiltError
from airhilt.options import Options, flag_of


def given(*arguments: str) -> dict[str, Any]:
    """Return the specification that a command line means, as a sweep file has it."""
    context = COMMAND.make_context("sweep", list(arguments))
    taken = [context.params[name] for name in ("file", "scenarios", "seeds", "set_", "sample")]
    found: dict[str, Any] = specification_given(context, *taken).model_dump(
        mode="json", by_alias=True, exclude_defaults=True
    )
    return found


@pytest.fixture
def with_file(tmp_path: Path) -> Callable[..., dict[str, Any]]:
    """Return the specification of a file and of flags beside it."""

    def both(document: Any, *arguments: str) -> dict[str, Any]:
        file = tmp_path / "sweep.json"
        file.write_text(json.dumps(document))
        return given("--file", str(file), *arguments)

    return both


def flags(command: click.Command) -> set[str]:
    parameters = command.get_params(click.Context(command))
    return {flag for each in parameters if "--help" not in each.opts for flag in each.opts}


def test_every_flag_of_a_run_that_changes_it_is_one_of_sweeps() -> None:
    fields = Options.model_fields.values()
    of_one_run = {
        flag.name for flag in map(flag_of, fields) if flag is not None and not flag.in_sweeps
    }
    assert {"--attach", "--endpoint", "--pace", "--seat", "--video"} <= of_one_run
    missing = flags(COSIM) - flags(COMMAND)
    of_page = {f"--{one.name.replace('_', '-')}" for one in dataclasses.fields(PageOptions)}
    of_page |= {"--view"}
    assert missing == (of_one_run | of_page | {"--seed"}) - flags(COMMAND)


def test_flags_and_a_file_say_the_same(with_file: Callable[..., dict[str, Any]]) -> None:
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
    by_flags = given(
        *("--scenario", "s01a_*", "--scenario", "s02a_headon", "--seeds", "10", "--no-speech"),
        *("--snr", "0:20:5", "--visibility", "400,800", "--assistant", "reference,paper"),
        *("--latency", "fixed,asr=fixed:2", "--set", "assistant.tau_asr=log:0.1:1:3"),
        *("--equipment", "tcas", "--equipment", "conflict_alert"),
    )
    assert by_flags == with_file(document)


def test_flags_add_to_a_file_and_replace_what_it_says(
    with_file: Callable[..., dict[str, Any]],
) -> None:
    file = {"scenarios": ["s01a_*"], "axes": {"snr_db": [1], "assistant": ["none"]}}
    found = with_file(file, "--snr", "2,3", "--seeds", "4,7")
    assert found["axes"] == {"snr_db": [2, 3], "assistant": ["none"]}
    assert (found["scenarios"], found["seeds"]) == (["s01a_*"], [4, 7])


def test_a_file_may_leave_its_scenarios_to_the_flags(
    with_file: Callable[..., dict[str, Any]],
) -> None:
    assert with_file({"axes": {"snr_db": [1]}}, "--scenario", "x")["scenarios"] == ["x"]
    with pytest.raises(click.UsageError, match="--scenario"):
        with_file({"axes": {"snr_db": [1]}})


@pytest.mark.parametrize(
    "said",
    [
        {"options": {"snr_db": 1}},
        {"axes": {"radio.snr_db": [1]}},
        {"sample": {"method": "sobol", "count": 2, "intervals": {
            "snr_db": {"from": 0, "to": 9}, "visibility_m": {"from": 1, "to": 2}}}},
    ],
)  # fmt: skip
def test_a_flag_replaces_its_parameter_wherever_a_file_has_it(
    said: dict[str, Any], with_file: Callable[..., dict[str, Any]]
) -> None:
    found = with_file({"scenarios": ["x"], **said}, "--snr", "2")
    assert found["axes"] == {"snr_db": [2]}
    assert not found.get("options")
    assert "snr_db" not in found.get("sample", {}).get("intervals", {})


def test_a_switch_replaces_the_axis_of_a_file(with_file: Callable[..., dict[str, Any]]) -> None:
    found = with_file({"scenarios": ["x"], "axes": {"speech": [True, False]}}, "--no-speech")
    assert found == {"scenarios": ["x"], "options": {"speech": False}}


@pytest.mark.parametrize(
    ("document", "problem"),
    [
        ({"scenarios": ["x"], "axes": []}, "sweep.json: axes: found"),
        ({"scenarios": ["x"], "seed": 3}, "sweep.json: seed: "),
    ],
)
def test_a_file_that_is_no_sweep_is_refused_by_its_name(
    document: Any, problem: str, with_file: Callable[..., dict[str, Any]]
) -> None:
    with pytest.raises(AirhiltError, match=problem):
        with_file(document)


def test_the_help_offers_nothing_that_only_single_runs_have() -> None:
    single, sweeps = (
        next(str(each.help) for each in flags if each.name == "assistant")
        for flags in (run_flags(), value_flags())
    )
    assert "external" in single
    assert "external" not in sweeps


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
        (["--seeds", "0:9"], "step or a count"),
        (["--snr", "0:20"], "--sample"),
        (["--sample", "sobol"], "METHOD:COUNT"),
        (["--sample", "lhs:5"], "no interval to draw from.*--snr 0:20"),
        (["--set", "snr_db"], "PATH=VALUES"),
        (["--set", "a.b=5:1:1"], "^a.b: .*the smaller end first"),
        (["--seeds", "1,,2"], "^seeds: .*one is empty"),
        (["--assistant-config", "no.json"], "no.json"),
        (["--snr", "1", "--set", "radio.snr_db=2"], "snr_db: given twice"),
    ],
)
def test_what_cannot_be_meant_is_refused(arguments: list[str], problem: str) -> None:
    scenario = ["--scenario", "x"] if arguments else []
    with pytest.raises((AirhiltError, click.ClickException), match=problem):
        given(*scenario, *arguments)
