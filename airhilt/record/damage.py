"""Notices and warnings of what is damaged in a run or a sweep."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from pathlib import Path

from airhilt.host.text import LONGEST_LINE, readable

Notice = Callable[[str], None]
"""Tells a person one line."""
OF_WHO_CALLS = 4
"""Level of who calls `airhilt.open_run` or `airhilt.read_sweep` in the stack of a warning."""


def untold(_: str) -> None:
    """Tell nobody, because the result itself says what is damaged."""


class DamageWarning(UserWarning):
    """A file of a run or a sweep is not as it was written."""


def tell_damage(folder: Path, damage: Iterable[str], notice: Notice | None) -> None:
    """Tell each line of what is damaged in a folder; without a notice Python warns of it."""
    for line in damage:
        text = f"{folder}: {line}"
        if notice is None:
            warnings.warn(readable(text, LONGEST_LINE), DamageWarning, stacklevel=OF_WHO_CALLS)
        else:
            notice(text)
