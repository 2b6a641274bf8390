"""The command that prints JSON Schemas."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import click

from airhilt.cli.output import tell
from airhilt.errors import AirhiltError
from airhilt.host.library import nearest


@click.command(
    epilog="""\b
Examples:
  airhilt schema > messages.json
  airhilt schema --message advisory
  airhilt schema --scenario > scenario.schema.json
  airhilt schema --services > services.openapi.json
  airhilt schema --assistant reference
  airhilt schema --sweep > sweep.schema.json
  airhilt schema --experiment > plan.schema.json
"""
)
@click.option("--message", metavar="NAME", help="The schema of one message, such as advisory.")
@click.option("--scenario", is_flag=True, help="The schema of scenario files instead.")
@click.option("--services", is_flag=True, help="The OpenAPI document of services instead.")
@click.option(
    "--assistant", metavar="NAME", help="The schema of an assistant's configuration instead."
)
@click.option("--sweep", is_flag=True, help="The schema of sweep files instead.")
@click.option("--experiment", is_flag=True, help="The schema of plans of experiments instead.")
def schema(
    message: str | None,
    scenario: bool,
    services: bool,
    assistant: str | None,
    sweep: bool,
    experiment: bool,
) -> None:
    """Print the JSON Schemas of all messages on the bus."""
    given = (message is not None, scenario, services, assistant is not None, sweep, experiment)
    if sum(given) > 1:
        raise click.UsageError(
            "--message, --scenario, --services, --assistant, --sweep, --experiment: expected one "
            "of them"
        )
    document: dict[str, Any]
    if services:
        from airhilt.assistant.services_document import services_document

        document = services_document()
    elif assistant is not None:
        from airhilt.engine_families import ASSISTANTS

        document = ASSISTANTS.configuration_model(assistant).model_json_schema()
    elif sweep:
        from airhilt.sweep.specification import Specification

        document = Specification.model_json_schema()
    elif experiment:
        from airhilt.station.plan import Plan

        document = Plan.model_json_schema()
    elif scenario:
        from airhilt.scenario import Scenario

        document = Scenario.model_json_schema()
    else:
        from airhilt.messages import json_schemas
        from airhilt.sensors.base import load_sensor_types, sensor_messages

        types, problems = load_sensor_types()
        for problem in problems:
            tell(str(problem))
        document = json_schemas(sensor_messages(types))
        if message is not None:
            document = _of_message(document, message)
    click.echo(json.dumps(document, indent=2))


def _of_message(documents: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Return the schema of a message by its name, in small or capital letters."""
    by_name: dict[str, dict[str, Any]] = {
        document["title"]: document for document in documents.values()
    }
    for title, document in by_name.items():
        if title.lower() == name.lower():
            return document
    raise AirhiltError(f"no message named {name!r}{nearest(name, list(by_name))}")


COMMAND = schema
