"""The line that a cell of a notebook shows while something takes long in it."""

from __future__ import annotations

import sys
import time

from airhilt.host.text import LONGEST_LINE, readable

PERIOD_S = 0.2
"""Least time between two changes of the line, in s."""


def is_notebook() -> bool:
    """Return whether this process runs the cells of a notebook."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return getattr(shell, "kernel", None) is not None


class NotebookLine:
    """A line in the output of the cell that is running, and notices below it."""

    def __init__(self) -> None:
        from IPython.display import DisplayHandle

        self._handle = DisplayHandle()  # type: ignore[no-untyped-call]
        self._lines = [""]
        self._due_s = time.monotonic()
        self._handle.display(self._content(), raw=True)  # type: ignore[no-untyped-call]

    def show(self, text: str, is_last: bool = False) -> None:
        """Replace the line, unless it was replaced a moment ago and another one follows."""
        self._lines[0] = text
        if is_last or time.monotonic() >= self._due_s:
            self._update()

    def notice(self, text: str) -> None:
        """Add a line that stays."""
        self._lines.append(text)
        self._update()

    def _update(self) -> None:
        self._due_s = time.monotonic() + PERIOD_S
        self._handle.update(self._content(), raw=True)  # type: ignore[no-untyped-call]

    def _content(self) -> dict[str, str]:
        lines = (readable(line, LONGEST_LINE) for line in self._lines)
        return {"text/plain": "\n".join(lines)}
