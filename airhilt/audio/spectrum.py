"""Sizes of spectra. A plain run imports no SciPy: it takes longer to load than a call to hear."""

from __future__ import annotations


def fast_size(count: int) -> int:
    """Return the least size from a count on without prime factors over 5, which FFTs are fast for.

    It is `scipy.fft.next_fast_len` for real numbers.
    """
    best = 1 << (count - 1).bit_length()
    fives = 1
    while fives < best:
        odd = fives
        while odd < best:
            best = min(best, odd << (-(-count // odd) - 1).bit_length())
            odd *= 3
        fives *= 5
    return best
