"""Two runs: what differs in what was asked for, in the metrics, and in what happened."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

from airhilt.errors import AirhiltError
from airhilt.host.text import readable
from airhilt.metrics.columns import Value, metric_columns, metrics_of
from airhilt.record import Run, RunInfo
from airhilt.report.data import RunData, read_run

Json = dict[str, Any]

MOST_EVENTS = 12
"""Events of each run that are shown from the first difference on."""
MOST_SETTINGS = 40
"""Settings that are shown where the runs differ in more."""
NOT_SETTINGS = frozenset({"out", "quiet", "report"})
"""Options that do not change a run."""


@dataclass(frozen=True)
class MetricDifference:
    """One metric of both runs; the difference is second less first, None for what is no number."""

    name: str
    unit: str
    first: Value
    second: Value
    difference: float | None


@dataclass(frozen=True)
class RunComparison:
    """Two runs."""

    first: str
    second: str
    settings: dict[str, tuple[str, str]]
    """Options that differ: name, and the value of each run."""
    metrics: list[MetricDifference]
    equal_metrics: int
    """Number of metrics that both have with the same value."""
    parted_s: float | None
    """Time of the first event that only one of the runs has, None if all are the same."""
    events: tuple[list[Json], list[Json]]
    """From that time on, the first events of each run."""
    kind: ClassVar = "runs"

    def as_json(self) -> Json:
        """Return the comparison for scripts."""
        return {"kind": self.kind, **asdict(self)}


def compare_runs(first: Run, second: Run, names: tuple[str, str]) -> RunComparison:
    """Return what differs between two runs, which have these names.

    It raises `AirhiltError` if one has no summary, or is damaged.
    """
    runs = [read_run(each, each.paths.report_path, []) for each in (first, second)]
    one, other = (_metrics(run) for run in runs)
    units = {each.name: each.unit for each in metric_columns()}
    parted_s, events = _parting(*(_events(run) for run in runs))
    return RunComparison(
        first=names[0],
        second=names[1],
        settings=dict(_settings(runs[0].info, runs[1].info)),
        metrics=[
            MetricDifference(
                name, units[name], one[name], other[name], _less(other[name], one[name])
            )
            for name in one
            if one[name] != other[name]
        ],
        equal_metrics=sum(one[name] == other[name] is not None for name in one),
        parted_s=parted_s,
        events=events,
    )


def _metrics(run: RunData) -> dict[str, Value]:
    if run.summary is None:
        raise AirhiltError(
            f"{run.folder.summary_path}: not there, or damaged; expected two runs that have ended"
        )
    return metrics_of(run.summary)


def _less(later: Value, earlier: Value) -> float | None:
    numbers = [each for each in (later, earlier) if type(each) in (int, float)]
    return float(numbers[0]) - float(numbers[1]) if len(numbers) == 2 else None  # type: ignore[arg-type]


def _settings(first: RunInfo, second: RunInfo) -> Iterator[tuple[str, tuple[str, str]]]:
    pairs = [_asked(info) for info in (first, second)]
    names = dict.fromkeys((*pairs[0], *pairs[1]))
    differing = [name for name in names if pairs[0].get(name) != pairs[1].get(name)]
    for name in differing[:MOST_SETTINGS]:
        one, other = (readable(str(pair.get(name, "–"))) for pair in pairs)
        yield name, (one, other)
    if len(differing) > MOST_SETTINGS:
        yield f"{len(differing) - MOST_SETTINGS} more", ("…", "…")


def _asked(info: RunInfo) -> Json:
    options = info.options.model_dump(mode="json")
    return {
        **{name: value for name, value in options.items() if name not in NOT_SETTINGS},
        "assistant": info.assistant,
        **dict(_leaves(info.scenario, "scenario")),
        **{f"version of {name}": version for name, version in info.versions.items()},
    }


def _leaves(given: Any, path: str) -> Iterator[tuple[str, Any]]:
    """Yield the single values of a JSON document, each with the names that lead to it."""
    if isinstance(given, dict | list):
        items = given.items() if isinstance(given, dict) else enumerate(given)
        for name, value in items:
            yield from _leaves(value, f"{path}.{name}")
    else:
        yield path, given


def _events(run: RunData) -> list[Json]:
    names = ("kind", "who", "severity", "phase", "state", "text")
    return [
        {"t_s": row["t"], **{name: str(row[name]) for name in names if row.get(name)}}
        for row in run.events.as_json(run.info)
    ]


def _parting(
    first: list[Json], second: list[Json]
) -> tuple[float | None, tuple[list[Json], list[Json]]]:
    """Return when the first difference is, and the first events of both from there on."""
    pairs = zip(first, second, strict=False)
    place = len(list(itertools.takewhile(lambda pair: pair[0] == pair[1], pairs)))
    rest = first[place:], second[place:]
    times = [events[0]["t_s"] for events in rest if events]
    shown = rest[0][:MOST_EVENTS], rest[1][:MOST_EVENTS]
    return min(times, default=None), shown
