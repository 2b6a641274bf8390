"""Lines for a person that are no result of a command."""

from __future__ import annotations

import click


def tell(text: str) -> None:
    """Print a line on standard error, as errors are."""
    click.echo(f"airhilt: {text}", err=True)
