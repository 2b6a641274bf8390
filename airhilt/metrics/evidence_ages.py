"""Ages of the evidence that decisions rested on, and the time in which it was stale."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from itertools import pairwise

from airhilt.messages import AdsbReport, Detections, Message, Modality, Transcript
from airhilt.metrics.summary import STALE_S, EvidenceAge
from airhilt.options import MODALITIES
from airhilt.sim import StepRecord
from airhilt.units import SECOND_NS, seconds_to_ns

CONTINUOUS: tuple[Modality, ...] = ("adsb", "vision")
"""Modalities that observe all the time; calls come when they come."""


@dataclass(slots=True)
class _Evidence:
    """The observations of one modality.

    Attributes
    ----------
    arrivals
        Time at which each was published, and time at which it was observed, in ns.
    """

    arrivals: list[tuple[int, int]] = field(default_factory=list)
    taken: int = 0
    """Number of those that decisions had."""
    newest_ns: int | None = None
    judged: list[tuple[int, int]] = field(default_factory=list)
    """End of each step, and the newest observation that it had."""
    answered: list[tuple[int, int]] = field(default_factory=list)
    """Observation time of each call, and end of the step that had it."""

    def step(self, t_start_ns: int, end_ns: int) -> None:
        """Let a step have what had arrived."""
        while self.taken < len(self.arrivals) and self.arrivals[self.taken][0] <= t_start_ns:
            observed_ns = self.arrivals[self.taken][1]
            self.newest_ns = max(observed_ns, self.newest_ns or 0)
            self.answered.append((observed_ns, end_ns))
            self.taken += 1
        if self.newest_ns is not None:
            self.judged.append((end_ns, self.newest_ns))

    def observed_ns(self, end_ns: int) -> Iterator[tuple[int, int, int]]:
        """Yield begin and end of each time, and the newest observation that was judged by then.

        Before the first decision nothing was: the age counts from the first observation.
        """
        first_ns = self.arrivals[0][1]
        times = [(first_ns, first_ns), *self.judged, (end_ns, 0)]
        for (begin_ns, newest_ns), (next_ns, _) in pairwise(times):
            if next_ns > begin_ns:
                yield begin_ns, next_ns, newest_ns

    def waiting_ns(self, end_ns: int) -> Iterator[tuple[int, int]]:
        """Yield when each call had ended, and when a decision that had it was made."""
        unanswered = ((observed_ns, end_ns) for _, observed_ns in self.arrivals[self.taken :])
        yield from (*self.answered, *unanswered)


class EvidenceAges:
    """Follows what decision workers have had.

    Parameters
    ----------
    deciders
        Names of the workers that decide.
    given
        Modalities that they are given.
    """

    def __init__(self, deciders: Collection[str], given: Collection[str] = MODALITIES) -> None:
        self._deciders = frozenset(deciders)
        self._given = frozenset(given)
        self._evidence: dict[Modality, _Evidence] = {}

    def take(self, message: Message) -> None:
        """Note an observation; other messages are ignored."""
        match message:
            case AdsbReport(t_adsb_in_ns=observed_ns):
                self._add("adsb", message.t_ns, observed_ns)
            case Detections(t_frame_ns=observed_ns, missed=""):
                self._add("vision", message.t_ns, observed_ns)
            case Transcript(t_end_ns=observed_ns):
                self._add("asr", message.t_ns, observed_ns)

    def _add(self, modality: Modality, t_ns: int, observed_ns: int) -> None:
        self._evidence.setdefault(modality, _Evidence()).arrivals.append((t_ns, observed_ns))

    def step(self, record: StepRecord) -> None:
        """Note a finished step of a worker."""
        if record.worker in self._deciders:
            for evidence in self._evidence.values():
                evidence.step(record.t_start_ns, record.t_start_ns + record.latency_ns)

    def statistics(self, now_ns: int) -> dict[Modality, EvidenceAge]:
        """Return the ages of each modality that observed something while somebody decided."""
        if not self._deciders:
            return {}
        return {
            modality: _of_stream(evidence, now_ns)
            if modality in CONTINUOUS
            else _of_calls(evidence, now_ns)
            for modality, evidence in sorted(self._evidence.items())
            if modality in self._given
        }


def _of_stream(evidence: _Evidence, now_ns: int) -> EvidenceAge:
    stale_ns, age_ns2, longest_ns, whole_ns = 0, 0.0, 0, 0
    for begin_ns, end_ns, newest_ns in evidence.observed_ns(now_ns):
        youngest_ns, oldest_ns = begin_ns - newest_ns, end_ns - newest_ns
        stale_from_ns = max(begin_ns, newest_ns + seconds_to_ns(STALE_S))
        stale_ns += max(end_ns - stale_from_ns, 0)
        age_ns2 += (end_ns - begin_ns) * (youngest_ns + oldest_ns) / 2.0
        longest_ns = max(longest_ns, oldest_ns)
        whole_ns += end_ns - begin_ns
    return EvidenceAge(
        mean_s=age_ns2 / whole_ns / SECOND_NS if whole_ns else 0.0,
        max_s=longest_ns / SECOND_NS,
        stale_share=stale_ns / whole_ns if whole_ns else 0.0,
    )


def _of_calls(evidence: _Evidence, now_ns: int) -> EvidenceAge:
    stale_ns, done_ns = 0, 0
    waits_ns = sorted(evidence.waiting_ns(now_ns))
    for ended_ns, judged_ns in waits_ns:
        begin_ns = max(ended_ns + seconds_to_ns(STALE_S), done_ns)
        stale_ns += max(judged_ns - begin_ns, 0)
        done_ns = max(done_ns, judged_ns)
    lengths_ns = [judged_ns - ended_ns for ended_ns, judged_ns in waits_ns]
    whole_ns = now_ns - waits_ns[0][0]
    return EvidenceAge(
        mean_s=sum(lengths_ns) / len(lengths_ns) / SECOND_NS,
        max_s=max(lengths_ns) / SECOND_NS,
        stale_share=stale_ns / whole_ns if whole_ns > 0 else 0.0,
    )
