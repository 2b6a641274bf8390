"""Preset of who is told: crews, the controller, or both, over families and response models.

The assistant is the same, and so are its advisories; their recipients differ, and how people
respond.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import get_args

from pydantic import JsonValue

from airhilt.engine_families import NONE
from airhilt.scenario.models.responses import ResponseModelName
from airhilt.sweep.evaluation import ranking, scores
from airhilt.sweep.evaluation.assistants import CONTROLS, REFERENCE, shipped_scenarios
from airhilt.sweep.evaluation.costs import COSTS, NOTE, costs
from airhilt.sweep.evaluation.harms import harms_table
from airhilt.sweep.evaluation.preset import Choice, Preset, Results, Row
from airhilt.sweep.evaluation.scores import Baselines
from airhilt.sweep.evaluation.tables import Cell, Table, number, share
from airhilt.sweep.specification import Specification

WITHOUT_CAMERAS = "without_cameras"
WITH_CAMERAS = "with_cameras"
NEED_CAMERAS = ("S01C", "S02C")
"""Families in which only cameras show the other party."""
MOST_SEEDS_WITH_CAMERAS = 3
"""Greatest number of seeds of runs with cameras, which take minutes each."""
MOST_SEEDS_OF_TWINS = 5
"""Greatest number of seeds of nominal twins and controls, which only the ranking needs."""
TOLD = ("crew", "controller", "both")
"""Values of the option ``recipients``."""
CREWS = "crews"
MODELS: tuple[str, ...] = get_args(ResponseModelName)
"""Response models: the values of the option ``crews``."""
DEFAULT_MODEL: ResponseModelName = "icao"
EVERYTHING = "all"
"""Name of the rows over all families."""
NOBODY = "nobody"
"""Name of the runs without an assistant."""


def specifications(choice: Choice) -> Mapping[str, Specification]:
    """Return sweeps without an assistant and over who is told, with and without cameras."""
    families = {name: one.family for name, one in shipped_scenarios().items()}
    seen = [name for name, family in families.items() if family in NEED_CAMERAS]
    others = [name for name, family in families.items() if family not in NEED_CAMERAS]
    found = _sweeps(choice, WITHOUT_CAMERAS, others, {"cameras": False})
    found |= _ranked(choice.with_at_most(MOST_SEEDS_OF_TWINS), others)
    if choice.has_cameras:
        found |= _sweeps(choice.with_at_most(MOST_SEEDS_WITH_CAMERAS), WITH_CAMERAS, seen, {})
    return found


def _sweeps(
    choice: Choice, name: str, scenarios: Sequence[str], settled: Mapping[str, bool]
) -> dict[str, Specification]:
    shared: dict[str, JsonValue] = {"latency": "fixed", **settled}
    models = {CREWS: _models(choice)}
    free = {option: value for option, value in choice.options.items() if option != CREWS}
    each = Choice(choice.seeds, free)
    nobody = each.specification(scenarios, {**shared, "assistant": NONE}, models)
    told = each.specification(
        scenarios, {**shared, "assistant": REFERENCE.name}, {"recipients": TOLD, **models}
    )
    return {f"{name}_{NOBODY}": nobody, name: told}


def _ranked(choice: Choice, scenarios: Sequence[str]) -> dict[str, Specification]:
    """Return the sweeps that the ranking needs besides: of nominal twins, and of the controls."""
    settled: dict[str, JsonValue] = {"latency": "fixed", "cameras": False}
    found = ranking.twins(choice, REFERENCE, scenarios, settled, {"recipients": TOLD})
    for control in CONTROLS:
        found |= ranking.both_sweeps(choice, control, scenarios, settled)
    return found


def _models(choice: Choice) -> tuple[str, ...]:
    """Return the response models: the one that the user gives, or all."""
    return (str(choice.options[CREWS]),) if CREWS in choice.options else MODELS


def tables(results: Results) -> Sequence[Table]:
    """Return the comparison by family, and by scenario for each model what became of the runs."""
    nobody, rows = _rows(results, f"_{NOBODY}"), _rows(results, "")
    baselines = {
        model: Baselines.of(_having(nobody, crews=model), ()) for model in _models(results.choice)
    }
    harms = [_harms(nobody, rows, model, baselines[model]) for model in baselines]
    return _families(results, rows, baselines), _ranking(results), *harms


def _ranking(results: Results) -> Table:
    """Return the ranking of whom to tell, with people who respond as they do by default."""
    models = _models(results.choice)
    model = {CREWS: models[0] if len(models) == 1 else DEFAULT_MODEL}
    twins = results.rows[f"{ranking.TWINS}{REFERENCE.name}"]
    told = _having(results.rows[WITHOUT_CAMERAS], **model)
    tried = {
        f"{REFERENCE.name}, {name} told": ranking.Tried(
            scores.with_conflict(_having(told, recipients=name)), _having(twins, recipients=name)
        )
        for name in TOLD
    }
    controls = {
        name: one
        for name, one in ranking.tried(results.rows).items()
        if name in {control.name for control in CONTROLS}
    }
    nobody = _having(results.rows[f"{WITHOUT_CAMERAS}_{NOBODY}"], **model)
    return ranking.table({**tried, **controls}, nobody)


def _rows(results: Results, ending: str) -> list[Row]:
    names = (WITHOUT_CAMERAS, WITH_CAMERAS)
    return [row for name in names for row in results.rows.get(f"{name}{ending}", ())]


def _having(rows: Sequence[Row], **values: str) -> list[Row]:
    return [row for row in rows if all(row[name] == value for name, value in values.items())]


def _harms(nobody: Sequence[Row], rows: Sequence[Row], model: str, baselines: Baselines) -> Table:
    told = {each: _having(rows, crews=model, recipients=each) for each in TOLD}
    table = harms_table({NOBODY: _having(nobody, crews=model), **told}, baselines)
    named = {"name": f"{table.name}_{model}", "title": f"{table.title} ({model})"}
    return table.model_copy(update=named)


def _families(results: Results, rows: Sequence[Row], baselines: Mapping[str, Baselines]) -> Table:
    names = [*sorted({row["family"] for row in rows}), EVERYTHING]
    groups = [
        (name, told, model, own)
        for name, told, model in product(names, TOLD, baselines)
        if (own := _of_family(_having(rows, crews=model, recipients=told), name))
    ]
    return Table(
        name="recipients",
        title="Who is told",
        columns=("family", "told", CREWS, "warned", "avoided", "lead, s", "nuisance, 1/h", *COSTS),
        rows=tuple(
            (name, told, model, *_scores(own, baselines[model]), *costs(own, baselines[model]))
            for name, told, model, own in groups
        ),
        notes=tuple(_notes(results)),
    )


def _of_family(rows: Sequence[Row], family: str) -> list[Row]:
    return [row for row in rows if family in (row["family"], EVERYTHING)]


def _scores(rows: Sequence[Row], baselines: Baselines) -> tuple[Cell, ...]:
    conflicts = scores.with_conflict(rows)
    return (
        share(scores.share(conflicts, "warned")),
        share(scores.avoided(conflicts, baselines)),
        number(scores.mean(conflicts, "lead_before_closest_approach_s"), 0),
        number(scores.nuisance_per_hour(rows)),
    )


def _notes(results: Results) -> Iterator[str]:
    yield (
        f"Assistant: `{REFERENCE.name}`. Told: whom it tells. Crews: how people respond. Avoided: "
        "no harm to the pair, of the runs in which it came to harm without an assistant and with "
        "the same responses. Nuisance: alerts in an hour of nominal traffic. In brackets: 95 % "
        "interval over the scenarios, or over the seeds of one scenario."
    )
    yield NOTE
    needing = " and ".join(NEED_CAMERAS)
    if results.choice.has_cameras:
        yield f"{needing} with cameras, on at most {MOST_SEEDS_WITH_CAMERAS} seeds."
    else:
        yield f"Without cameras, and so without {needing}."


PRESET = Preset(
    name="recipients",
    summary="who is told (crew, controller, both), over all families and response models",
    seeds=3,
    specifications=specifications,
    tables=tables,
)
