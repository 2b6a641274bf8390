"""`airhilt view` refuses in words what cannot be."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

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
