"""The flags of a sweep: those of a run that change it, which take several values here."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal

import click
from click.core import ParameterSource

from airhilt.cli.run_flags import option_of
from airhilt.configuration import read_configuration
from airhilt.errors import AirhiltError, shown
from airhilt.options import Options, flag_of
from airhilt.sweep.axes import Interval, Range, read_values
from airhilt.sweep.parameters import parameter, swept_options
from airhilt.sweep.specification import Specification, first_seeds, specification_of

WHOLE = ("latency", "llm")
"""Options whose one value may have commas and colons in it."""
CONFIGURATION = "assistant_config"
"""Option that is the content of a file."""
METHODS = {"lhs": "latin_hypercube", "latin_hypercube": "latin_hypercube", "sobol": "sobol"}
Json = dict[str, Any]
Place = Literal["options", "axes", "intervals"]
"""Part of a sweep file that holds values by their paths."""


def value_flags() -> list[click.Parameter]:
    """Return the flags of the options that a sweep gives values."""
    return [_option(name) for name in _swept()]


def _swept() -> list[str]:
    return [name for name in swept_options() if name != "seed"]


def _option(name: str) -> click.Option:
    field = Options.model_fields[name]
    flag = flag_of(field)
    assert flag is not None
    is_one = field.annotation == tuple[str, ...] or name in (*WHOLE, CONFIGURATION)
    metavar = flag.metavar or name.upper()
    return option_of(name, flag, flag.help, metavar if is_one else f"{metavar},...")


def specification_given(
    context: click.Context,
    file: Path | None,
    scenarios: tuple[str, ...],
    seeds: str | None,
    set_: tuple[str, ...],
    sample: str | None,
) -> Specification:
    """Return the specification of a file with what the flags add to it or replace in it.

    Parameters
    ----------
    file
        A sweep file, which may leave to the flags what they give; None: there is none.
    set_
        Texts such as ``radio.snr_db=0:20:5``.
    sample
        Text such as ``sobol:64`` or ``lhs:100:7``, the last number being the seed.

    Raises
    ------
    AirhiltError
        Something that was given is wrong.
    """
    document, origin = ({}, "sweep") if file is None else (read_configuration(file), str(file))
    drawn = _object(document, "sample", origin)
    parts = {name: _object(document, name, origin) for name in ("options", "axes")}
    if file is not None:
        _read_configurations(parts, file.parent)
    parts["intervals"] = _object(drawn, "intervals", origin)
    for path, (place, value) in _given(context, set_).items():
        for part in parts.values():
            _forget(part, path)
        parts[place][path] = value
    intervals = parts.pop("intervals")
    document |= parts
    if scenarios:
        document["scenarios"] = list(scenarios)
    if seeds is not None:
        is_count = seeds.isdecimal()
        document["seeds"] = first_seeds(int(seeds)) if is_count else _placed("seeds", seeds)[1]
    if sample is not None:
        drawn = _sample(sample)
    if drawn and not intervals:
        raise AirhiltError(
            f"{origin}: sample: there is no interval to draw from; expected a parameter with one, "
            "such as --snr 0:20"
        )
    if drawn:
        document["sample"] = {**drawn, "intervals": intervals}
    elif intervals:
        path = next(iter(intervals))
        raise AirhiltError(
            f"{path}: an interval without a step is to draw samples from; expected --sample such "
            "as sobol:64, or a range such as 0:20:5"
        )
    if "scenarios" not in document:
        raise click.UsageError("Missing option '--scenario'.")
    return specification_of(document, origin)


def _read_configurations(parts: dict[str, Json], folder: Path) -> None:
    """Replace the paths of configurations in a sweep file, which are relative to its folder."""

    def content(given: Any) -> Any:
        return read_configuration(folder / given) if isinstance(given, str) else given

    options, axes = parts["options"], parts["axes"]
    if CONFIGURATION in options:
        options[CONFIGURATION] = content(options[CONFIGURATION])
    if isinstance(axes.get(CONFIGURATION), list):
        axes[CONFIGURATION] = [content(each) for each in axes[CONFIGURATION]]


def _object(document: Json, name: str, origin: str) -> Json:
    """Return a copy of an object in a document, empty if it is not there."""
    found = document.get(name)
    if found is not None and not isinstance(found, dict):
        raise AirhiltError(f"{origin}: {name}: found {shown(found)}; expected a JSON object")
    return dict(found or {})


def _forget(part: Json, path: str) -> None:
    """Remove a parameter, however it is spelled."""
    for spelling in [each for each in part if parameter(each).path == path]:
        del part[spelling]


def _given(context: click.Context, set_: tuple[str, ...]) -> dict[str, tuple[Place, Any]]:
    """Return what the command line says, by path: its place in the file, and its value there."""
    found: dict[str, tuple[Place, Any]] = {}
    for spelling, value in _said(context, set_):
        path = parameter(spelling).path
        if path in found:
            raise AirhiltError(f"parameter {path}: given twice; expected once")
        found[path] = value
    return found


def _said(context: click.Context, set_: tuple[str, ...]) -> Iterator[tuple[str, tuple[Place, Any]]]:
    """Yield the paths in the order of the flags, as they are spelled, with place and value."""
    for name in _swept():
        if context.get_parameter_source(name) is not ParameterSource.COMMANDLINE:
            continue
        value = context.params[name]
        if isinstance(value, bool):
            yield name, ("options", value)
        elif isinstance(value, tuple):
            yield name, ("options", list(value))
        elif name == CONFIGURATION:
            yield name, ("options", read_configuration(Path(value)))
        else:
            yield name, ("axes", [value]) if name in WHOLE else _placed(name, value)
    for text in set_:
        path, equals, values = text.partition("=")
        if not equals or not path.strip():
            raise AirhiltError(f"--set {text}: expected PATH=VALUES, such as radio.snr_db=0:20:5")
        yield path.strip(), _placed(path.strip(), values)


def _placed(path: str, text: str) -> tuple[Place, Any]:
    """Return what a text of values is in a sweep file."""
    try:
        values = read_values(text)
    except AirhiltError as error:
        raise AirhiltError(f"{path}: {error}") from None
    if isinstance(values, Interval):
        place: Place = "axes" if isinstance(values, Range) else "intervals"
        return place, values.model_dump(by_alias=True, exclude_none=True)
    return "axes", list(values)


def _sample(text: str) -> Json:
    method, *numbers = text.split(":")
    if method not in METHODS or len(numbers) not in (1, 2) or not all(map(str.isdecimal, numbers)):
        raise AirhiltError(
            f"--sample {text}: expected METHOD:COUNT or METHOD:COUNT:SEED, METHOD being lhs or "
            "sobol"
        )
    seed = int(numbers[1]) if len(numbers) == 2 else 0
    return {"method": METHODS[method], "count": int(numbers[0]), "seed": seed}
