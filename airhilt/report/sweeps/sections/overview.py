"""The table of assistants: what came of all their runs, and of those of each family."""

from __future__ import annotations

from typing import Any

from airhilt.metrics.measures import MEASURES
from airhilt.report.figures import Figures
from airhilt.report.sweeps.data import SweepData
from airhilt.report.sweeps.sections import SweepSection
from airhilt.report.sweeps.words import estimate


def content(sweep: SweepData, figures: Figures) -> dict[str, Any] | None:  # noqa: ARG001
    """Return a row for each family and assistant, with the measures that any of them has."""
    groups = [
        (family, assistant, runs[runs["assistant"] == assistant])
        for family, runs in sweep.families()
        for assistant in sweep.assistants
    ]
    rows = [(*group, [each.estimate(group[2]) for each in MEASURES]) for group in groups]
    rows = [row for row in rows if len(row[2])]
    if not rows:
        return None
    shown = [i for i in range(len(MEASURES)) if any(row[3][i].n for row in rows)]
    return {
        "heads": [{"title": MEASURES[i].title, "unit": MEASURES[i].unit} for i in shown],
        "rows": [
            {
                "family": family,
                "assistant": assistant,
                "runs": len(runs),
                "failed": sweep.failed(family, assistant),
                "cells": [
                    {"text": text, "interval": interval, "n": found[i].n}
                    for i in shown
                    for text, interval in [estimate(found[i], MEASURES[i].unit)]
                ],
            }
            for family, assistant, runs, found in rows
        ],
    }


SECTION = SweepSection("overview", order=20, module=__file__, content=content)
