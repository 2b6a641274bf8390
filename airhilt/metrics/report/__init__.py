"""The report of a run: one HTML file that opens offline."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path

from airhilt.errors import RunFolderError
from airhilt.metrics.report.data import gather
from airhilt.record import RunFolder

PLACEHOLDER = "/*REPORT-DATA*/null"


def render(folder: RunFolder) -> str:
    """Return the page of a run, from whatever its folder holds.

    Raises
    ------
    RunFolderError
        The folder cannot be read.
    """
    template = resources.files(__package__).joinpath("page.html").read_text(encoding="utf-8")
    data = json.dumps(gather(folder), separators=(",", ":"), allow_nan=False)
    # Inside a script element nothing but these can end it or begin a comment.
    safe = data.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
    return template.replace(PLACEHOLDER, safe)


def write_report(run_folder: Path, out: Path | None = None) -> Path:
    """Write the page of a run to a file, or into its folder, and return where it is.

    Raises
    ------
    RunFolderError
        There is no run, or the file cannot be written.
    """
    folder = RunFolder.open(run_folder)
    html = render(folder)
    if out is None:
        folder.write_report(html)
        return folder.report_path
    try:
        out.write_text(html + "\n", encoding="utf-8")
    except OSError as error:
        raise RunFolderError(
            f"{out}: cannot be written: {error.strerror}; choose another file with --out"
        ) from None
    return out
