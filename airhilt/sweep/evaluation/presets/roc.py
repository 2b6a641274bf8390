"""Preset of the receiver operating characteristic: what is missed against what disturbs.

Each assistant is run with its thresholds of time, from which it tells of a conflict, multiplied by
factors: a longer look ahead misses less and disturbs more.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from airhilt.engine_families import ASSISTANTS as ENGINES
from airhilt.engine_families import NONE
from airhilt.sweep.evaluation import ranking, scores
from airhilt.sweep.evaluation.assistants import ASSISTANTS, CONTROLS, shipped_scenarios
from airhilt.sweep.evaluation.preset import Choice, Preset, Results
from airhilt.sweep.evaluation.tables import Cell, Scatter, Table, number, share
from airhilt.sweep.specification import Specification

FACTORS = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Factors of the thresholds; 1 is each assistant as it ships."""
THRESHOLDS = frozenset({"advisory_s", "caution_s", "warning_s", "time_to_go_s"})
"""Settings that say from which time to a conflict on an assistant tells of it."""


def specifications(choice: Choice) -> Mapping[str, Specification]:
    """Return the sweeps of the ranking, two for each assistant and factor."""
    names = [name for name, one in shipped_scenarios().items() if one.nominal_twin is not None]
    settled = {"latency": "fixed"}
    found = {NONE: choice.specification(names, {**settled, "assistant": NONE})}
    for each in (*ASSISTANTS, *CONTROLS):
        for factor, configuration in _configurations(each.name):
            own = {**settled, **configuration}
            for name, sweep in ranking.both_sweeps(choice, each, names, own).items():
                found[_labelled(name, factor)] = sweep
    return found


def _labelled(name: str, factor: float) -> str:
    return name if factor == 1.0 else f"{name}_x{factor:g}"


def _configurations(assistant: str) -> Iterator[tuple[float, dict[str, Any]]]:
    """Yield each factor and the option that sets it; only 1 where there is no threshold."""
    engine, _ = ENGINES.choose(assistant)
    defaults = engine.configured(None).model_dump() if engine.configuration else {}  # type: ignore[union-attr]
    for factor in FACTORS:
        scaled = _scaled(defaults, factor)
        if factor == 1.0:
            yield factor, {}
        elif scaled:
            yield factor, {"assistant_config": scaled}


def _scaled(settings: Mapping[str, Any], factor: float) -> dict[str, Any]:
    """Return the thresholds among settings, and those within them, times a factor."""
    found: dict[str, Any] = {}
    for name, value in settings.items():
        if isinstance(value, Mapping) and (inner := _scaled(value, factor)):
            found[name] = inner
        elif name in THRESHOLDS:
            found[name] = value * factor
    return found


def tables(results: Results) -> Sequence[Table]:
    """Return the points of the curves, and the ranking of the assistants as they ship."""
    tried, nobody = ranking.tried(results.rows), results.rows[NONE]
    lost = {scores.pair_of(row) for row in nobody if row["lost"]}
    rows: list[tuple[Cell, ...]] = []
    for each in (*ASSISTANTS, *CONTROLS):
        for factor in FACTORS:
            own = tried.get(_labelled(each.name, factor))
            if own is None:
                continue
            harmful = [row for row in own.conflicts if scores.pair_of(row) in lost]
            missed = share(scores.share_where(harmful, lambda row: not row["warned"]))
            nuisance = number(scores.nuisance_per_hour(own.twins))
            index = number(ranking.youden_index(own, nobody), 2)
            rows.append((each.name, f"{factor:g}", missed, nuisance, index))
    characteristic = Table(
        name="roc",
        title="Missed against nuisance",
        columns=("assistant", "thresholds times", "missed", "nuisance, 1/h", "index"),
        rows=tuple(rows),
        notes=(
            "Missed: share of the runs with harm without an assistant in which nobody was warned. "
            "Nuisance: alerts in an hour of the nominal twins. Thresholds: the times to a conflict "
            "from which an assistant tells of it; one without any has one point. In brackets, and "
            "as bands: 95 % interval.",
        ),
        figure=Scatter(x="nuisance, 1/h", y="missed", x_scale="symlog"),
    )
    as_shipped = {each.name: tried[each.name] for each in (*ASSISTANTS, *CONTROLS)
                  if each.name in tried}  # fmt: skip
    return characteristic, ranking.table(as_shipped, nobody)


PRESET = Preset(
    name="roc",
    summary="missed against nuisance over the thresholds of every assistant",
    seeds=3,
    specifications=specifications,
    tables=tables,
)
