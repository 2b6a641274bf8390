"""Debriefs that a station has opened: each is a process of its own, which ends with the station."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections import OrderedDict
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import IO, Any

from airhilt.errors import RunFolderError, StationError
from airhilt.host.text import LONGEST_LINE, readable
from airhilt.record import RunFolder
from airhilt.station.started_runs import StartedRuns, is_address

MOST_OPEN = 4
"""Largest number of debriefs; the one that was opened first is closed for the next."""
MOST_RUNS = 200
"""Largest number of run folders that are listed: the newest."""


class Debriefs:
    """Lists the run folders in a folder, and opens debriefs of them.

    Parameters
    ----------
    started
        Runs that were started in the folder; debriefs have pages as these have.
    """

    def __init__(self, started: StartedRuns) -> None:
        self._folder = started.folder
        self._runs = started
        self._open: OrderedDict[tuple[str, ...], tuple[subprocess.Popen[str], str]] = OrderedDict()
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

    def open(self, names: tuple[str, ...]) -> str:
        """Return the address of the debrief of one run, or of two side by side.

        Raises
        ------
        StationError
            There is no such run here, it cannot be shown, or people have seats in it now: a debrief
            shows the truth.
        """
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
        with self._lock:
            if names in self._open and self._open[names][0].poll() is None:
                return self._open[names][1]
            process, url = self._started(names)
            self._open[names] = process, url
            while len(self._open) > MOST_OPEN:
                _end(self._open.popitem(last=False)[1][0])
        return url

    def _goes_on(self, row: dict[str, Any]) -> bool:
        """Return true if a run has not ended; its folder tells where its process is not known."""
        state = self._runs.state_of(row["name"])
        return row["phase"] == "running" if state is None else state != "ended"

    def _started(self, names: tuple[str, ...]) -> tuple[subprocess.Popen[str], str]:
        folders = [str(self._folder / name) for name in names]
        process = subprocess.Popen(  # noqa: S603 - our own command
            [sys.executable, "-m", "airhilt", "view", *self._runs.page, "--", *folders],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        assert process.stdout is not None
        said = ""
        for line in process.stdout:
            if is_address(line):
                threading.Thread(target=_drain, args=(process.stdout,), daemon=True).start()
                return process, line.split()[0]
            said = line.removeprefix("airhilt: ").strip() or said
        process.wait()
        raise StationError(f"the debrief ended: {readable(said, LONGEST_LINE)}")

    def close(self) -> None:
        """End all debriefs."""
        with self._lock:
            for process, _ in self._open.values():
                _end(process)
            self._open.clear()


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


def _drain(printed: IO[str]) -> None:
    """Read away what a process prints until its end, so that it never waits for that."""
    with printed:
        printed.read()


def _end(process: subprocess.Popen[str]) -> None:
    process.terminate()
    process.wait()
