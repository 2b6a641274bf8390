"""Ctrl-C at a terminal: the signal goes to every process of the sweep's process group."""

from __future__ import annotations

import fcntl
import os
import pty
import subprocess
import sys
import termios
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import psutil
import pyarrow.parquet as pq
import pytest

from dask_processes import wait_until

pytestmark = pytest.mark.slow

CTRL_C = b"\x03"
MARK = "AIRHILT_TEST"
RUNS = 60


class Terminal:
    """A command in a pseudo-terminal."""

    def __init__(self, *command: str | Path) -> None:
        self._mark = uuid.uuid4().hex
        self._keyboard, screen = pty.openpty()
        self.process = subprocess.Popen(
            command,
            stdin=screen,
            stdout=screen,
            stderr=screen,
            start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
            env={**os.environ, MARK: self._mark},
        )
        os.close(screen)
        os.set_blocking(self._keyboard, False)
        self._seen = b""

    def press(self, key: bytes) -> None:
        os.write(self._keyboard, key)

    @property
    def screen(self) -> str:
        """All that was printed so far."""
        with suppress(OSError):
            while part := os.read(self._keyboard, 1 << 16):
                self._seen += part
        return self._seen.decode(errors="replace")

    def processes(self) -> list[psutil.Process]:
        """Return the processes that the command has started, with itself."""
        found = []
        for process in psutil.process_iter():
            with suppress(psutil.Error):
                if process.environ().get(MARK) == self._mark:
                    found.append(process)
        return found

    def ended(self) -> int | None:
        """Return the exit code, None while it runs; reads the screen, so that it can go on."""
        assert self.screen is not None
        return self.process.poll()

    def close(self) -> None:
        for process in self.processes():
            process.kill()
        self.process.wait()
        os.close(self._keyboard)


@contextmanager
def sweep(scenario: Path, out: Path) -> Iterator[Terminal]:
    """A sweep of two local workers, once it has finished two runs."""
    terminal = Terminal(
        *(sys.executable, "-m", "airhilt", "sweep", "--scenario", scenario, "--out", out),
        *("--seeds", str(RUNS), "--no-speech", "--latency", "fixed", "--workers", "2"),
    )
    try:
        wait_until(lambda: terminal.screen and len(list(out.glob("parts/*.parquet"))) >= 2)
        yield terminal
    finally:
        terminal.close()


def test_once_lets_the_runs_in_hand_finish(encounter_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "sweep"
    with sweep(encounter_file, out) as terminal:
        terminal.press(CTRL_C)
        wait_until(lambda: terminal.ended() is not None)
        assert terminal.ended() == 130
        assert "stopping: the runs in hand finish first" in terminal.screen
        assert "Traceback" not in terminal.screen
        assert terminal.processes() == []
    rows = pq.read_table(out / "machine.parquet").to_pylist()
    assert 2 <= len(rows) < RUNS
    assert {row["status"] for row in rows} == {"finished"}


def test_twice_stops_at_once_and_leaves_nothing_behind(
    encounter_file: Path, tmp_path: Path
) -> None:
    out = tmp_path / "sweep"
    with sweep(encounter_file, out) as terminal:
        terminal.press(CTRL_C)
        wait_until(lambda: "stopping" in terminal.screen)
        terminal.press(CTRL_C)
        wait_until(lambda: terminal.ended() is not None)
        assert terminal.ended() == 130
        assert "Traceback" not in terminal.screen
        wait_until(lambda: not terminal.processes())
    assert len(list(out.glob("parts/*.parquet"))) >= 2
