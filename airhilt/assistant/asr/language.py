"""N-gram model of the word pieces of calls, with backing off.

Written by ``tools/asr/learn_language.py``; Kneser and Ney (ICASSP 1995), Chen and Goodman (1999).
"""

from __future__ import annotations

from bisect import bisect_left
from pathlib import Path

import numpy as np

from airhilt.errors import SpeechError, first_line

END = 0
"""Unit that stands before the first piece of a call and after its last."""
BITS = 12
"""Bits of a unit in a key."""
EXPECTED = "an archive of tools/asr/learn_language.py"


def key(units: tuple[int, ...]) -> int:
    """Return the number under which an n-gram of at most five units is kept."""
    found = 0
    for unit in units:
        found = found << BITS | unit
    return found


class Language:
    """An n-gram model over units.

    Parameters
    ----------
    path
        NumPy archive with ``keysN`` (uint64, ascending), ``scoresN`` and ``backoffsN`` (natural
        logarithms) for each order N from 1.
    units
        Number of units, `END` included; each has a unigram.

    Raises
    ------
    SpeechError
        It is no such file.
    """

    def __init__(self, path: Path, units: int) -> None:
        try:
            with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
                self.order = sum(name.startswith("keys") for name in archive.files)
                tables = [
                    tuple(
                        np.asarray(archive[f"{name}{n}"]) for name in ("keys", "scores", "backoffs")
                    )
                    for n in range(1, self.order + 1)
                ]
        except Exception as error:  # a damaged archive raises errors of zip, zlib and NumPy
            raise SpeechError(
                f"{path}: no language model: {first_line(error)}; expected {EXPECTED}"
            ) from None
        fits = bool(tables) and all(
            keys.dtype == np.uint64 and keys.shape == scores.shape == backoffs.shape
            for keys, scores, backoffs in tables
        )
        if not fits or len(tables[0][0]) != units:
            raise SpeechError(
                f"{path}: no language model of {units} units; expected {EXPECTED}, made with the "
                "pieces beside it"
            )
        self._keys = [keys.data for keys, _, _ in tables]
        self._scores = [scores for _, scores, _ in tables]
        self._backoffs = [backoffs for _, _, backoffs in tables]

    def score(self, before: tuple[int, ...], unit: int) -> float:
        """Return the log-likelihood of a unit after others, of which the last few count."""
        before = before[1 - self.order :] if self.order > 1 else ()
        backed_off = 0.0
        while True:
            at = self._find((*before, unit))
            if at is not None:
                return backed_off + float(self._scores[len(before)][at])
            context = self._find(before)
            if context is not None:
                backed_off += float(self._backoffs[len(before) - 1][context])
            before = before[1:]

    def _find(self, units: tuple[int, ...]) -> int | None:
        keys, wanted = self._keys[len(units) - 1], key(units)
        at = bisect_left(keys, wanted)
        return at if at < len(keys) and keys[at] == wanted else None
