"""Models as flat rows: summaries of a run or of a person, one call of a person, messages.

A row has a column for each single value, by rule from the models. A field of a model within another
has the names of both, such as ``radio_wer``. A list of texts is one text; other lists have no
column. Every run has the same columns.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from airhilt.messages import HearingTruth, Modality
from airhilt.metrics.derived import DERIVED, DERIVED_OF_PEOPLE, Derived
from airhilt.metrics.latencies import STAGES
from airhilt.metrics.summary import PersonCall, PersonReaction, PersonSummary, Summary
from airhilt.options import MODALITIES

Kind = Literal["string", "bool", "int64", "float64"]
"""Type of a column, by the name that Apache Arrow has for it."""
Value = str | bool | int | float | None

NOT_METRICS = frozenset({
    "scenario", "seed", "assistant", "conflict_actors", "latency_sources", "too_slow",
    "real_time_factor", "cpu_s",
})  # fmt: skip
"""Fields of the summary that are no result: what the run was, and what depends on the machine."""
NOT_OF_A_PERSON = frozenset({"seat", "workload"})
"""Fields of a person that have no column: the name of the seat, and answers, which tables have of
their own."""
KNOWN_KEYS: Mapping[str, tuple[str, ...]] = {
    "latencies": STAGES,
    "evidence": MODALITIES,
    "modalities": get_args(Modality),
    "hearing": get_args(HearingTruth.model_fields["outcome"].annotation),
}
"""Keys of the fields that are dictionaries; other keys, such as a worker's own, have no column."""
BETWEEN_TEXTS = "; "
"""Put between the texts of a list in one column."""
UNITS = {
    "_per_minute": "1/min",
    "_per_hour": "1/h",
    "_db": "dB",
    "_px": "px",
    "_ft_s": "ft s",
    "_nm_s": "NM s",
    "_m_s": "m/s",
    "_m": "m",
    "_s": "s",
    "_deg": "deg",
    "_degrees": "deg",
    "_ft": "ft",
    "_kt": "kt",
    "_fpm": "ft/min",
    "_khz": "kHz",
}
"""Unit by the end of a name; any other number has the unit 1: a count or a share."""


@dataclass(frozen=True)
class Column:
    """One column of a table of runs, whose values may be null."""

    name: str
    type: Kind
    unit: str
    """Unit of the values: 1 for counts and shares, empty for texts and for true and false."""
    description: str
    path: tuple[str, ...] = ()
    """Keys under which ``summary.json`` has the value; empty if it is worked out from others."""


class FlatRow:
    """The columns of a model, and their values.

    Each single value of the model has a column, but for the fields left out. Metrics that are
    derived from others come last.
    """

    def __init__(
        self,
        model: type[BaseModel],
        derived: Sequence[Derived] = (),
        left_out: Collection[str] = (),
    ) -> None:
        self._model = model
        self._derived = derived
        self._left_out = left_out

    @cached_property
    def columns(self) -> tuple[Column, ...]:
        """Columns, in their order."""
        own = _of_model(self._model, (), self._left_out)
        derived = (column_of(one.name, one.type, one.description) for one in self._derived)
        return (*own, *derived)

    def values(self, content: Mapping[str, Any]) -> dict[str, Value]:
        """Return the values by the names of their columns, of a model as JSON has it.

        What the content does not have is null. It raises TypeError or ValueError for a value of
        another type.
        """
        own = {each.name: _at(content, each) for each in self.columns if each.path}
        return own | {each.name: each.value(content) for each in self._derived}


def column_of(name: str, kind: Kind, description: str, path: tuple[str, ...] = ()) -> Column:
    """Return a column, with the unit that its name ends with."""
    is_number = kind not in ("string", "bool")
    unit = next((unit for end, unit in UNITS.items() if name.endswith(end)), "1")
    return Column(name, kind, unit if is_number else "", description, path)


def _of_model(
    model: type[BaseModel], path: tuple[str, ...], left_out: Collection[str] = ()
) -> Iterator[Column]:
    for name, info in model.model_fields.items():
        if name in left_out:
            continue
        annotation, own = _bare(info.annotation), (*path, name)
        if get_origin(annotation) is dict:
            inner = _bare(get_args(annotation)[1])
            for key in KNOWN_KEYS.get(name, ()):
                yield from _of_type(inner, info, (*own, key), context=(*own, key))
        else:
            yield from _of_type(annotation, info, own, context=path)


def _of_type(
    annotation: Any, info: FieldInfo, path: tuple[str, ...], context: tuple[str, ...]
) -> Iterator[Column]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield from _of_model(annotation, path)
    elif get_origin(annotation) is Union:
        members = (each for model in get_args(annotation) for each in _of_model(model, path))
        yield from {each.name: each for each in members}.values()
    elif (kind := _kind(annotation)) is not None:
        words = (" ".join(context).replace("_", " "), info.description)
        yield column_of("_".join(path), kind, ": ".join(filter(None, words)), path)


def _bare(annotation: Any) -> Any:
    """Return a type without ``None`` and annotations; one of several models is their union."""
    if get_origin(annotation) is Annotated:
        return _bare(get_args(annotation)[0])
    if get_origin(annotation) in (Union, types.UnionType):
        first, *others = (each for each in get_args(annotation) if each is not types.NoneType)
        return Union[first, *others] if others else _bare(first)
    return annotation


def _kind(annotation: Any) -> Kind | None:
    """Return the type of a column, None for what has no column."""
    is_type = isinstance(annotation, type)
    if get_origin(annotation) is tuple and get_args(annotation) == (str, ...):
        return "string"
    if get_origin(annotation) is Literal or (is_type and issubclass(annotation, str)):
        return "string"
    kinds: dict[type, Kind] = {bool: "bool", int: "int64", float: "float64"}
    return kinds.get(annotation) if is_type else None


def _text(value: Any) -> str:
    return BETWEEN_TEXTS.join(value) if isinstance(value, list) else str(value)


CONVERT: Mapping[Kind, Callable[[Any], Value]] = {
    "string": _text,
    "bool": bool,
    "int64": int,
    "float64": float,
}
"""Makes the value of a column from what JSON has."""


def _at(content: Mapping[str, Any], column: Column) -> Value:
    found: Any = content
    for key in column.path:
        found = None if found is None else found.get(key)
    return None if found is None else CONVERT[column.type](found)


OF_RUNS = FlatRow(Summary, DERIVED, NOT_METRICS)
"""Row of the metrics of a run."""
OF_PEOPLE = FlatRow(PersonSummary, DERIVED_OF_PEOPLE, NOT_OF_A_PERSON)
"""Row of the totals of a person at a seat."""
OF_REACTIONS = FlatRow(PersonReaction)
"""Row of a reaction of a person."""
OF_CALLS = FlatRow(PersonCall)
"""Row of a call of a person."""


def metric_columns() -> tuple[Column, ...]:
    """Return the columns of the metrics of a run; they are the same for every run."""
    return OF_RUNS.columns


def metrics_of(summary: Summary | Mapping[str, Any]) -> dict[str, Value]:
    """Return the metrics of a run, of its summary or the content of its ``summary.json``.

    They are by the names of their columns. It raises what `FlatRow.values` does.
    """
    content = summary.model_dump(mode="json") if isinstance(summary, Summary) else summary
    return OF_RUNS.values(content)
