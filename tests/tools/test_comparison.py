"""The tables that compare assistants count the runs that are bad for the annotated pair."""

from __future__ import annotations

from typing import Any

from rich.table import Table

from comparison.rows import Row
from comparison.tables import by_family, not_avoided


def row(assistant: str, avoided: bool | None, seed: int = 0, **other: Any) -> Row:
    known: dict[str, Any] = {
        "scenario": "s02b_bird_strike", "family": "S02B", "outcome": "finished", "cameras": False,
        "speech": False, "latency": "fixed", "has_conflict": True, "is_warned": assistant != "none",
        "loss_of_separation": False, "nmac": False, "collision": True, "nuisances": [],
        "runway_incursion_category": None, "time_to_first_warning_s": None, "nuisance_alerts": 0,
    }  # fmt: skip
    return Row(assistant=assistant, avoided=avoided, seed=seed, **(known | other))


def cells(table: Table, column: int) -> list[Any]:
    return list(table.columns[column].cells)


def test_a_collision_with_birds_makes_no_run_bad_in_which_the_pair_stays_apart() -> None:
    rows = [row("none", None), row("reference", True)]
    assert by_family(rows).row_count == 0
    assert not_avoided(rows).row_count == 0


def test_a_run_is_counted_where_the_pair_comes_to_harm_without_an_assistant() -> None:
    rows = [row("none", False), row("reference", True)]
    rows += [row("none", False, seed=1), row("reference", False, seed=1)]
    table = by_family(rows)
    assert (cells(table, 1), cells(table, 2), cells(table, 3)) == (
        ["none", "reference"], ["2", "2"], ["0", "1"]
    )  # fmt: skip
    assert cells(not_avoided(rows), 1) == ["1"]
