"""Refusals, of which a few of each source are told."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

MOST_NOTICES = 20
"""Largest number of refusals of one source that are told."""


class Refusals:
    """Tells what is refused: the first `MOST_NOTICES` of each source.

    Parameters
    ----------
    notice
        Is told of it.
    """

    def __init__(self, notice: Callable[[str], None]) -> None:
        self._notice = notice
        self._told: Counter[str] = Counter()

    def tell(self, what: str, source: str) -> None:
        """Tell of a refusal, and with the last one of a source that no more of it are told."""
        self._told[source] += 1
        if self._told[source] > MOST_NOTICES:
            return
        is_last = self._told[source] == MOST_NOTICES
        self._notice(f"refused {what}{f'; further ones {source} are not told' * is_last}")
