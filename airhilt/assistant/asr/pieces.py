"""The word pieces that the embedded recogniser writes: whole words of aviation, syllables, letters.

A piece that begins with `BEGIN` begins a word. All letters are pieces, so that any word can be
written with them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

BEGIN = "_"


class Pieces:
    """An inventory of pieces, each once. Unit 0 is the blank, unit i is piece i - 1."""

    def __init__(self, pieces: Sequence[str]) -> None:
        self._pieces = tuple(pieces)
        self._unit_of = {piece: unit for unit, piece in enumerate(pieces, start=1)}
        self._longest = max(map(len, pieces), default=0)
        self._splits: dict[str, tuple[int, ...] | None] = {}

    def __len__(self) -> int:
        return len(self._pieces)

    def unit(self, word: str) -> int | None:
        """Return the unit that is a whole word; None if there is none."""
        return self._unit_of.get(BEGIN + word)

    def begins_word(self, unit: int) -> bool:
        """Return whether a unit begins a word."""
        return self._pieces[unit - 1].startswith(BEGIN)

    def split(self, word: str) -> tuple[int, ...] | None:
        """Return the fewest units that write a word, of these the longest first.

        None if it has a letter that no piece has.
        """
        if word not in self._splits:
            self._splits[word] = self._split(BEGIN + word)
        return self._splits[word]

    def _split(self, text: str) -> tuple[int, ...] | None:
        """Find the fewest units from the end: of each place, how the rest is best written."""
        rest: list[tuple[int, ...] | None] = [None] * len(text) + [()]
        for begin in range(len(text) - 1, -1, -1):
            for end in range(min(begin + self._longest, len(text)), begin, -1):
                unit, after = self._unit_of.get(text[begin:end]), rest[end]
                if unit is None or after is None:
                    continue
                best = rest[begin]
                if best is None or len(after) + 1 < len(best):
                    rest[begin] = (unit, *after)
        return rest[0]

    def units(self, words: Iterable[str]) -> tuple[int, ...] | None:
        """Return the units of words; None if one cannot be written."""
        split = [self.split(word) for word in words]
        if any(units is None for units in split):
            return None
        return tuple(unit for units in split if units is not None for unit in units)

    def text(self, units: Iterable[int]) -> str:
        """Return what units write, with spaces between words."""
        written = "".join(self._pieces[unit - 1] for unit in units)
        return " ".join(written.replace(BEGIN, " ").split())

    def words(self, units: Sequence[int]) -> list[tuple[int, int]]:
        """Return the bounds of each word among units: its first one, and the one after its last."""
        begins = [at for at, unit in enumerate(units) if at == 0 or self.begins_word(unit)]
        return list(pairwise([*begins, len(units)]))
