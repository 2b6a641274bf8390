"""The flags of a run, made of the fields of `airhilt.options.Options`."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal, get_args, get_origin

import click
from click.core import ParameterSource
from pydantic import ValidationError
from pydantic.fields import FieldInfo

from airhilt.cli.parameters import PATH, GroupedOption
from airhilt.configuration import read_configuration
from airhilt.options import Flag, Options, flag_of


def run_flags(
    names: Collection[str] = Options.model_fields.keys(),
    defaults: Mapping[str, str] = MappingProxyType({}),
) -> list[click.Parameter]:
    """Return the flags of those of the options that the command line spells.

    Parameters
    ----------
    defaults
        Defaults that the help tells in the place of the options' own.
    """
    return [
        _click_option(name, field, replace(flag, default=defaults.get(name, flag.default)))
        for name, field in Options.model_fields.items()
        if name in names and (flag := flag_of(field)) is not None
    ]


def options_given(context: click.Context) -> Options:
    """Return the options of a command line; those that were not given have their defaults.

    Raises
    ------
    click.BadParameter
        A value is not what the option takes.
    AirhiltError
        A file of the assistant's configuration cannot be read.
    """
    given = {
        name: value
        for name, value in context.params.items()
        if name in Options.model_fields
        and context.get_parameter_source(name) is ParameterSource.COMMANDLINE
    }
    if "assistant_config" in given:
        given["assistant_config"] = read_configuration(Path(given["assistant_config"]))
    try:
        return Options(**given)
    except ValidationError as error:
        problem = error.errors()[0]
        flag = flag_of(Options.model_fields[str(problem["loc"][0])])
        message = str(problem["msg"])
        raise click.BadParameter(
            f"{problem['input']!r}: {message[0].lower()}{message[1:]}.",
            context,
            param_hint=None if flag is None else f"'{flag.name}'",
        ) from None


def _click_option(name: str, field: FieldInfo, flag: Flag) -> click.Option:
    default = flag.default
    text = f"{flag.help} {flag.help_of_one_run}".rstrip()
    if not default and field.default not in (None, ()):
        default = f"{field.default:g}" if isinstance(field.default, float) else str(field.default)
    if default and field.annotation is not bool:
        text += f"  [default: {default}]"
    return option_of(name, flag, text, flag.metavar, _type(field.annotation))


def option_of(
    name: str, flag: Flag, text: str, metavar: str | None, kind: Any = str
) -> click.Option:
    """Return the option of the command line for an option of a run; a switch for a truth value."""
    spellings = [flag.name, name]
    field = Options.model_fields[name]
    if field.annotation is bool:
        is_on = bool(field.default)
        return GroupedOption(
            spellings,
            is_flag=True,
            flag_value=not is_on,
            default=is_on,
            help=text,
            group=flag.group,
        )
    is_multiple = get_origin(field.annotation) is tuple
    return GroupedOption(
        spellings, type=kind, multiple=is_multiple, metavar=metavar, help=text, group=flag.group
    )


def _type(annotation: Any) -> Any:
    """Return click's type of a value; its limits are checked by the model."""
    members = [member for member in get_args(annotation) if member is not type(None)]
    inner = annotation
    if get_origin(annotation) is not Literal and members:
        inner = members[0]
    if get_origin(inner) is Literal:
        return click.Choice(get_args(inner))
    while hasattr(inner, "__metadata__"):
        inner = get_args(inner)[0]
    if inner is Path:
        return PATH
    return inner if inner in (int, float) else str
