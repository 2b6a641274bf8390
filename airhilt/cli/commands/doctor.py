"""The command that says what is installed and what is missing."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict

import click

from airhilt.cli.output import echo


@click.command(
    epilog="""\b
Examples:
  airhilt doctor
  airhilt doctor --json
"""
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON array.")
def doctor(as_json: bool) -> None:
    """Say what is installed, what is missing or broken, and how to get it.

    Exit code 1 if something is missing that every run needs, or something installed is broken.
    """
    from airhilt.cli.doctor import examine

    findings = examine()
    if as_json:
        click.echo(json.dumps([asdict(finding) for finding in findings], indent=2))
    else:
        for finding in findings:
            echo(finding)
    if any(finding.is_broken or (finding.needed and not finding.found) for finding in findings):
        sys.exit(1)


COMMAND = doctor
