"""The reactions of the people of a run as a table: one row for each advisory at each seat."""

from __future__ import annotations

import csv
from pathlib import Path

from airhilt.errors import RunFolderError, disk_failed
from airhilt.metrics.summary import PersonReaction
from airhilt.record import RunFolder

COLUMNS = ("run", "seat", *PersonReaction.model_fields)


def write_people_csv(folder: RunFolder, path: Path) -> None:
    """Write the reactions of a run; without any, the file has its head alone.

    Raises
    ------
    RunFolderError
        There is no summary, or the file cannot be written.
    """
    summary = folder.summary()
    if summary is None:
        raise RunFolderError(f"{folder.path}: no summary.json; expected a run that has ended")
    try:
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS, extrasaction="ignore")
            writer.writeheader()
            for person in summary.get("people", ()):
                for reaction in person["reactions"]:
                    writer.writerow({"run": folder.path.name, "seat": person["seat"], **reaction})
    except OSError as error:
        raise disk_failed(str(path), error) from None
