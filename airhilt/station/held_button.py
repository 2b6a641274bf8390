"""The transmit button of a browser while it is held, and how much sound may come."""

from __future__ import annotations

import time
from collections.abc import Callable

from airhilt.audio.pcm import SAMPLE_BYTES, SAMPLE_RATE_HZ

LARGEST_PIECE_BYTES = SAMPLE_RATE_HZ * SAMPLE_BYTES // 5
"""Greatest size of a binary message, in bytes: 0.2 s of sound."""
AHEAD_S = 2.0
"""Sound that may come before its time, in s: what a network has kept back comes at once."""


class HeldButton:
    """Counts the sound that comes while a button is held.

    Parameters
    ----------
    clock
        Returns the wall time in s.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._pressed_s = clock()
        self._bytes = 0

    def admits(self, pcm: bytes) -> bool:
        """Return true if sound comes no faster than somebody can speak, and count it."""
        self._bytes += len(pcm)
        may_be_s = self._clock() - self._pressed_s + AHEAD_S
        return self._bytes <= may_be_s * SAMPLE_RATE_HZ * SAMPLE_BYTES


def what_is_wrong_with(pcm: bytes) -> str | None:
    """Return why a binary message is no sound of a microphone, None if it is."""
    if not pcm or len(pcm) % SAMPLE_BYTES:
        return f"sound of {len(pcm)} bytes; expected samples of {8 * SAMPLE_BYTES} bits"
    if len(pcm) > LARGEST_PIECE_BYTES:
        return f"sound of {len(pcm)} bytes; expected at most {LARGEST_PIECE_BYTES}"
    return None
