"""The sections of the page of a sweep: one Python module each, with its template and its script.

A section ``failures`` is the module ``failures.py`` with its `SECTION`, the Jinja template
``failures.html`` and, if anything is to be drawn, the script ``failures.js``, as on the page of a
run. A section of another package is found by an entry point of ``airhilt.sweep_sections``.

The template sees `sweep`, the data that all sections share, `data`, the section's own data, and
`figures`, the markup of the figures by name. The script is the body of a function of `data`, and
returns what is drawn: ``{ draw() { ... }, fit() { ... } }``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pydantic.dataclasses import dataclass

from airhilt.errors import AirhiltError
from airhilt.plugins import Family
from airhilt.report.figures import Figures
from airhilt.report.page_section import PageSection, load_members
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


def load_sections() -> tuple[list[SweepSection], list[str]]:
    """Return all sections in their order, and a sentence on each that cannot be shown."""
    return load_members(FAMILY)
