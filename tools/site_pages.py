"""Parts of the documentation that are made from the code: commands, messages, the Python API.

`tools/site_hooks.py` puts them into the pages of the site.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterable, Iterator
from typing import Any

import click

import airhilt
from airhilt.cli.main import cli
from airhilt.cli.parameters import GroupedOption
from airhilt.messages import json_schemas

Schema = dict[str, Any]
CODE = re.compile(r"``(.+?)``")
KEY = re.compile(r"^``[^`]+``: ")
"""Key with which the docstring of a message begins."""


def commands(parent: click.Context | None = None) -> Iterator[click.Context]:
    """Yield the context of each command that can be called, with those of groups."""
    parent = parent or click.Context(cli, info_name="airhilt")
    group = parent.command
    assert isinstance(group, click.Group)
    for name in group.list_commands(parent):
        command = group.get_command(parent, name)
        assert command is not None
        context = click.Context(command, parent=parent, info_name=name)
        if not isinstance(command, click.Group) or command.invoke_without_command:
            yield context
        if isinstance(command, click.Group):
            yield from commands(context)


def command_line() -> str:
    """Return all commands with their options, in Markdown."""
    return "\n\n".join(map(_command, commands()))


def _command(context: click.Context) -> str:
    groups: dict[str, list[tuple[str, str]]] = {}
    for parameter in context.command.get_params(context):
        if isinstance(parameter, click.Option) and (record := parameter.get_help_record(context)):
            group = getattr(parameter, "group", GroupedOption.group)
            groups.setdefault(group, []).append((f"`{record[0]}`", record[1]))
    usage = " ".join([context.command_path, *context.command.collect_usage_pieces(context)])
    parts = [f"## {context.command_path}", _help(context.command), f"```\n{usage}\n```"]
    parts += [_table(group, "meaning", rows) for group, rows in groups.items()]
    return "\n\n".join(parts)


def _help(command: click.Command) -> str:
    """Return the help of a command; what click leaves as it is, is code here."""
    paragraphs = inspect.cleandoc(command.help or "").split("\n\n")
    return "\n\n".join(
        f"```\n{text.removeprefix(chr(8)).strip()}\n```" if text.startswith("\b") else text
        for text in paragraphs
    )


def messages() -> str:
    """Return the fields of all messages, by their keys, and those of their parts, in Markdown."""
    parts: dict[str, Schema] = {}
    sections = []
    for key, schema in json_schemas().items():
        parts |= schema.get("$defs", {})
        sections.append(f"## {schema['title']} {{ #{_anchor(key)} }}\n\n`{key}`")
        schema["description"] = KEY.sub("", schema["description"])
        sections.append(_fields(schema))
    for name, schema in sorted(parts.items()):
        sections.append(f"## {name} {{ #{name.lower()} }}\n\nPart of messages.")
        sections.append(_fields(schema))
    return "\n\n".join(sections)


def _anchor(key: str) -> str:
    return "key-" + re.sub(r"[^a-z0-9]+", "-", key.lower()).strip("-")


def _fields(schema: Schema) -> str:
    text = CODE.sub(r"`\1`", inspect.cleandoc(schema.get("description", "")))
    if "enum" in schema:
        return f"{text}\n\nOne of {_type(schema)}."
    needed = schema.get("required", [])
    rows = (
        (f"`{name}`", _type(field) + (", needed" if name in needed else ""), _meaning(field))
        for name, field in schema.get("properties", {}).items()
    )
    lines = [f"| {' | '.join(map(_cell, row))} |" for row in rows]
    return "\n".join([text, "", "| field | type | meaning |", "|---|---|---|", *lines])


def _meaning(field: Schema) -> str:
    limits = [
        f"{word} {field[name]}"
        for name, word in (("minimum", "at least"), ("maximum", "at most"))
        if name in field and abs(field[name]) < 2**53
    ]
    return "; ".join(filter(None, [field.get("description", ""), ", ".join(limits)]))


def _type(field: Schema) -> str:
    """Return the type of a field in words, with links to parts of messages."""
    if "$ref" in field:
        name = field["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})"
    if choices := field.get("anyOf", field.get("oneOf")):
        return " or ".join(map(_type, choices))
    if "enum" in field:
        return ", ".join(f"`{value}`" for value in field["enum"])
    if "const" in field:
        return f"`{field['const']}`"
    if "prefixItems" in field:
        return f"[{', '.join(map(_type, field['prefixItems']))}]"
    if "items" in field:
        return f"list of {_type(field['items'])}"
    if isinstance(values := field.get("additionalProperties"), dict):
        return f"object of {_type(values)}"
    return str(field.get("type", "any"))


def python_api() -> str:
    """Return a directive of mkdocstrings for each public name of the package."""
    return "\n\n".join(f"::: {path}" for path in _paths(airhilt.__all__))


def _paths(names: Iterable[str]) -> Iterator[str]:
    for name in names:
        public = getattr(airhilt, name)
        if callable(public):
            yield f"{public.__module__}.{name}"


def _table(first: str, second: str, rows: Iterable[tuple[str, str]]) -> str:
    lines = [f"| {_cell(left)} | {_cell(right)} |" for left, right in rows]
    return "\n".join([f"| {first} | {second} |", "|---|---|", *lines])


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ").replace("<", "&lt;")


GENERATED = {
    "command-line.md": command_line,
    "messages.md": messages,
    "python-api.md": python_api,
}
"""Functions that make the end of pages from the code, by the path of the page."""
