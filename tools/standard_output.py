"""Standard output of a tool that somebody may stop reading, as `head` does."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable

CUT_OFF = 1
"""Exit status if the reader has gone before the end."""


def run(main: Callable[[], None]) -> None:
    """Run a tool, and end it without a traceback if nobody reads its output any more.

    What is still buffered goes nowhere: Python flushes standard output once more when it ends
    (documentation of Python's `signal`, note on SIGPIPE).
    """
    try:
        main()
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(CUT_OFF)
