"""What was heard twice alike is surer than what was heard once.

A crew that is asked to confirm says the same words again. They are wrong only if both calls were
heard wrongly. Calls of one voice do not err quite independently, and nearly so: of words that were
heard alike at two ratios of signal and noise, with confidences of 0.5 to 0.8 each, 89 % of 269 were
right in one test and 92 % of 63 in another, and independence gives 90 %. No more than two calls are
joined, because no more were measured.
"""

from __future__ import annotations

from dataclasses import replace

from airhilt.assistant.decision.guard import Doubt, Slot
from airhilt.phraseology import Action
from airhilt.units import SECOND_NS

REMEMBERED_NS = 120 * SECOND_NS
"""Time for which a call that was in doubt makes another surer, in ns, as long as it matters."""


class Repeats:
    """Joins the confidences of a slot that was heard alike in two calls.

    Callsigns are left out, whose confidence is that of a choice among those on the frequency. So
    are values that made no sense in both calls, however well they were heard.

    Parameters
    ----------
    tau_asr
        Confidence from which a slot is in doubt no more.
    """

    def __init__(self, tau_asr: float) -> None:
        self._tau_asr = tau_asr
        self._heard: dict[tuple[str, Action, Slot], list[Doubt]] = {}
        """Doubts about the same value, the oldest first."""

    def joined(self, doubt: Doubt | None) -> Doubt | None:
        """Return a doubt with the confidence of both calls, None if there is none any more."""
        if doubt is None or doubt.slot == "callsign":
            return doubt
        key = (doubt.callsign, doubt.said.action, doubt.slot)
        earlier = [each for each in self._heard.get(key, ()) if _is_repeated(each, doubt)]
        self._heard[key] = [*earlier, doubt]
        surest = max((each.confidence for each in earlier), default=0.0)
        confidence = 1.0 - (1.0 - surest) * (1.0 - doubt.confidence)
        return None if confidence >= self._tau_asr else replace(doubt, confidence=confidence)


def _is_repeated(earlier: Doubt, doubt: Doubt) -> bool:
    """Return whether a call a moment ago said the same, and not both are without sense."""
    one, other = earlier.said, doubt.said
    return (
        earlier.transcript.id != doubt.transcript.id
        and doubt.transcript.t_end_ns - earlier.transcript.t_end_ns <= REMEMBERED_NS
        and (one.runway, one.altitude_ft) == (other.runway, other.altitude_ft)
        and (_is_of_hearing(earlier) or _is_of_hearing(doubt))
    )


def _is_of_hearing(doubt: Doubt) -> bool:
    """Return whether the words of a slot are in doubt, and not what they say."""
    return doubt.slot == "action" or doubt.said.details_heard <= doubt.confidence
