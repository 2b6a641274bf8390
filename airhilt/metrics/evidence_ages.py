"""Ages of the evidence that decisions rested on, and the time in which it was stale."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterator
from copy import copy

from airhilt.messages import AdsbReport, Detections, Message, Modality, Transcript
from airhilt.metrics.summary import STALE_S, EvidenceAge
from airhilt.options import MODALITIES
from airhilt.sim import StepRecord
from airhilt.units import SECOND_NS, seconds_to_ns

CONTINUOUS: tuple[Modality, ...] = ("adsb", "vision")
"""Modalities that observe all the time; calls come when they come."""


Arrivals = deque[tuple[int, int]]
"""Observations that no step has had: when each was published, and when it was made, in ns."""


def _taken(arrivals: Arrivals, t_start_ns: int) -> Iterator[int]:
    while arrivals and arrivals[0][0] <= t_start_ns:
        yield arrivals.popleft()[1]


class _Stream:
    """Continuous input: a decision rests on the newest observation.

    Before the first decision that has one, the age counts from the first observation.
    """

    def __init__(self, first_ns: int) -> None:
        self.arrivals: Arrivals = deque()
        self._since_ns = first_ns
        """End of the last step."""
        self._newest_ns = first_ns
        self._stale_ns = self._longest_ns = self._whole_ns = 0
        self._age_ns2 = 0.0
        """Integral of the age over the time."""

    def step(self, t_start_ns: int, end_ns: int) -> None:
        """Let a step have what had arrived."""
        self._count_until(end_ns)
        self._newest_ns = max((self._newest_ns, *_taken(self.arrivals, t_start_ns)))

    def _count_until(self, end_ns: int) -> None:
        """Count the time since the last step, in which the newest observation stayed the same."""
        begin_ns, newest_ns = self._since_ns, self._newest_ns
        if end_ns <= begin_ns:
            return
        stale_from_ns = max(begin_ns, newest_ns + seconds_to_ns(STALE_S))
        self._stale_ns += max(end_ns - stale_from_ns, 0)
        self._longest_ns = max(self._longest_ns, end_ns - newest_ns)
        self._whole_ns += end_ns - begin_ns
        self._age_ns2 += (end_ns - begin_ns) * (begin_ns + end_ns - 2 * newest_ns) / 2.0
        self._since_ns = end_ns

    def age(self, now_ns: int) -> EvidenceAge:
        """Return how old the evidence was until now."""
        until = copy(self)
        until._count_until(now_ns)
        whole_ns = until._whole_ns
        return EvidenceAge(
            mean_s=until._age_ns2 / whole_ns / SECOND_NS if whole_ns else 0.0,
            max_s=until._longest_ns / SECOND_NS,
            stale_share=until._stale_ns / whole_ns if whole_ns else 0.0,
        )


class _Calls:
    """Calls: each is evidence until a decision has had it."""

    def __init__(self) -> None:
        self.arrivals: Arrivals = deque()
        self._answered: list[tuple[int, int]] = []
        """End of each call, and end of the step that had it."""

    def step(self, t_start_ns: int, end_ns: int) -> None:
        """Let a step have what had arrived."""
        self._answered += ((said_ns, end_ns) for said_ns in _taken(self.arrivals, t_start_ns))

    def age(self, now_ns: int) -> EvidenceAge:
        """Return how old the evidence was until now."""
        unanswered = ((said_ns, now_ns) for _, said_ns in self.arrivals)
        waits_ns = sorted((*self._answered, *unanswered))
        stale_ns, done_ns = 0, 0
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


class EvidenceAges:
    """Follows what decision workers have had of the modalities that they are given."""

    def __init__(self, deciders: Collection[str], given: Collection[str] = MODALITIES) -> None:
        self._deciders = frozenset(deciders)
        self._given = frozenset(given)
        self._evidence: dict[Modality, _Stream | _Calls] = {}

    def take(self, message: Message) -> None:
        """Note an observation; other messages are ignored."""
        if not self._deciders:
            return
        match message:
            case AdsbReport(t_adsb_in_ns=observed_ns):
                self._add("adsb", message.t_ns, observed_ns)
            case Detections(t_frame_ns=observed_ns, missed=""):
                self._add("vision", message.t_ns, observed_ns)
            case Transcript(t_end_ns=observed_ns):
                self._add("asr", message.t_ns, observed_ns)

    def _add(self, modality: Modality, t_ns: int, observed_ns: int) -> None:
        evidence = self._evidence.get(modality)
        if evidence is None:
            evidence = _Stream(observed_ns) if modality in CONTINUOUS else _Calls()
            self._evidence[modality] = evidence
        evidence.arrivals.append((t_ns, observed_ns))

    def step(self, record: StepRecord) -> None:
        """Note a finished step of a worker."""
        if record.worker in self._deciders:
            for evidence in self._evidence.values():
                evidence.step(record.t_start_ns, record.t_start_ns + record.latency_ns)

    def statistics(self, now_ns: int) -> dict[Modality, EvidenceAge]:
        """Return the ages of each modality that observed something while somebody decided."""
        return {
            modality: evidence.age(now_ns)
            for modality, evidence in sorted(self._evidence.items())
            if modality in self._given
        }
