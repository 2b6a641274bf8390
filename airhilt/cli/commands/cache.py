"""The commands of ``airhilt cache``: what the user's cache holds, and clear."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from airhilt.cli.parameters import json_option

if TYPE_CHECKING:
    from airhilt.host.caches import Usage


@click.group(
    invoke_without_command=True,
    epilog="""\b
Examples:
  airhilt cache                     where the cache is, and what it holds
  airhilt cache --json
  airhilt cache clear               delete all of it
  airhilt cache clear backgrounds   delete one kind
""",
)
@json_option
@click.pass_context
def cache(context: click.Context, as_json: bool) -> None:
    """Show what runs keep for later runs, and clear it.

    The cache is in $XDG_CACHE_HOME/airhilt, or else in ~/.cache/airhilt. AIRHILT_CACHE_LIMIT_MB is
    its greatest size (2000); 0 keeps nothing.
    """
    from airhilt.host.caches import cache_folder, cache_limit_bytes, usage, write_problem

    if context.invoked_subcommand is not None:
        return
    folder, limit_bytes = cache_folder(), cache_limit_bytes()
    kinds = usage(folder)
    if as_json:
        shown = {
            "folder": str(folder),
            "limit_mb": limit_bytes / 1e6,
            "kinds": [
                {"kind": each.kind, "files": each.files, "mb": each.size_bytes / 1e6}
                for each in kinds
            ],
        }
        click.echo(json.dumps(shown, indent=2))
        return
    click.echo(f"{folder}, at most {limit_bytes / 1e6:g} MB")
    _print_rows(kinds)
    if problem := write_problem(folder):
        click.echo(f"cannot be written: {problem}", err=True)


@cache.command()
@click.argument("kinds", nargs=-1, metavar="[KIND]...")
def clear(kinds: tuple[str, ...]) -> None:
    """Delete what the cache holds, of some kinds or of all; other files stay."""
    from airhilt.host.caches import cache_folder
    from airhilt.host.caches import clear as clear_kinds

    deleted = clear_kinds(cache_folder(), kinds)
    click.echo("deleted:")
    _print_rows(deleted)


def _print_rows(kinds: Sequence[Usage]) -> None:
    width = max(len(each.kind) for each in kinds)
    for each in kinds:
        click.echo(f"{each.kind:{width}}  {each.files:6} files  {each.size_bytes / 1e6:8.1f} MB")


COMMAND = cache
