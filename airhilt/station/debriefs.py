"""The debriefs that a station has opened, as parts of its own page."""

from __future__ import annotations

import asyncio
import itertools
import threading
from collections.abc import Sequence
from concurrent.futures import Future
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from starlette.routing import Router

from airhilt.errors import RunFolderError, StationError
from airhilt.host.text import readable
from airhilt.record import RunFolder, open_run
from airhilt.record.damage import untold
from airhilt.station.app import recorded_app
from airhilt.station.debrief import Debrief
from airhilt.station.started_runs import StartedRuns

MOST_OPEN = 4
"""Largest number of debriefs; the one that was opened first is closed for the next."""
MOST_RUNS = 200
"""Largest number of run folders that are listed: the newest."""


class Debriefs:
    """Lists the run folders in a folder, and opens debriefs of them.

    Parameters
    ----------
    started
        Runs that were started in the folder.

    Attributes
    ----------
    router
        Application with the pages of the debriefs.
    """

    def __init__(self, started: StartedRuns) -> None:
        self.router = Router()
        self._folder = started.folder
        self._runs = started
        self._open: dict[tuple[str, ...], tuple[str, list[Debrief]]] = {}
        """Path and content, by the names of the runs."""
        self._reading: dict[tuple[str, ...], Future[str]] = {}
        """Paths of those whose runs are still read, by the names of the runs."""
        self._numbers = itertools.count(1)
        self._lock = threading.Lock()

    def rows(self) -> list[dict[str, Any]]:
        """Return what a page shows of the runs, the newest first."""
        found = []
        for path in self._folder.glob("*/run.json"):
            with suppress(OSError):  # One that is being replaced.
                found.append((path.stat().st_mtime_ns, path))
        rows = []
        for written_ns, path in sorted(found, reverse=True)[:MOST_RUNS]:
            with suppress(RunFolderError):
                rows.append(_row(path.parent, written_ns))
        return rows

    async def open(self, names: tuple[str, ...]) -> str:
        """Return the path of the debrief of one run, or of two side by side, below `router`.

        The runs are read in a thread that holds up nothing else, and not the end of the process.

        Raises
        ------
        StationError
            There is no such run here, it cannot be shown, or people have seats in it now: a debrief
            shows the truth.
        """
        await asyncio.to_thread(self._require_shown, names)
        with self._lock:
            if names in self._open:
                return f"{self._open[names][0]}/"
            reading = self._reading.get(names)
            if reading is None:
                reading = self._reading[names] = Future()
                reading.set_running_or_notify_cancel()  # Others may wait for it too.
                threading.Thread(target=self._read, args=(names, reading), daemon=True).start()
        return await asyncio.wrap_future(reading)

    def _require_shown(self, names: tuple[str, ...]) -> None:
        known = {row["name"]: row for row in self.rows()}
        for name in names:
            if name not in known:
                raise StationError(f"run {readable(name)!r}: not in {self._folder}")
            if known[name]["seats"] and self._goes_on(known[name]):
                raise StationError(
                    f"run {readable(name)!r}: goes on, with people at seats, who do not see the "
                    "truth; open its debrief when it has ended, or with airhilt view if it was "
                    "killed"
                )

    def _read(self, names: tuple[str, ...], reading: Future[str]) -> None:
        debriefs: list[Debrief] = []
        try:
            for name in names:
                debriefs.append(Debrief(open_run(self._folder / name, untold)))
            app = recorded_app(debriefs)
        except Exception as error:  # Who waits for it raises it.
            _close(debriefs)
            with self._lock:
                del self._reading[names]
            reading.set_exception(error)
            return
        first: Sequence[Debrief] = ()
        with self._lock:
            path = f"/{next(self._numbers)}"
            self.router.mount(path, app)
            self._open[names] = path, debriefs
            del self._reading[names]
            if len(self._open) > MOST_OPEN:
                del self.router.routes[0]
                first = self._open.pop(next(iter(self._open)))[1]
        reading.set_result(f"{path}/")
        _close(first)

    def _goes_on(self, row: dict[str, Any]) -> bool:
        """Return true if a run has not ended; its folder tells where its process is not known."""
        state = self._runs.state_of(row["name"])
        return row["phase"] == "running" if state is None else state != "ended"

    def close(self) -> None:
        """Close all debriefs."""
        with self._lock:
            opened = [debriefs for _, debriefs in self._open.values()]
        for debriefs in opened:
            _close(debriefs)


@lru_cache(maxsize=2 * MOST_RUNS)
def _row(folder: Path, _written_ns: int) -> dict[str, Any]:
    """Return what a page shows of a run, read again once its record was written again."""
    info = RunFolder.open(folder).info()
    return {
        "name": folder.name,
        "scenario": readable(str(info.scenario.get("name", ""))),
        "seed": info.options.seed,
        "assistant": readable(info.assistant),
        "phase": info.phase,
        "started_at": readable(info.started_at),
        "seats": [readable(seat) for seat in info.options.seat],
    }


def _close(debriefs: Sequence[Debrief]) -> None:
    for debrief in debriefs:
        debrief.close()
