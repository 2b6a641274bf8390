"""`airhilt view` refuses in words what cannot be."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import httpx

from stations import PATIENCE_S, commanded

Cli = Callable[..., subprocess.CompletedProcess[str]]


def test_a_folder_without_a_run_is_named(airhilt_command: Cli, tmp_path: Path) -> None:
    done = airhilt_command("view", tmp_path, "--no-browser")
    assert done.returncode == 2
    assert "no run here" in done.stderr


def test_what_is_no_certificate_is_named(
    airhilt_command: Cli, recorded_run: Path, tmp_path: Path
) -> None:
    file = tmp_path / "token"
    file.write_text("0123456789abcdef")
    options = ("--certificate", file, "--key", file, "--token-file", file, "--no-browser")
    done = airhilt_command("view", recorded_run, "--host", "0.0.0.0", *options)
    assert done.returncode == 2
    assert "expected a PEM certificate and its key" in done.stderr


def test_options_of_a_page_are_refused_in_a_run_without_one(
    airhilt_command: Cli, tmp_path: Path
) -> None:
    given = ("--scenario=s02a_headon", f"--out={tmp_path / 'run'}", "--no-browser")
    done = airhilt_command("cosim", *given)
    assert done.returncode == 2
    assert "--no-browser would do nothing without --view or --seat" in done.stderr
    assert not (tmp_path / "run").exists()


def test_options_of_a_page_are_refused_where_no_participant_is_led(
    airhilt_command: Cli, tmp_path: Path
) -> None:
    done = airhilt_command("experiment", tmp_path / "plan.json", "--host", "0.0.0.0")
    assert done.returncode == 2
    assert "--host would do nothing without --participant" in done.stderr


def test_a_recorded_run_is_shown_until_the_command_is_interrupted(recorded_run: Path) -> None:
    with commanded("view", recorded_run) as url:
        shown = httpx.get(f"{url}api/run", timeout=PATIENCE_S, trust_env=False).json()
    assert shown["scenario"]["name"] == "encounter"
