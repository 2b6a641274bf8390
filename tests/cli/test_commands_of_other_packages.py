"""Other packages add commands; one that is broken takes none of the others away."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from click.shell_completion import get_completion_class

from airhilt.cli.main import cli
from engine_package import installed

GOOD = """
import click


@click.command()
@click.argument("name")
def greet(name):
    \"\"\"Greet somebody.\"\"\"
    click.echo(f"hello {name}")


ENGINE = greet
"""
BROKEN = "raise RuntimeError('it is broken')"
CAUSE = "command 'broken' cannot be loaded from outside_broken:ENGINE: RuntimeError: it is broken"


@pytest.fixture
def other_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Packages outside of AIRHILT with a command that works and one that does not."""
    with (
        installed(tmp_path, monkeypatch, "airhilt.commands", "greet", GOOD),
        installed(tmp_path, monkeypatch, "airhilt.commands", "broken", BROKEN),
    ):
        yield


@pytest.mark.usefixtures("other_packages")
def test_a_command_of_another_package_is_called_and_has_its_row(airhilt_command: Any) -> None:
    assert airhilt_command("greet", "Ada").stdout == "hello Ada\n"
    assert "Greet somebody." in airhilt_command("--help").stdout


@pytest.mark.usefixtures("other_packages")
def test_help_goes_on_without_a_broken_command_and_gives_the_cause(airhilt_command: Any) -> None:
    done = airhilt_command("--help")
    assert done.returncode == 0
    assert "Run a scenario" in done.stdout
    assert CAUSE in " ".join(done.stdout.split())


def test_a_command_that_ends_the_process_on_import_does_not_end_the_help(
    airhilt_command: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with installed(tmp_path, monkeypatch, "airhilt.commands", "broken", "raise SystemExit(7)"):
        done = airhilt_command("--help")
    assert done.returncode == 0
    assert "SystemExit: 7" in done.stdout


@pytest.mark.usefixtures("other_packages")
def test_completion_goes_on_without_a_broken_command() -> None:
    bash = get_completion_class("bash")
    assert bash is not None
    completion = bash(cli, {}, "airhilt", "_AIRHILT_COMPLETE")
    assert {"cosim", "greet"} <= {item.value for item in completion.get_completions([], "")}
    assert completion.get_completions(["broken"], "--") == []


@pytest.mark.usefixtures("other_packages")
def test_calling_a_broken_command_is_an_error(airhilt_command: Any) -> None:
    for arguments in ((), ("--help",), ("one", "--two", "-x")):
        done = airhilt_command("broken", *arguments)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr == f"airhilt: {CAUSE}\n"
