"""Patterns of which a call needs few."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True)
class LatePattern:
    """Regular expression that is compiled when it is first matched.

    All forms of the phraseology together take longer to compile than a call to be read.
    """

    pattern: str

    @cached_property
    def match(self) -> Callable[[str, int], re.Match[str] | None]:
        """Function that matches the pattern in a text, from a place on."""
        return re.compile(self.pattern).match
