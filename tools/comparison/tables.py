"""Tables of a comparison."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from statistics import median

from rich.table import Table

from airhilt.assistant.reference import NO_ASSISTANT
from comparison.rows import Row


def by_family(rows: Sequence[Row]) -> Table:
    """Return how many of the runs that end badly without an assistant each one avoided."""
    table = Table(title="Runs that end badly without an assistant")
    for name in ("family", "assistant", "runs", "avoided", "warned", "time to first warning"):
        table.add_column(name)
    groups: dict[tuple[str, str], list[Row]] = defaultdict(list)
    bad = _bad_without(rows)
    for row in rows:
        if (row.scenario, row.seed) in bad and row.has_conflict:
            groups[row.family, row.assistant].append(row)
    for (family, assistant), own in sorted(groups.items()):
        times_s = [
            row.time_to_first_warning_s for row in own if row.time_to_first_warning_s is not None
        ]
        table.add_row(
            family,
            assistant,
            str(len(own)),
            str(sum(row.avoided is True for row in own)),
            str(sum(row.is_warned for row in own)),
            f"median {median(times_s):.1f} s" if times_s else "-",
        )
    return table


def nuisances(rows: Sequence[Row]) -> Table:
    """Return in how many nominal runs each assistant raised a nuisance alert."""
    table = Table(title="Nominal runs")
    for name in ("assistant", "runs", "with a nuisance alert", "alerts"):
        table.add_column(name)
    groups: dict[str, list[Row]] = defaultdict(list)
    for row in rows:
        if not row.has_conflict:
            groups[row.assistant].append(row)
    for assistant, own in sorted(groups.items()):
        alerts = [f"{row.scenario} {row.seed}: {what}" for row in own for what in row.nuisances]
        with_alerts = sum(bool(row.nuisance_alerts) for row in own)
        table.add_row(assistant, str(len(own)), str(with_alerts), "\n".join(alerts))
    return table


def not_avoided(rows: Sequence[Row]) -> Table:
    """Return the runs that ended badly in spite of an assistant."""
    table = Table(title="Not avoided")
    for name in ("scenario", "seed", "assistant", "what came about", "time to first warning"):
        table.add_column(name)
    bad = _bad_without(rows)
    for row in rows:
        is_meant = row.assistant != NO_ASSISTANT and row.has_conflict
        if not is_meant or row.avoided is True or (row.scenario, row.seed) not in bad:
            continue
        time_s = row.time_to_first_warning_s
        table.add_row(
            row.scenario,
            str(row.seed),
            row.assistant,
            _what(row),
            "never" if time_s is None else f"{time_s:.1f} s",
        )
    return table


def _bad_without(rows: Sequence[Row]) -> set[tuple[str, int]]:
    """Return the runs in which the annotated pair comes to harm without an assistant."""
    return {
        (row.scenario, row.seed)
        for row in rows
        if row.assistant == NO_ASSISTANT and row.avoided is False
    }


def _what(row: Row) -> str:
    if row.collision:
        return "collision"
    if row.nmac:
        return "NMAC"
    if row.runway_incursion_category in ("accident", "A", "B"):
        return f"incursion of category {row.runway_incursion_category}"
    return "loss of separation" if row.loss_of_separation else "warned of nothing"
