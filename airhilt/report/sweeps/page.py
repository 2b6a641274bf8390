"""The page of a sweep."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from airhilt.host.text import readable
from airhilt.record.damage import Notice, untold
from airhilt.record.sweep_folder import SweepFolder
from airhilt.report.assembly import assemble, write_page
from airhilt.report.figures import Figures
from airhilt.report.page_section import cannot_be_shown, load_members
from airhilt.report.sweeps.data import SweepData, read_sweep_data
from airhilt.report.sweeps.sections import FAMILY, SweepSection

SHARED = ("page", "words")
"""Scripts that all sections may use, in the order in which they build on each other."""


def write_sweep_report(
    sweep_folder: Path,
    out: Path | None = None,
    drawn: Callable[[int], None] = lambda _: None,
    notice: Notice | None = untold,
) -> Path:
    """Write the page of a sweep, by default as ``report.html`` in its folder, and return its path.

    The figures go into ``figures`` of the sweep folder; `drawn` is told their number after each.
    The notice is told what is damaged; the page says so too. It raises `AirhiltError` if there is
    no sweep, a table is damaged, or the page or a figure cannot be written.
    """
    folder = SweepFolder.open(sweep_folder, notice)
    page = out or folder.report_path
    sweep = read_sweep_data(folder, page)
    figures = Figures(drawn)
    html = render(sweep, figures)
    figures.write(folder.figures_path)
    write_page(page, html)
    return page


def render(sweep: SweepData, figures: Figures) -> str:
    """Return the page of a sweep as HTML."""
    sections, problems = load_members(FAMILY)
    shown: list[SweepSection] = []
    own: dict[str, Any] = {}
    for section in sections:
        try:
            data = section.content(sweep, figures) if section.content else {}
            json.dumps(data, allow_nan=False)
        except Exception as error:
            problems.append(cannot_be_shown(section.name, error))
            continue
        if data is not None:
            shown.append(section)
            own[section.name] = data
    title = f"{sweep.folder.path.absolute().name}: AIRHILT sweep"
    notes = [readable(each) for each in (*sweep.notes, *problems)]
    data = {"title": title, "notes": notes, "sections": own}
    return assemble("sweep", title, SHARED, shown, data, figures.markup)
