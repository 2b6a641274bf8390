"""The page of a run."""

from __future__ import annotations

from pathlib import Path

from airhilt.host.text import readable
from airhilt.record import Run, open_run
from airhilt.record.damage import Notice, untold
from airhilt.report.assembly import assemble, write_page
from airhilt.report.data import read_run
from airhilt.report.page_section import load_members
from airhilt.report.sections import FAMILY, GuardedContent

SHARED = (
    "page",
    "words",
    "run",
    "series",
    "tracks",
    "events",
    "charts",
    "clock",
    "symbols",
    "timelines",
    "tables",
    "airport",
)
"""Scripts that all sections may use, in the order in which they build on each other."""


def write_report(run_folder: Path, out: Path | None = None, notice: Notice = untold) -> Path:
    """Write the page of a run, by default as ``report.html`` in its folder, and return its path.

    The run has finished, was stopped, was killed or is still going on. The notice is told what is
    damaged; the page says it too. It raises `RunFolderError` if there is no run, its ``run.json``
    is damaged, or the page cannot be written.
    """
    run = open_run(run_folder, notice)
    page = out or run.paths.report_path
    write_page(page, render(run, page))
    return page


def render(recorded: Run, page: Path) -> str:
    """Return the page of a run as HTML; ``page`` is the file that it will be."""
    sections, problems = load_members(FAMILY)
    contents = [GuardedContent(section, recorded.paths) for section in sections]
    run = read_run(recorded, page, contents)
    own = {content.section.name: content.as_json(run) for content in contents}
    problems += [note for content in contents for note in content.notes]
    run.notes.extend(map(readable, problems))
    whole = [content.section for content in contents if content.is_whole]
    data = run.as_json() | {"sections": own}
    return assemble("run", "AIRHILT run report", SHARED, whole, data)
