"""The people at seats: what they said and did, and how soon they acted upon advisories."""

from __future__ import annotations

from typing import Any

from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section

Json = dict[str, Any]


class People(Content):
    """The people of the summary."""

    def as_json(self, run: RunData) -> list[Json]:
        """Return one object for each seat."""
        people = () if run.summary is None else run.summary.people
        return [person.model_dump(mode="json") for person in people]


SECTION = Section("people", order=35, module=__file__, content=People)
