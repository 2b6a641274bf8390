"""The order of calls: a transcript may come twice, or after those of later calls."""

from __future__ import annotations

from airhilt.messages import Transcript
from airhilt.units import SECOND_NS

REMEMBERED_NS = 60 * SECOND_NS
"""Time for which calls are remembered, in ns: a late one is put back into its place among them."""


class CallOrder:
    """Puts transcripts back into the order in which the calls began."""

    def __init__(self) -> None:
        self._calls: list[Transcript] = []
        """The calls that were taken lately, in the order of their beginnings."""

    def earlier(self, transcript: Transcript) -> Transcript | None:
        """Return the transcript of the same call that was taken already; None if there is none."""
        return next((each for each in self._calls if _call(each) == _call(transcript)), None)

    def take(self, transcript: Transcript) -> tuple[Transcript, ...]:
        """Return the transcripts to act on now: the given one, and those of later calls again.

        There are none if it is so late that it cannot be put back into its place.
        """
        newest_ns = self._calls[-1].t_tx_ns if self._calls else 0
        if transcript.t_tx_ns < newest_ns - REMEMBERED_NS:
            return ()
        later = tuple(each for each in self._calls if each.t_tx_ns > transcript.t_tx_ns)
        before = self._calls[: len(self._calls) - len(later)]
        newest_ns = max(newest_ns, transcript.t_tx_ns)
        self._calls = [
            each
            for each in (*before, transcript, *later)
            if each.t_tx_ns >= newest_ns - REMEMBERED_NS
        ]
        return (transcript, *later)


def _call(transcript: Transcript) -> tuple[int, str]:
    return transcript.frequency_khz, transcript.id
