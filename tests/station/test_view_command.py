"""`airhilt view` refuses in words what cannot be."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

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


def test_an_open_address_is_refused_before_the_run_is_read(
    airhilt_command: Cli, recorded_run: Path
) -> None:
    done = airhilt_command("view", recorded_run, "--host", "0.0.0.0", "--no-browser")
    assert done.returncode == 2
    assert "other machines can reach it" in done.stderr


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--host", "0.0.0.0"], "--host would do nothing without --view or --seat"),
        (["--no-browser"], "--no-browser would do nothing without --view or --seat"),
        (["--port", "8420"], "--port would do nothing without --view or --seat"),
    ],
)
def test_options_of_a_page_are_refused_in_a_run_without_one(
    airhilt_command: Cli, tmp_path: Path, options: list[str], told: str
) -> None:
    done = airhilt_command("cosim", "--scenario=s02a_headon", f"--out={tmp_path / 'run'}", *options)
    assert done.returncode == 2
    assert told in done.stderr
    assert not (tmp_path / "run").exists()


def test_options_of_a_page_are_refused_where_no_participant_is_led(
    airhilt_command: Cli, tmp_path: Path
) -> None:
    done = airhilt_command("experiment", tmp_path / "plan.json", "--host", "0.0.0.0")
    assert done.returncode == 2
    assert "--host would do nothing without --participant" in done.stderr
