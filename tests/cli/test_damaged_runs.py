"""Commands that read a damaged run say in one line what is damaged, and go on with the rest."""

from __future__ import annotations

import json
import os
import random
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt.messages import Event
from airhilt.record import RunFolder
from airhilt.record.log import LogWriter
from damage import flip
from radio_folder import busy_radio

NESTED = b"[" * 100_000
NOT_UTF_8 = b'{"seed": "\xff\xfe"}'


def damage_lines(done: subprocess.CompletedProcess[str]) -> list[str]:
    assert "Traceback" not in done.stderr
    return [line for line in done.stderr.splitlines() if "damaged" in line]


def test_a_report_of_a_damaged_run_names_it_on_the_terminal_and_on_the_page(
    airhilt_command: Any, run_copy: Path
) -> None:
    log = run_copy / "log.mcap"
    whole = log.read_bytes()
    draw = random.Random(22)
    for _ in range(12):
        flip(log, draw.randrange(8 * len(whole) // 3))
        done = airhilt_command("report", run_copy)
        assert done.returncode == 0, done.stderr
        (line,) = damage_lines(done)
        assert line.startswith(f"airhilt: {run_copy}: log.mcap: damaged")
        page = (run_copy / "report.html").read_text()
        assert "Damaged: log.mcap: damaged" in page
        log.write_bytes(whole)


def test_a_replay_of_a_damaged_run_compares_what_is_left(
    airhilt_command: Any, run_copy: Path
) -> None:
    flip(run_copy / "log.mcap", 8 * 2500)
    done = airhilt_command("replay", run_copy)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.startswith("identical: ")
    assert "note: log.mcap: damaged from " in done.stdout


def test_a_replay_without_the_latencies_of_the_run_is_refused(
    airhilt_command: Any, run_copy: Path
) -> None:
    path = run_copy / "latency.jsonl"
    path.write_text(path.read_text().replace('"latency_ns": ', '"latency_ns": 1'))
    done = airhilt_command("replay", run_copy)
    assert done.returncode == 2
    assert "latency.jsonl: damaged or changed" in done.stderr


def test_a_replay_that_needs_what_others_said_is_refused_without_it(
    airhilt_command: Any, run_copy: Path
) -> None:
    folder = RunFolder(run_copy)
    folder.write_info(folder.info().model_copy(update={"unregistered_programs": True}))
    flip(run_copy / "log.mcap", 8 * 2500)
    done = airhilt_command("replay", run_copy)
    assert done.returncode == 2
    assert "it is needed here" in done.stderr


def test_a_comparison_names_the_run_that_is_damaged(
    airhilt_command: Any, recorded_run: Path, run_copy: Path
) -> None:
    flip(run_copy / "log.mcap", 8 * 2500)
    done = airhilt_command("compare", recorded_run, run_copy)
    assert done.returncode == 0, done.stderr
    (line,) = damage_lines(done)
    assert line.startswith(f"airhilt: {run_copy}: log.mcap: damaged from ")


def test_a_transcript_of_a_damaged_run_says_so(airhilt_command: Any, tmp_path: Path) -> None:
    folder = busy_radio(tmp_path / "radio")
    paths = RunFolder(folder)
    paths.write_info(paths.info().model_copy(update={"files": paths.manifest()}))
    flip(folder / "log.mcap", 8 * ((folder / "log.mcap").stat().st_size - 30))
    done = airhilt_command("listen", folder, "--out", tmp_path / "tower.wav")
    assert done.returncode == 0, done.stderr
    (line,) = damage_lines(done)
    assert line.startswith(f"airhilt: {folder}: log.mcap: damaged")
    assert "Damaged: log.mcap: damaged" in (tmp_path / "tower.txt").read_text()


@pytest.mark.parametrize(
    ("command", "content"),
    [("report", NESTED), ("replay", NOT_UTF_8), ("listen", b"[]"), ("compare", b"")],
)
def test_a_record_that_is_no_json_is_a_named_mistake(
    airhilt_command: Any, run_copy: Path, command: str, content: bytes
) -> None:
    (run_copy / "run.json").write_bytes(content)
    second = [run_copy] if command == "compare" else []
    done = airhilt_command(command, run_copy, *second)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "run.json: " in done.stderr


@pytest.mark.parametrize("content", [NESTED, b'{"worker": "w"}\n'])
def test_latencies_that_are_no_json_are_a_named_mistake(
    airhilt_command: Any, run_copy: Path, content: bytes
) -> None:
    folder = RunFolder(run_copy)
    folder.write_info(folder.info().model_copy(update={"files": {}}))
    (run_copy / "latency.jsonl").write_bytes(content + b"\n")
    assert airhilt_command("report", run_copy).returncode == 0
    done = airhilt_command("replay", run_copy)
    assert done.returncode == 2
    assert "latency.jsonl: line 1: " in done.stderr


def test_a_page_says_from_where_on_latencies_cannot_be_read(
    airhilt_command: Any, run_copy: Path
) -> None:
    path = run_copy / "latency.jsonl"
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join([*lines[:2], "{\n", *lines[2:]]))
    assert airhilt_command("report", run_copy).returncode == 0
    page = (run_copy / "report.html").read_text()
    assert "latency.jsonl cannot be read from line 3 on." in page


@pytest.mark.parametrize("content", [NESTED, b"[]"])
def test_numbers_that_are_no_json_are_named_by_report_and_refused_by_compare(
    airhilt_command: Any, run_copy: Path, recorded_run: Path, content: bytes
) -> None:
    (run_copy / "summary.json").write_bytes(content)
    done = airhilt_command("report", run_copy)
    assert done.returncode == 0, done.stderr
    assert "summary.json: damaged or changed" in done.stderr
    assert "The numbers below are missing" in (run_copy / "report.html").read_text()
    done = airhilt_command("compare", recorded_run, run_copy)
    assert done.returncode == 2
    assert "summary.json" in done.stderr


def test_a_run_is_left_as_it_was_by_those_who_read_it(
    airhilt_command: Callable[..., Any], run_copy: Path
) -> None:
    before = json.loads((run_copy / "run.json").read_text())
    for command in ("report", "replay"):
        assert airhilt_command(command, run_copy).returncode == 0
    assert json.loads((run_copy / "run.json").read_text()) == before
    assert airhilt.open_run(run_copy).damage == ()


@pytest.mark.parametrize(
    "changed",
    [
        {"actors": "AAL123"},
        {"radio": {"lines": [1]}},
        {"scene": {"airport": "mine.json"}, "files": {"mine.json": None}},
    ],
)
def test_a_record_of_another_scenario_than_a_run_writes_is_a_named_mistake(
    airhilt_command: Any, run_copy: Path, changed: dict[str, Any]
) -> None:
    folder = RunFolder(run_copy)
    info = folder.info()
    folder.write_info(info.model_copy(update={"realised": info.realised | changed}))
    done = airhilt_command("report", run_copy)
    assert "Traceback" not in done.stderr
    assert done.returncode == 0 or (done.returncode == 2 and "run.json: " in done.stderr)


@pytest.mark.parametrize("data", [NOT_UTF_8, b'{"t_ns": true}'])
def test_a_report_leaves_out_a_message_that_no_run_writes(
    airhilt_command: Any, run_copy: Path, data: bytes
) -> None:
    folder = RunFolder(run_copy)
    messages = list(airhilt.open_run(run_copy).log())
    log = LogWriter(folder.log_path)
    for logged in messages:
        written = data if logged.key in ("truth/event", "status/decision") else logged.data
        log.write(logged.key, logged.publisher, Event, logged.t_ns, written)
    log.write("truth/event", "run", Event, messages[-1].t_ns, data)
    log.close()
    folder.write_info(folder.info().model_copy(update={"files": folder.manifest()}))
    done = airhilt_command("report", run_copy)
    assert done.returncode == 0, done.stderr
    assert "left out" in (run_copy / "report.html").read_text()


@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("report", "log.mcap"),
        ("replay", "latency.jsonl"),
        ("compare", "summary.json"),
        ("verify", "log.mcap"),
    ],
)
def test_a_file_that_never_ends_is_not_read(
    airhilt_command: Any, run_copy: Path, command: str, name: str
) -> None:
    (run_copy / name).unlink()
    os.mkfifo(run_copy / name)
    second = [run_copy] if command == "compare" else []
    done = airhilt_command(command, run_copy, *second)
    assert done.returncode in (0, 1, 2)
    assert name in done.stdout + done.stderr
