"""The command line, as a person or a script meets it."""

from __future__ import annotations

import io
import json
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import pytest

from airhilt.cli.main import cli, main
from airhilt.errors import AirhiltError
from airhilt.host import library
from airhilt.options import ASSISTANT, CAMERAS, PEOPLE, PROGRAMS, RADIO, WORLD, options_of
from airhilt.record import RunFolder, read_log
from breadth import mostly_slow

SUMMARY_FIELDS = {
    "scenario", "seed", "assistant", "duration_s", "t_conflict_s", "t_first_warning_s",
    "time_to_first_warning_s", "lead_before_closest_approach_s", "margin_over_tcas_ta_s",
    "margin_over_tcas_ra_s", "min_horizontal_separation_m", "min_vertical_separation_m",
    "loss_of_separation", "nmac", "collision", "avoided", "nuisance_alerts", "advisories",
    "latencies", "modalities", "real_time_factor", "cpu_s",
}  # fmt: skip


def assert_is_a_users_mistake(done: subprocess.CompletedProcess[str], *said: str) -> None:
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    for text in said:
        assert text in done.stderr


def test_json_prints_the_summary_alone(airhilt_command: Any, encounter_file: Path) -> None:
    done = airhilt_command("cosim", "--scenario", encounter_file, "--out", "run", "--json")
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    assert set(summary) >= SUMMARY_FIELDS
    folder = encounter_file.parent / "run"
    assert json.loads((folder / "summary.json").read_text()) == summary
    assert set(summary["latencies"]["adsb"]) == {"n", "min_s", "p50_s", "p95_s", "max_s"}
    assert sorted(path.name for path in folder.iterdir()) == [
        "audio", "latency.jsonl", "log.mcap", "report.html", "run.json", "summary.json",
    ]  # fmt: skip


