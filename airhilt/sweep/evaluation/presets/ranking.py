"""Assistants of the user's beside the reference and the negative controls, in one ranking."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from airhilt.engine_families import NONE
from airhilt.sweep.evaluation import ranking
from airhilt.sweep.evaluation.assistants import REFERENCE, Assistant, shipped_scenarios
from airhilt.sweep.evaluation.preset import Choice, Preset, Results
from airhilt.sweep.evaluation.tables import Table
from airhilt.sweep.specification import Specification


def specifications(choice: Choice) -> Mapping[str, Specification]:
    """Return the sweeps of the ranking over all scenarios that have a nominal twin."""
    names = [name for name, one in shipped_scenarios().items() if one.nominal_twin is not None]
    given = [Assistant(name) for name in choice.assistants if name != REFERENCE.name]
    return ranking.sweeps(choice, [*given, REFERENCE], names, {"latency": "fixed"})


def tables(results: Results) -> Sequence[Table]:
    """Return the ranking."""
    return (ranking.table(ranking.tried(results.rows), results.rows[NONE]),)


PRESET = Preset(
    name="ranking",
    summary="your assistants (--assistant), the reference and the negative controls, ranked",
    seeds=3,
    specifications=specifications,
    tables=tables,
    takes_assistants=True,
)
