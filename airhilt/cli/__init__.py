"""The commands of ``airhilt``."""

from airhilt.cli.main import cli, main

__all__ = ["cli", "main"]
