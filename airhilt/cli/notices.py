"""Lines for a person that are no result of a command."""

from __future__ import annotations

from airhilt.cli.output import echo


def tell(text: str) -> None:
    """Print a line on standard error, as errors are."""
    echo(f"airhilt: {text}", err=True)
