"""The page of a run that goes on, served by a process of its own: the run goes on without it."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

import click

from airhilt.cli.output import tell

FORWARDING_S = 1.0
"""Longest wait for the last lines of the page, in s: a browser that it opened may hold the pipe."""


@contextmanager
def live_page(
    endpoint: str | None, tls: Path | None, seats: Iterable[str], arguments: Sequence[str] = ()
) -> Iterator[None]:
    """Serve the page of the run at an endpoint while it goes on, and until no browser shows it.

    Parameters
    ----------
    endpoint, tls
        Where the run is, and the folder with its keys; None, as the run has none of it.
    seats
        Seats that browsers may take.
    arguments
        Arguments of ``airhilt view`` that say where the page is, and who may open it.
    """
    command = [sys.executable, "-m", "airhilt", "view", *arguments]
    command += [] if endpoint is None else ["--connect", endpoint]
    command += [] if tls is None else ["--tls", str(tls)]
    for seat in seats:
        command += ["--seat", seat]
    # A session of its own: Ctrl+C is for the run, which ends, and then the page does.
    page = subprocess.Popen(  # noqa: S603 - our own command
        command, stdout=subprocess.PIPE, text=True, start_new_session=True
    )
    assert page.stdout is not None
    page.stdout.readline()  # It waits for the run now, and will miss nothing of it.
    forwarding = threading.Thread(target=_forward, args=(page.stdout,), daemon=True)
    forwarding.start()
    try:
        yield
        if page.poll() is None:
            tell("the page stays until it is closed in the browser, or Ctrl+C")
            page.wait()
    finally:
        if page.poll() is None:
            page.send_signal(signal.SIGINT)
            page.wait()
        forwarding.join(FORWARDING_S)


def _forward(lines: TextIO) -> None:
    with lines:
        for line in lines:
            click.echo(line, err=True, nl=False)
