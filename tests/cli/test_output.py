"""What the command line prints of texts from outside is text, and no command to the terminal."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path
from typing import Any

import pytest

from airhilt.cli.output import echo, echo_json
from airhilt.cli.progress import ProgressLine
from airhilt.cosim.observer import Snapshot
from airhilt.host.text import LONGEST_LINE
from airhilt.messages import Advisory, Evidence, Severity

HOSTILE = "\x1b[2J\x9b31m\u202e\u2028[/red][bold]"


def is_safe(printed: str) -> bool:
    return all(line.isprintable() and len(line) <= LONGEST_LINE for line in printed.split("\n"))


def test_lines_and_json_have_no_control_characters(capsys: pytest.CaptureFixture[str]) -> None:
    echo(f"first {HOSTILE}\nsecond {'x' * 5000}")
    assert is_safe(capsys.readouterr().out)
    document = json.dumps({"cause": HOSTILE + "\U000e0001ü"}, ensure_ascii=False, indent=2)
    echo_json(document)
    printed = capsys.readouterr().out
    assert is_safe(printed)
    assert "ü" in printed
    assert json.loads(printed) == json.loads(document)


def test_json_is_whole_where_a_terminal_has_no_utf_8(monkeypatch: pytest.MonkeyPatch) -> None:
    out = io.TextIOWrapper(io.BytesIO(), "latin-1", write_through=True)
    monkeypatch.setattr(sys, "stdout", out)
    echo_json('{"name": "Zürich–\N{AIRPLANE}\N{SMALL AIRPLANE}"}')
    printed = out.buffer.getvalue().decode("latin-1")
    assert json.loads(printed) == {"name": "Zürich–\N{AIRPLANE}\N{SMALL AIRPLANE}"}


def test_progress_shows_advisories_and_notices_as_text(capsys: pytest.CaptureFixture[str]) -> None:
    advisory = Advisory(
        id="x-1", revision=0, recipient="ATC", recipients=("ATC",), kind="loss_of_separation",
        severity=Severity.WARNING, traffic=(), message=HOSTILE + "y" * 100_000,
        evidence=Evidence(sources=()), t_ready_ns=0,
    )  # fmt: skip
    line = ProgressLine("title")
    line._printed -= 100.0
    line.snapshot(Snapshot(1.0, 2.0, None, None, advisory))
    line.notice(HOSTILE + "z" * 100_000)
    printed = capsys.readouterr().err
    assert is_safe(printed)
    assert "[/red][bold]" in printed


@pytest.mark.parametrize(
    ("command", "name"), [("validate", "scenario"), ("verify", "manifest"), ("cosim", "option")]
)
def test_commands_show_foreign_names_as_text(
    airhilt_command: Any, encounter_file: Path, tmp_path: Path, command: str, name: str
) -> None:
    match name:
        case "scenario":
            document = json.loads(encounter_file.read_text()) | {HOSTILE: 1}
            encounter_file.write_text(json.dumps(document))
            done = airhilt_command(command, encounter_file)
        case "manifest":
            (tmp_path / "run.json").write_text(json.dumps({HOSTILE: HOSTILE}))
            done = airhilt_command(command, tmp_path)
        case _:
            done = airhilt_command(command, "--scenario", HOSTILE)
    assert done.returncode in (1, 2)
    assert is_safe(done.stdout + done.stderr)
