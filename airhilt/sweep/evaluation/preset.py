"""A preset of an evaluation, what can be chosen in it, and what it makes its tables of."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from pydantic import JsonValue

from airhilt.engine_families import FAMILIES, NONE
from airhilt.sweep.evaluation.tables import Table
from airhilt.sweep.specification import Specification, first_seeds

Row = Mapping[str, Any]
"""A row of ``sweep.parquet`` (docs/sweep-columns.md)."""


@dataclass(frozen=True)
class Choice:
    """Choices of the user in a preset.

    Attributes
    ----------
    seeds
        Number of seeds, from 0 on.
    options
        Options of all runs that the user gives, as JSON has them; a preset settles the others.
    assistants
        Assistants of the user's, for a preset that takes them.
    """

    seeds: int
    options: Mapping[str, JsonValue]
    assistants: tuple[str, ...] = ()

    @property
    def has_cameras(self) -> bool:
        """True if the cameras of the scenarios take pictures."""
        return bool(self.options.get("cameras", True))

    @property
    def has_speech(self) -> bool:
        """True if radio calls are sound."""
        return bool(self.options.get("speech", True))

    def with_at_most(self, seeds: int) -> Choice:
        """Return the same with no more than a number of seeds."""
        return replace(self, seeds=min(self.seeds, seeds))

    def specification(
        self,
        scenarios: Sequence[str],
        settled: Mapping[str, JsonValue],
        axes: Mapping[str, Sequence[JsonValue]] | None = None,
    ) -> Specification:
        """Return a sweep of scenarios with all seeds; what the user gives wins over the preset.

        Without an assistant nobody recognises or detects, so engines for that are left out.
        """
        is_assisted = settled["assistant"] != NONE
        needing = {family.option for family in FAMILIES if "assistant" in family.needs}
        given = {
            name: value
            for name, value in self.options.items()
            if is_assisted or name not in needing
        }
        return Specification.model_validate(
            {
                "scenarios": list(scenarios),
                "seeds": first_seeds(self.seeds),
                "options": {**settled, **given},
                "axes": {path: list(values) for path, values in (axes or {}).items()},
            }
        )


@dataclass(frozen=True)
class Results:
    """The rows of an evaluation, by the names of its sweeps; runs that failed are left out."""

    choice: Choice
    rows: Mapping[str, Sequence[Row]]


@dataclass(frozen=True)
class Preset:
    """Sweeps, and tables of them.

    Attributes
    ----------
    seeds
        Number of seeds unless the user gives one.
    specifications
        Returns the sweeps by their names, which are those of their folders.
    takes_assistants
        True if it runs the assistants that the user names.
    """

    name: str
    summary: str
    seeds: int
    specifications: Callable[[Choice], Mapping[str, Specification]]
    tables: Callable[[Results], Sequence[Table]]
    takes_assistants: bool = False
