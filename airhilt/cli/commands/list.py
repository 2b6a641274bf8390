"""The command that names scenarios."""

from __future__ import annotations

import json

import click

from airhilt.cli.parameters import json_array_option


@click.command(
    "list",
    epilog="""\b
Examples:
  airhilt list
  airhilt list --json
""",
)
@json_array_option
def list_scenarios(as_json: bool) -> None:
    """Name the scenarios that ship with AIRHILT."""
    from airhilt.host import library

    rows = []
    for name in library.names("scenarios"):
        document = json.loads(library.find("scenarios", name).read_text(encoding="utf-8"))
        rows.append({key: document.get(key, "") for key in ("name", "family", "title")})
    if as_json:
        click.echo(json.dumps(rows, indent=2))
        return
    width = max((len(row["name"]) for row in rows), default=0)
    for row in rows:
        click.echo(f"{row['name']:{width}}  {row['family']}  {row['title']}")


COMMAND = list_scenarios
