"""The page of a run."""

from __future__ import annotations

from pathlib import Path

from airhilt.errors import RunFolderError
from airhilt.host.files import replace_file
from airhilt.host.text import readable
from airhilt.record import Run, open_run
from airhilt.record.damage import Notice, untold
from airhilt.report.assembly import Assembly
from airhilt.report.data import read_run
from airhilt.report.sections import GuardedContent, load_sections

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
    """Write the page of a run, by default as ``report.html`` in its folder.

    Parameters
    ----------
    run_folder
        Folder of a run that has finished, was stopped, was killed or is still going on.
    out
        File to write instead.
    notice
        Is told what is damaged; the page says it too.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    RunFolderError
        There is no run, its ``run.json`` is damaged, or the page cannot be written.
    """
    run = open_run(run_folder, notice)
    folder = run.folder
    html = render(run, out or folder.report_path)
    if out is None:
        folder.write_report(html)
        return folder.report_path
    try:
        replace_file(out, f"{html}\n".encode())
    except OSError as error:
        raise RunFolderError(f"{out}: cannot be written: {error.strerror}") from None
    return out


def render(recorded: Run, page: Path) -> str:
    """Return the page of a run as HTML; ``page`` is the file that it will be."""
    sections, problems = load_sections()
    contents = [GuardedContent(section, recorded.folder) for section in sections]
    run = read_run(recorded, page, contents)
    own = {content.section.name: content.as_json(run) for content in contents}
    problems += [note for content in contents for note in content.notes]
    run.notes.extend(map(readable, problems))
    whole = [content.section for content in contents if content.is_whole]
    data = run.as_json() | {"sections": own}
    return Assembly("run", "AIRHILT run report", SHARED, whole, data).page()
