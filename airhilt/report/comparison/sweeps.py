"""Two sides of many runs, paired by everything but what differs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from airhilt.errors import AirhiltError
from airhilt.metrics.estimates import Estimate, clusters_of
from airhilt.metrics.measures import HOUR_S, MEASURES, Measure
from airhilt.metrics.paired import McNemar, mcnemar, mean_difference, share_difference
from airhilt.report.sweeps.data import families_of

if TYPE_CHECKING:
    from pandas import DataFrame, Series

Json = dict[str, Any]

ALWAYS = ("scenario", "seed")
"""Columns that the two runs of a pair always share."""


@dataclass(frozen=True)
class Side:
    """One side of a comparison: finished runs of a sweep, and the columns that are parameters."""

    name: str
    runs: DataFrame
    parameters: tuple[str, ...]


@dataclass(frozen=True)
class MeasureDifference:
    """One measure on both sides, over the pairs in which both have a value."""

    measure: Measure
    first: Estimate
    second: Estimate
    difference: Estimate
    """Mean of second less first."""
    test: McNemar | None
    """McNemar's test, None for what is no share."""
    one_sided: int
    """Pairs in which only one of the two has a value; they are left out."""

    def as_json(self) -> Json:
        """Return the numbers by name."""
        return {
            "measure": self.measure.name,
            "title": self.measure.title,
            "unit": self.measure.unit,
            "first": asdict(self.first),
            "second": asdict(self.second),
            "difference": asdict(self.difference),
            "mcnemar": None if self.test is None else asdict(self.test),
            "one_sided": self.one_sided,
        }


@dataclass(frozen=True)
class SweepComparison:
    """Two sides, what was paired, and what differs."""

    first: str
    second: str
    paired_by: tuple[str, ...]
    """Columns that the two runs of a pair share."""
    differing: dict[str, tuple[str, str]]
    """Columns in which the sides differ as a whole, with the value of each."""
    pairs: int
    clusters: int
    """Number of scenarios that the pairs are of, of seeds if there is one scenario. Pairs of one
    cluster depend on each other."""
    without_partner: tuple[int, int]
    """Number of runs of each side without a partner."""
    families: dict[str, list[MeasureDifference]]
    """The differences by family; first of all families if there are more."""
    kind: ClassVar = "sweeps"

    def as_json(self) -> Json:
        """Return the comparison for scripts."""
        return {
            "kind": self.kind,
            **vars(self),
            "families": {
                name: [each.as_json() for each in found] for name, found in self.families.items()
            },
        }


def compare_sides(first: Side, second: Side) -> SweepComparison:
    """Return the differences of two sides.

    It raises `AirhiltError` if they have no runs in common, or a run of one has several partners.
    """
    differing = dict(_differing(first, second))
    shared = [name for name in _settings(first) if name in _settings(second)]
    by = [*ALWAYS, *(name for name in shared if name not in differing)]
    for side, other in ((first, second), (second, first)):
        _require_unique(side, by, other)
    one, other = (_comparable(side.runs, by) for side in (first, second))
    pairs = one.merge(other, on=by, suffixes=("_first", "_second"))
    if pairs.empty:
        raise AirhiltError(
            f"{first.name}, {second.name}: no run of the one has a partner in the other; expected "
            f"runs with the same {', '.join(by)}"
        )
    return SweepComparison(
        first=first.name,
        second=second.name,
        paired_by=tuple(by),
        differing=differing,
        pairs=len(pairs),
        clusters=len(
            np.unique(clusters_of(pairs["scenario"].to_numpy(), pairs["seed"].to_numpy()))
        ),
        without_partner=(len(first.runs) - len(pairs), len(second.runs) - len(pairs)),
        families=_by_family(
            first.runs.iloc[pairs["row_first"]].reset_index(drop=True),
            second.runs.iloc[pairs["row_second"]].reset_index(drop=True),
        ),
    )


def _comparable(runs: DataFrame, by: list[str]) -> DataFrame:
    """Return the columns to pair by, of one type on either side, and the number of each row.

    A parameter that only one side leaves to the scenario, or gives as a text, has another there.
    """
    columns = {name: runs[name].astype(object).where(runs[name].notna(), None) for name in by}
    return runs[[]].assign(**columns, row=range(len(runs)))


def _settings(side: Side) -> tuple[str, ...]:
    return ("assistant", *side.parameters)


def _differing(first: Side, second: Side) -> Iterator[tuple[str, tuple[str, str]]]:
    for name in dict.fromkeys((*_settings(first), *_settings(second))):
        values = [_only(side, name) for side in (first, second)]
        if None not in values and values[0] != values[1]:
            yield name, (str(values[0]), str(values[1]))


def _only(side: Side, name: str) -> str | None:
    """Return the one value that a column has on a side, None if it has several."""
    if name not in _settings(side):
        return "not given"
    values = side.runs[name].astype(object).where(side.runs[name].notna(), "not given").unique()
    return str(values[0]) if len(values) == 1 else None


def _require_unique(side: Side, by: list[str], other: Side) -> None:
    """Refuse runs of a side that are the same but for what the other side does not have."""
    if not side.runs.duplicated(by).any():
        return
    several = [name for name in _settings(side) if name not in by and side.runs[name].nunique() > 1]
    raise AirhiltError(
        f"{side.name}: several runs would have the same partner in {other.name}: they differ in "
        f"{', '.join(several) or 'nothing that is known'}, which {other.name} does not have"
    )


def _by_family(first: DataFrame, second: DataFrame) -> dict[str, list[MeasureDifference]]:
    names = families_of(first)
    groups = {str(name): rows for name, rows in names.groupby(names, sort=True).groups.items()}
    whole = {"all": names.index, **groups} if len(groups) > 1 else groups
    return {
        name: [
            found
            for each in MEASURES
            if (found := _difference(each, first.loc[rows], second.loc[rows])) is not None
        ]
        for name, rows in whole.items()
    }


def _difference(measure: Measure, first: DataFrame, second: DataFrame) -> MeasureDifference | None:
    """Return one measure over pairs of rows, None if no run has a value of it."""
    if measure.only_nominal:
        nominal = first.get("nominal", first["seed"].isna()).fillna(False).astype(bool)
        first, second = first[nominal], second[nominal]
    ones, others = _values(measure, first), _values(measure, second)
    both = (ones.notna() & others.notna()).to_numpy(dtype=np.bool_)
    either = int((ones.notna() | others.notna()).sum())
    if not either:
        return None
    first, second = first[both], second[both]
    before, after = (values[both].to_numpy(dtype=np.float64) for values in (ones, others))
    is_share = measure.kind == "share"
    clusters = clusters_of(first["scenario"].to_numpy(), first["seed"].to_numpy())
    difference = (
        share_difference(before > 0, after > 0, clusters)
        if is_share
        else mean_difference(before, after, clusters)
    )
    return MeasureDifference(
        measure=measure,
        first=measure.estimate(first),
        second=measure.estimate(second),
        difference=difference.times(100.0 if measure.unit == "%" else 1.0),
        test=mcnemar(before > 0, after > 0, clusters) if is_share else None,
        one_sided=either - int(both.sum()),
    )


def _values(measure: Measure, runs: DataFrame) -> Series:
    if measure.column not in runs:
        return runs["seed"].where(False).astype("Float64")
    values = runs[measure.column].astype("Float64")
    return values / (runs["duration_s"] / HOUR_S) if measure.kind == "per_hour" else values
