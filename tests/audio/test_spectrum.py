"""Spectra have sizes that transforms are fast for."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from airhilt.audio.spectrum import fast_size


def is_smooth(size: int) -> bool:
    for prime in (2, 3, 5):
        while size % prime == 0:
            size //= prime
    return size == 1


@given(count=st.integers(1, 500_000))
def test_the_size_is_the_least_one_without_large_prime_factors(count: int) -> None:
    size = fast_size(count)
    assert is_smooth(size)
    assert not any(is_smooth(smaller) for smaller in range(count, size))
