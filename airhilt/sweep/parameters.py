"""Parameters of a sweep: the place that a path names, and the value that is put there.

A path is the name of an option, ``assistant.`` and a setting of the assistant, or leads from the
top of a scenario to a value. There, entries of lists are named by callsign, id or name.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from operator import getitem
from typing import Any

from airhilt.errors import AirhiltError
from airhilt.host.library import nearest
from airhilt.options import Options, flag_of
from airhilt.scenario.perturbation import PathError, locate, place_of, spreads

Json = dict[str, Any]

ASSISTANT = "assistant"
"""Option, and first part of the paths of the assistant's settings."""
OPTIONS_OF_PATHS = {
    "radio.snr_db": "snr_db",
    "radio.profile": "radio_profile",
    "radio.topology": "topology",
    "weather.visibility_m": "visibility_m",
    "crews": "crews",
}
"""Options that replace a value of the scenario: one parameter, two spellings."""
PLACES_OF_OPTIONS = {
    option: tuple(path.split(".")) for path, option in OPTIONS_OF_PATHS.items()
} | {"assistant_config": (ASSISTANT,)}
"""Keys that lead to the value, or to all values, that an option replaces."""


@dataclass(frozen=True)
class Plan:
    """One run in the making: a scenario's document, and the options that were given."""

    document: Json
    options: Json


@dataclass(frozen=True)
class Parameter:
    """Parameter that a path names.

    Attributes
    ----------
    path
        Its one spelling; the column of the table.
    """

    path: str

    def put(self, plan: Plan, value: Any) -> Plan:
        """Return a plan with another value of this parameter.

        Raises
        ------
        AirhiltError
            The scenario has no such place; the message gives the nearest.
        """
        first, *rest = self.path.split(".")
        if self.path in Options.model_fields:
            return Plan(plan.document, plan.options | {self.path: value})
        if first == ASSISTANT:
            settings = _with_setting(plan.options.get("assistant_config"), rest, value)
            return Plan(plan.document, plan.options | {"assistant_config": settings})
        return Plan(_with_value(plan.document, self.path, value), plan.options)

    def place(self, document: Json) -> tuple[str | int, ...]:
        """Return the keys that lead to its value; empty if nothing else can replace that."""
        if self.path in Options.model_fields:
            return PLACES_OF_OPTIONS.get(self.path, ())
        if self.path.startswith(f"{ASSISTANT}."):
            return tuple(self.path.split("."))
        try:
            return place_of(document, self.path.replace(".", "/"))
        except PathError:
            return ()

    def value(self, plan: Plan) -> Any:
        """Return the value that a checked plan has of it."""
        first, *rest = self.path.split(".")
        if self.path in Options.model_fields:
            return plan.options.get(self.path, Options.model_fields[self.path].default)
        if first == ASSISTANT:
            return reduce(getitem, rest, plan.options["assistant_config"])
        container, key = locate(plan.document, self.path.replace(".", "/"))
        return container[key]


def parameter(path: str) -> Parameter:
    """Return the parameter that a path names; a scenario's is looked for when it is put.

    Parameters
    ----------
    path
        In any of its spellings: with dots or slashes, of an option or of what it replaces.

    Raises
    ------
    AirhiltError
        It is an option, but not one of sweeps.
    """
    path = path.replace("/", ".").strip(".")  # Perturbations of scenarios write a/b.
    if path == "seed":
        raise AirhiltError("parameter seed: expected in seeds (--seeds), not among the parameters")
    if path == "name":
        raise AirhiltError("parameter name: it tells scenarios apart; expected a value of theirs")
    path = OPTIONS_OF_PATHS.get(path, path)
    if path in Options.model_fields and path not in swept_options():
        raise AirhiltError(f"parameter {path}: this option belongs to one run; sweeps have it not")
    return Parameter(path)


def swept_options() -> list[str]:
    """Return the names of the options that the runs of a sweep can have."""
    return [
        name
        for name, field in Options.model_fields.items()
        if (flag := flag_of(field)) is not None and flag.in_sweeps
    ]


def _with_setting(given: Any, path: list[str], value: Any) -> Json:
    """Return a configuration with one more setting; those that it had stay."""
    settings = dict(given) if isinstance(given, Mapping) else {}
    name, *rest = path
    settings[name] = _with_setting(settings.get(name), rest, value) if rest else value
    return settings


def _with_value(document: Json, path: str, value: Any) -> Json:
    """Return a scenario's document with another value, which no perturbation changes any more."""
    changed = copy.deepcopy(document)
    try:
        container, key = locate(changed, path.replace(".", "/"))
    except PathError as error:
        is_at_top = error.chunk == path.partition(".")[0]
        known = [*error.known, *swept_options(), ASSISTANT] if is_at_top else error.known
        also = "there is no such option, and " if is_at_top else ""
        where = "" if is_at_top else " there"
        raise AirhiltError(
            f"parameter {path}: {also}{document['name']!r} has no {error.chunk!r}{where}"
            f"{nearest(error.chunk, known)}"
        ) from None
    given = place_of(changed, path.replace(".", "/"))
    changed["perturbations"] = [
        {"path": each, "distribution": spread.model_dump(mode="json")}
        for each, spread in spreads(changed).items()
        if place_of(changed, each) != given
    ]
    container[key] = value
    return changed
