"""The flags of a sweep: those of a run that change it, which take several values here."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from airhilt.configuration import read_configuration
from airhilt.errors import AirhiltError
from airhilt.options import Options, flag_of
from airhilt.sweep.axes import Interval, Range, read_values
from airhilt.sweep.specification import Specification, first_seeds, specification_of

WHOLE = ("latency", "llm")
"""Options whose one value may have commas and colons in it."""
CONFIGURATION = "assistant_config"
"""Option that is the content of a file."""
METHODS = {"lhs": "latin_hypercube", "latin_hypercube": "latin_hypercube", "sobol": "sobol"}
Json = dict[str, Any]


def value_flags() -> list[click.Parameter]:
    """Return the flags of the options that a sweep gives values."""
    return [_option(name) for name in _swept()]


def _swept() -> list[str]:
    return [
        name
        for name, field in Options.model_fields.items()
        if name != "seed" and (flag := flag_of(field)) is not None and flag.in_sweeps
    ]


def _option(name: str) -> click.Option:
    field = Options.model_fields[name]
    flag = flag_of(field)
    assert flag is not None
    if field.annotation is bool:
        return click.Option(
            [flag.name, *flag.former, name],
            is_flag=True,
            flag_value=not field.default,
            default=bool(field.default),
            help=flag.help,
        )
    is_multiple = field.annotation == tuple[str, ...]
    is_one = is_multiple or name in (*WHOLE, CONFIGURATION)
    metavar = flag.metavar or name.upper()
    return click.Option(
        [flag.name, *flag.former, name],
        metavar=metavar if is_one else f"{metavar},...",
        multiple=is_multiple,
        help=flag.help,
    )


def specification_given(
    context: click.Context,
    document: Json,
    scenarios: tuple[str, ...],
    seeds: str | None,
    set_: tuple[str, ...],
    sample: str | None,
) -> Specification:
    """Return the specification of a file with what the flags add to it or replace in it.

    Parameters
    ----------
    document
        Content of the file, empty without one.
    set_
        Texts such as ``radio.snr_db=0:20:5``.
    sample
        Text such as ``sobol:64`` or ``lhs:100:7``, the last number being the seed.

    Raises
    ------
    AirhiltError
        Something that was given is wrong.
    """
    document = {"options": {}, "axes": {}, **document}
    options, axes = dict(document["options"]), dict(document["axes"])
    intervals: Json = dict((document.get("sample") or {}).get("intervals", {}))
    for path, values in _given(context, options, set_):
        if isinstance(values, Range):
            axes[path] = values.model_dump(by_alias=True, exclude_none=True)
        elif isinstance(values, Interval):
            intervals[path] = values.model_dump(by_alias=True)
        else:
            axes[path] = list(values)
    document |= {"options": options, "axes": axes}
    if scenarios:
        document["scenarios"] = list(scenarios)
    if seeds is not None:
        document["seeds"] = _seeds(seeds)
    if sample is not None:
        document["sample"] = _sample(sample)
    if document.get("sample"):
        document["sample"] = {**document["sample"], "intervals": intervals}
    elif intervals:
        path = next(iter(intervals))
        raise AirhiltError(
            f"{path}: an interval without a step is to draw samples from; expected --sample such "
            "as sobol:64, or a range such as 0:20:5"
        )
    if "scenarios" not in document:
        raise click.UsageError("Missing option '--scenario'.")
    return specification_of(document, "sweep")


def _given(context: click.Context, options: Json, set_: tuple[str, ...]) -> list[tuple[str, Any]]:
    """Return path and values of what the command line varies; put switches into ``options``."""
    found: list[tuple[str, Any]] = []
    for name in _swept():
        if context.get_parameter_source(name) is not ParameterSource.COMMANDLINE:
            continue
        value = context.params[name]
        if isinstance(value, bool):
            options[name] = value
        elif isinstance(value, tuple):
            options[name] = list(value)
        elif name == CONFIGURATION:
            options[name] = read_configuration(Path(value))
        else:
            found.append((name, (value,) if name in WHOLE else read_values(value)))
    for text in set_:
        path, equals, values = text.partition("=")
        if not equals or not path.strip():
            raise AirhiltError(f"--set {text}: expected PATH=VALUES, such as radio.snr_db=0:20:5")
        found.append((path.strip(), read_values(values)))
    return found


def _seeds(text: str) -> Any:
    """Return the seeds of a text: a number of them, or values."""
    if text.isdecimal():
        return first_seeds(int(text))
    values = read_values(text)
    return (
        values.model_dump(by_alias=True, exclude_none=True)
        if isinstance(values, Interval)
        else list(values)
    )


def _sample(text: str) -> Json:
    method, *numbers = text.split(":")
    if method not in METHODS or len(numbers) not in (1, 2) or not all(map(str.isdecimal, numbers)):
        raise AirhiltError(
            f"--sample {text}: expected METHOD:COUNT or METHOD:COUNT:SEED, METHOD being lhs or "
            "sobol"
        )
    seed = int(numbers[1]) if len(numbers) == 2 else 0
    return {"method": METHODS[method], "count": int(numbers[0]), "seed": seed}
