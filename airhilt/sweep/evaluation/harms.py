"""What became of the runs in which the pair came to harm without an assistant."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence

from airhilt.sweep.evaluation import scores
from airhilt.sweep.evaluation.preset import Row
from airhilt.sweep.evaluation.scores import Baselines
from airhilt.sweep.evaluation.tables import NOTHING, Table


def harms_table(groups: Mapping[str, Sequence[Row]], baselines: Baselines) -> Table:
    """Return a table of harms by scenario, with a column for each group of runs."""
    counts = {name: _harm_counts(rows, baselines) for name, rows in groups.items()}
    return Table(
        name="harms",
        title="What is avoided, by scenario",
        columns=("scenario", *groups),
        rows=tuple(
            (scenario, *(counts[name].get(scenario, NOTHING) for name in groups))
            for scenario in sorted({scenario for scenario, _ in baselines.lost})
        ),
        notes=(
            "Number of runs by the worst that they came to, of those in which the pair came to "
            "harm without an assistant. An incursion is harm if its category is A or B.",
        ),
    )


def _harm_counts(rows: Sequence[Row], baselines: Baselines) -> Mapping[str, str]:
    """Return the worst that runs came to, with their numbers, by scenario."""
    harms: defaultdict[str, Counter[str]] = defaultdict(Counter)
    for row in rows:
        if scores.pair_of(row) in baselines.lost:
            harms[row["scenario"]][scores.harm_of(row)] += 1
    return {
        scenario: ", ".join(f"{harm} {count}" for harm, count in sorted(harms[scenario].items()))
        for scenario in sorted(harms)
    }
