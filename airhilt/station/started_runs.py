"""Runs that a station has started: each is a process of its own, and goes on without the station.

What is known of each is in a file beside the run folders, so that a station that is started again
finds the runs that go on.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal

import psutil
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from airhilt.errors import StationError
from airhilt.host.files import make_folder, open_inside, read_inside, replace_file
from airhilt.host.text import LONGEST_LINE, readable
from airhilt.options import Options, arguments_of
from airhilt.scenario.seats import seats_of
from airhilt.world.loading import load

KEPT = ".station"
"""Folder, among the run folders, of what is known of runs that were started."""
MOST_AT_A_TIME = 4
"""Largest number of runs that go on at a time."""
LARGEST_RECORD_BYTES = 100_000
"""Size of the largest file about a run that is read."""
MOST_ENDED = 5
"""Number of runs that have ended whose output is told."""
END_BYTES = 4096
"""Size of the beginning and of the end of a run's output that are read."""
PAGE_OF_THIS_MACHINE = ("--port=0", "--no-browser")
"""Arguments of a page at a free port that this machine alone can open."""
State = Literal["starting", "running", "ended"]


class StartedRun(BaseModel):
    """A run that was started: its process, and what was asked for."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    name: str = Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$")
    scenario: str
    seats: tuple[str, ...]
    process: int
    created_s: float
    """When the system says that the process was created: another one may have its number now."""


class StartedRuns:
    """Starts runs with their pages, and stops them.

    Parameters
    ----------
    folder
        Folder of the run folders; made when a run is started.
    page
        Arguments that say where the page of a run is, and who may open it.
    """

    def __init__(self, folder: Path, page: Sequence[str] = PAGE_OF_THIS_MACHINE) -> None:
        self.folder = folder
        self._page = page
        self._children: list[subprocess.Popen[bytes]] = []

    def start(self, scenario: Path, options: Options, name: str | None = None) -> str:
        """Start a run in real time, and return its name, which is that of its folder.

        A run with seats begins when they are taken.

        Parameters
        ----------
        name
            Name of the run; None: that of the scenario, the seed and the time.

        Raises
        ------
        AirhiltError
            The scenario is wrong or has no such seat, enough runs go on already, or the folder
            cannot be written.
        """
        loaded = load(scenario)
        seats = seats_of(options.seat, loaded)
        if len([run for run in self.runs() if self.state(run) != "ended"]) >= MOST_AT_A_TIME:
            raise StationError(f"{MOST_AT_A_TIME} runs go on already; stop one of them first")
        name = name or _new_name(self.folder, loaded.name, options.seed)
        own = {"out": self.folder / name, "pace": "realtime", "wait_for_seats": bool(seats)}
        given = options.model_copy(update=own)
        command = [sys.executable, "-m", "airhilt", "cosim", f"--scenario={scenario}"]
        command += ["--view", *self._page, *arguments_of(given)]
        try:
            make_folder(self.folder / KEPT)
            replace_file(self._output(name), b"")
            self._output(name).chmod(0o600)  # The token may be in the address of the page.
        except OSError as error:
            raise StationError(f"{error.filename}: cannot be written: {error.strerror}") from None
        # A session of its own, and a file to write to: it needs nothing of this process.
        with self._output(name).open("wb") as output:
            child = subprocess.Popen(  # noqa: S603 - our own command
                command,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        self._children.append(child)
        created_s = psutil.Process(child.pid).create_time()
        run = StartedRun(
            name=name, scenario=loaded.name, seats=seats, process=child.pid, created_s=created_s
        )
        replace_file(self._record(name), run.model_dump_json().encode())
        return name

    def stop(self, name: str) -> None:
        """Let a run end as Ctrl+C does; its folder is complete up to then.

        Raises
        ------
        StationError
            There is no such run.
        """
        run = next((one for one in self.runs() if one.name == name), None)
        if run is None:
            raise StationError(f"run {readable(name)!r}: not started here")
        if self.state(run) != "ended" and "cosim" in psutil.Process(run.process).cmdline():
            os.kill(run.process, signal.SIGINT)

    def runs(self) -> list[StartedRun]:
        """Return the runs that were started here, the newest first."""
        for child in self._children:
            child.poll()
        found = []
        for path in (self.folder / KEPT).glob("*.json"):
            with suppress(OSError, ValidationError):  # One that is being written, or is foreign.
                data = read_inside(self.folder, path, LARGEST_RECORD_BYTES)
                found.append(StartedRun.model_validate_json(data))
        return sorted(found, key=lambda run: run.created_s, reverse=True)

    def state(self, run: StartedRun) -> State:
        """Return how a run is doing."""
        try:
            process = psutil.Process(run.process)
            is_same = abs(process.create_time() - run.created_s) < 1.0
            if process.status() == psutil.STATUS_ZOMBIE or not is_same:
                return "ended"
        except psutil.Error:
            return "ended"
        return "running" if self.url(run) else "starting"

    def state_of(self, name: str) -> State | None:
        """Return how a run is doing by its name, None if it was not started here."""
        return next((self.state(run) for run in self.runs() if run.name == name), None)

    def url(self, run: StartedRun) -> str:
        """Return the address of a run's page, empty if it has none yet."""
        addresses = (line.split()[0] for line in self._lines(run) if is_address(line))
        return next(addresses, "")

    def rows(self) -> list[dict[str, Any]]:
        """Return what a page shows of the runs that go on, and of the last ones that have ended."""
        rows, ended = [], 0
        for run in self.runs():
            state = self.state(run)
            ended += state == "ended"
            if state != "ended" or ended <= MOST_ENDED:
                # Nobody has a terminal at a page.
                lines = [line for line in self._lines(run) if not is_address(line)]
                lines = [line for line in lines if "Ctrl+C" not in line]
                rows.append(
                    {
                        "name": readable(run.name),
                        "scenario": readable(run.scenario),
                        "seats": [readable(seat) for seat in run.seats],
                        "state": state,
                        "url": self.url(run) if state == "running" else "",
                        "said": readable(lines[-1], LONGEST_LINE) if lines else "",
                    }
                )
        return rows

    def _lines(self, run: StartedRun) -> list[str]:
        try:
            with open_inside(self.folder, self._output(run.name)) as output:
                text = output.read(END_BYTES)
                output.seek(max(output.seek(0, os.SEEK_END) - END_BYTES, len(text)))
                text += output.read()
        except OSError:
            return []
        return [line for line in text.decode(errors="replace").splitlines() if line.strip()]

    def _output(self, name: str) -> Path:
        return self.folder / KEPT / f"{name}.txt"

    def _record(self, name: str) -> Path:
        return self.folder / KEPT / f"{name}.json"


def is_address(line: str) -> bool:
    """Return true if a command says in a line where its page is."""
    return line.startswith(("http://", "https://"))


def _new_name(folder: Path, scenario: str, seed: int) -> str:
    stem = f"{scenario}-{seed}-{datetime.now(UTC):%Y%m%dT%H%M%S}"
    name, count = stem, 1
    while (folder / name).exists() or (folder / KEPT / f"{name}.json").exists():
        count += 1
        name = f"{stem}-{count}"
    return name