def test_before_a_run_begins_a_person_is_told_that_its_folder_is_not_there_yet(
    airhilt_command: Any, encounter_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def begin(*_: object) -> None:
        raise AirhiltError("begun")

    monkeypatch.setattr("airhilt.cosim.simulation.run", begin)
    done = airhilt_command("cosim", "--scenario", encounter_file, "--out", "run")
    assert done.stderr.splitlines() == [
        "airhilt: starting; the run folder appears in a moment",
        "airhilt: begun",
    ]
    assert not (encounter_file.parent / "run").exists()


@pytest.mark.parametrize(
    ("option", "value", "what"),
    [
        ("--latency", "bogus", "latency 'bogus': expected measured"),
        ("--pace", "-3", "pace '-3': expected"),
        ("--out", "taken", "holds files that are no run"),
        ("--asr", "bogus", "bogus"),
        ("--asr", "embedded:nowhere", "no such file or folder; expected embedded, embedded:FOLDER"),
        ("--renderer", "opengl", "no renderer named 'opengl'"),
    ],
)
def test_a_bad_option_is_refused_before_anything_is_begun(
    airhilt_command: Any, encounter_file: Path, option: str, value: str, what: str
) -> None:
    taken = encounter_file.parent / "taken"
    taken.mkdir()
    (taken / "notes").touch()
    for page in ((), ("--view", "--no-browser")):
        done = airhilt_command("cosim", "--scenario", encounter_file, option, value, *page)
        (line,) = done.stderr.splitlines()
        assert what in line
        assert (done.returncode, done.stdout) == (2, "")


def test_what_a_person_reads_names_the_numbers(airhilt_command: Any, encounter_file: Path) -> None:
    done = airhilt_command("cosim", "--scenario", encounter_file, "--out", "run")
    assert done.returncode == 0, done.stderr
    for text in ("conflict window", "time to first warning", "before TCAS", "avoided", "p95"):
        assert text in done.stdout
    assert done.stdout.rstrip().endswith("run folder: run")


def test_modalities_left_out_are_off(airhilt_command: Any, encounter_file: Path) -> None:
    done = airhilt_command(
        "cosim", "--scenario", encounter_file, "--no-speech", "--no-cameras",
        "--assistant", "none", "--json",
    )  # fmt: skip
    modalities = json.loads(done.stdout)["modalities"]
    assert modalities == {
        "adsb": "on", "radio": "on", "asr": "off", "tts": "off", "vision": "off",
        "decision": "off",
    }  # fmt: skip


@pytest.mark.parametrize("command", ["run", "simulate", "cosmi"])
def test_an_unknown_command_is_told_with_the_one_that_is_meant(
    airhilt_command: Any, command: str
) -> None:
    done = airhilt_command(command, "s02a_headon")
    assert_is_a_users_mistake(done, f"No such command '{command}'; did you mean 'cosim'?")


def test_every_place_for_results_is_on_this_machine() -> None:
    places = [
        option
        for command in commands(cli)
        for option in command.get_params(click.Context(command))
        if option.name == "out"
    ]
    assert len(places) > 9
    for option in places:
        with pytest.raises(AirhiltError, match="--out: found 's3://bucket/x', a URL"):
            option.type.convert("s3://bucket/x", option, None)
    with pytest.raises(AirhiltError, match="option out: found s3://bucket/x, a URL"):
        options_of({"out": "s3://bucket/x"})


def commands(group: click.Group) -> Iterator[click.Command]:
    """Yield the commands of a group and of the groups in it."""
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        if isinstance(command, click.Group):
            yield from commands(command)
        yield command


def test_the_options_of_a_run_are_explained_in_groups(airhilt_command: Any) -> None:
    told = airhilt_command("cosim", "--help").stdout
    groups = re.findall(r"^(\S.*):\n  -", told, flags=re.MULTILINE)
    assert groups == [
        "Options", ASSISTANT, PROGRAMS, PEOPLE, CAMERAS, RADIO, WORLD, "Page in the browser",
    ]  # fmt: skip


def test_the_schema_of_one_message_is_printed_by_its_name(airhilt_command: Any) -> None:
    printed = json.loads(airhilt_command("schema", "--message", "advisory").stdout)
    assert printed["title"] == "Advisory"
    assert "t_ready_ns" in printed["required"]


def test_a_terminal_without_utf_8_shows_what_it_can(monkeypatch: pytest.MonkeyPatch) -> None:
    out, err = (io.TextIOWrapper(io.BytesIO(), "latin-1", write_through=True) for _ in range(2))
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stderr", err)
    monkeypatch.setattr(sys, "argv", ["airhilt", "validate", "Zürich–Ω.json"])
    monkeypatch.setattr(signal, "signal", lambda *_: None)  # The tests keep their own.
    with pytest.raises(SystemExit, match="2"):
        main()
    assert b"Z\xfcrich??.json: no such file" in err.buffer.getvalue()


def test_list_names_every_scenario_with_a_title(airhilt_command: Any) -> None:
    rows = json.loads(airhilt_command("list", "--json").stdout)
    assert [row["name"] for row in rows] == library.names("scenarios")
    assert all(row["title"] for row in rows)


@pytest.mark.slow
def test_doctor_finds_everything(airhilt_command: Any) -> None:
    done = airhilt_command("doctor")
    assert done.returncode == 0, done.stdout
    assert "MISSING" not in done.stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("cosim", "--scenario", "s02a_haedon"), "did you mean 's02a_headon'?"),
        (("cosim", "s02a_haedon"), "did you mean 's02a_headon'?"),
        (("cosim", "s02a_headon", "--scenario", "s02a_headon"), "expected one of them"),
        (("cosim",), "no scenario given; expected a name of `airhilt list`"),
        (("cosim", "s02a_headon", "--out", "s3://bucket/run"), "--out: found 's3://bucket/run', a"),
        (("sweep", "s02a_headon", "--out", "file:///sweep"), "--out: found 'file:///sweep', a URL"),
        (("listen", "run", "--out", "s3://bucket/a.wav"), "expected a path on this machine"),
        (
            ("schema", "--message", "advisry"),
            "no message named 'advisry'; did you mean",
        ),
        (("cosim", "--scenario", "none.json"), "no such file"),
        (("cosim", "--scenario", "s02a_headon", "--latency", "replay:x"), "no run here"),
        (("cosim", "--scenario", "s02a_headon", "--seed", "-1"), "expected 0 or more"),
        (("cosim", "--scenario", "s02a_headon", "--endpoint", "nonsense"), "tcp/127.0.0.1:7447"),
        (
            ("cosim", "--scenario", "s02a_headon", "--attach", "x", "--attach-timeout", "0.3"),
            "did not attach",
        ),
        (("cosim", "--scenario", "s02a_headon", "--attach", "a/*"), "worker name"),
        (
            ("cosim", "--scenario", "s02a_headon", "--attach", "a", "--attach", "a"),
            "two workers are named",
        ),
        (("cosim", "--scenario", "s02a_headon", "--snr", "nan"), "--snr': nan"),
        (("cosim", "--scenario", "s02a_headon", "--visibility", "inf"), "100000"),
        (("cosim", "--scenario", "s02a_headon", "--radio-profile", "vfh"), "vhf, vhf_833, fading"),
        (("cosim", "--scenario", "s02a_headon", "--asr", ""), "recogniser ''"),
        (("cosim", "--scenario", "s02a_headon", "--no-speech", "--tts", "nonsense"), "--tts"),
        (("replay", "nowhere"), "no run here"),
        (("report", "nowhere"), "neither a run nor a sweep"),
    ],
)
def test_a_mistake_is_told_in_one_line_and_leaves_nothing_behind(
    airhilt_command: Any, tmp_path: Path, arguments: tuple[str, ...], said: str
) -> None:
    assert_is_a_users_mistake(airhilt_command(*arguments), said)
    assert list(tmp_path.iterdir()) == []


