"""Scenarios that a station offers: those that ship, and those in folders that it was told of."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from airhilt.errors import ScenarioError, StationError
from airhilt.host import library
from airhilt.host.text import readable
from airhilt.scenario import loading
from airhilt.scenario.seats import possible_seats

Json = dict[str, Any]
MOST_FILES = 500
"""Largest number of files of a folder that are offered."""


class ScenarioChoices:
    """Finds scenarios by the names under which they are offered, and no others.

    Parameters
    ----------
    folders
        Folders whose JSON files are offered, with those in folders below them.

    Raises
    ------
    StationError
        There is no such folder.
    """

    def __init__(self, folders: Sequence[Path] = ()) -> None:
        for folder in folders:
            if not folder.is_dir():
                raise StationError(f"--scenarios {folder}: no such folder")
        self._folders = [folder.resolve() for folder in folders]

    def path(self, name: str) -> Path:
        """Return the file of a scenario that is offered.

        Raises
        ------
        StationError
            It is not offered.
        """
        path = self._paths().get(name)
        if path is None:
            raise StationError(
                f"scenario {readable(name)!r}: not offered here; expected one of the list. Own "
                "scenarios need `airhilt station --scenarios DIR`"
            )
        return path

    def rows(self) -> list[Json]:
        """Return name, title and seats of each scenario; of one that is wrong, why."""
        return [{"id": name, **_row(path)} for name, path in self._paths().items()]

    def _paths(self) -> dict[str, Path]:
        shipped = {name: library.find("scenarios", name) for name in library.names("scenarios")}
        own: dict[str, Path] = {}
        for folder in self._folders:
            for path in sorted(folder.rglob("*.json"))[:MOST_FILES]:
                # A link may lead out of the folder.
                if path.is_file() and path.resolve().is_relative_to(folder):
                    own[f"{folder.name}/{path.relative_to(folder).as_posix()}"] = path
        return shipped | own


def _row(path: Path) -> Json:
    try:
        scenario = loading.read(path)
    except (OSError, ScenarioError) as error:
        return {"title": path.stem, "problem": readable(str(error))}
    return {
        "title": readable(scenario.title or scenario.name),
        "description": readable(scenario.description),
        "family": readable(scenario.family or ""),
        "seats": [readable(seat) for seat in possible_seats(scenario)],
        "controller": readable(scenario.radio.controller),
        "has_cameras": bool(scenario.cameras),
        "duration_s": scenario.duration_s,
        "visibility_m": scenario.weather.visibility_m,
        "snr_db": scenario.radio.snr_db,
        "equipment": [readable(name) for name in scenario.equipment],
    }
