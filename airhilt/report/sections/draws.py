"""The perturbations that were drawn for the run, and the actors that ended before it did."""

from __future__ import annotations

from typing import Any

from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section


class Draws(Content):
    """The perturbations with their nominal and realised values."""

    def as_json(self, run: RunData) -> list[dict[str, Any]]:
        """Return one object for each perturbation."""
        return run.info.draws


SECTION = Section("draws", order=90, module=__file__, content=Draws)