def test_a_port_in_use_is_named(airhilt_command: Any, tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        endpoint = f"tcp/127.0.0.1:{taken.getsockname()[1]}"
        done = airhilt_command("cosim", "--scenario", "s02a_headon", "--endpoint", endpoint)
    assert_is_a_users_mistake(done, endpoint, "--endpoint")
    assert list(tmp_path.iterdir()) == []


def test_an_unwritable_run_folder_is_named(airhilt_command: Any, tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    done = airhilt_command("cosim", "--scenario", "s02a_headon", "--out", file / "run")
    assert_is_a_users_mistake(done, "cannot be written", "--out")


def test_only_what_a_run_wrote_is_overwritten_and_only_if_asked(
    airhilt_command: Any, encounter_file: Path
) -> None:
    command = ("cosim", "--scenario", encounter_file, "--assistant", "none", "--out", "run")
    assert airhilt_command(*command).returncode == 0
    assert_is_a_users_mistake(airhilt_command(*command), "holds a run already", "--overwrite")
    kept = encounter_file.parent / "run" / "thesis.txt"
    kept.write_text("years of work")
    assert airhilt_command(*command, "--overwrite").returncode == 0
    assert kept.read_text() == "years of work"
    (encounter_file.parent / "run" / "run.json").write_text("{}")
    assert_is_a_users_mistake(airhilt_command(*command, "--overwrite"), "no run")


def test_latencies_of_another_scenario_are_refused(
    airhilt_command: Any, encounter_file: Path
) -> None:
    command = ("cosim", "--scenario", encounter_file, "--assistant", "none")
    assert airhilt_command(*command, "--out", "run").returncode == 0
    done = airhilt_command(*command, "--seed", "1", "--latency", "replay:run", "--out", "other")
    assert_is_a_users_mistake(done, "expected the same scenario and seed")
    assert not (encounter_file.parent / "other").exists()
    document = json.loads(encounter_file.read_text())
    encounter_file.write_text(json.dumps(document | {"duration_s": document["duration_s"] + 1.0}))
    done = airhilt_command(*command, "--latency", "replay:run", "--out", "other")
    assert_is_a_users_mistake(done, "has changed since that run, at /duration_s: recorded ")
    assert not (encounter_file.parent / "other").exists()


def test_a_route_that_leads_nowhere_is_named(airhilt_command: Any, encounter_file: Path) -> None:
    document = json.loads(encounter_file.read_text())
    actor = document["actors"][0]
    actor["initial"]["track_deg"] = 90.0
    actor["route"] = [actor["initial"]["position"]]
    encounter_file.write_text(json.dumps(document | {"perturbations": []}))
    done = airhilt_command("cosim", "--scenario", encounter_file)
    assert_is_a_users_mistake(done, "actors/AAL123", "route")


def start_slow_run(scenario: Path, out: Path) -> subprocess.Popen[bytes]:
    process = subprocess.Popen(
        [sys.executable, "-m", "airhilt", "cosim", "--scenario", scenario, "--pace", "4x",
         "--out", out],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
    )  # fmt: skip
    log = out / "log.mcap"
    deadline = time.monotonic() + 60.0
    while not (log.is_file() and log.stat().st_size > 20_000):
        assert time.monotonic() < deadline
        assert process.poll() is None
        time.sleep(0.05)
    return process


@pytest.mark.slow
def test_a_run_killed_outright_is_readable_up_to_the_last_second(
    airhilt_command: Any, encounter_file: Path
) -> None:
    out = encounter_file.parent / "run"
    process = start_slow_run(encounter_file, out)
    before = max(logged.t_ns for logged in read_log(out / "log.mcap"))
    process.kill()
    process.communicate()
    assert max(logged.t_ns for logged in read_log(out / "log.mcap")) >= before
    assert RunFolder(out).info().phase == "running"
    assert airhilt_command("report", out).returncode == 0
    replayed = airhilt_command("replay", out)
    assert replayed.returncode == 0, replayed.stdout + replayed.stderr
    assert "breaks off" in replayed.stdout


@pytest.mark.parametrize("number", mostly_slow([signal.SIGINT, signal.SIGTERM], signal.SIGINT))
def test_an_interrupted_run_leaves_a_complete_folder(
    airhilt_command: Any, encounter_file: Path, number: signal.Signals
) -> None:
    out = encounter_file.parent / "run"
    process = start_slow_run(encounter_file, out)
    process.send_signal(number)
    _, told = process.communicate(timeout=30.0)
    assert process.returncode == 130
    assert b"Traceback" not in told
    folder = RunFolder(out)
    assert folder.info().phase == "stopped"
    assert folder.info().cause == "interrupted"
    assert (folder.summary() or {})["outcome"] == "stopped: interrupted"
    assert folder.report_path.is_file()
    assert "breaks off" in airhilt_command("replay", out).stdout
