"""The sections of the page of a sweep: one Python module each, with its template and its script.

They are as those of the page of a run; `figures` in a template is the markup of the figures by
name. One of another package is found by an entry point of ``airhilt.sweep_sections``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pydantic.dataclasses import dataclass

from airhilt.errors import AirhiltError
from airhilt.plugins import Family
from airhilt.report.figures import Figures
from airhilt.report.page_section import PageSection
from airhilt.report.sweeps.data import SweepData

Content = Callable[[SweepData, Figures], Any]


@dataclass(frozen=True)
class SweepSection(PageSection):
    """One section of the page of a sweep.

    Its content returns the section's data from a sweep, and draws its figures. A section whose data
    is None is left out.
    """

    content: Content | None = None


FAMILY = Family(
    "sweep section", "airhilt.sweep_sections", __name__, "SECTION", SweepSection, AirhiltError
)
