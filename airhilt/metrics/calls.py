"""The calls of a run, as they were said, received, recognised and understood."""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from airhilt.messages import (
    ADVISORY_CALL,
    AdvisoryAudio,
    HearingTruth,
    Message,
    SpokenTruth,
    Transcript,
    Transmission,
    bus_message,
)
from airhilt.metrics.summary import RadioStatistics
from airhilt.metrics.words import recognition, score
from airhilt.phraseology import parse_call
from airhilt.units import SECOND_NS

TEXT = "text"
"""Engine of transcripts that were not recognised: the words of a call without sound."""
REPEAT = re.compile(r"\.repeat-[0-9]+$")
"""End of the id of a call that is made again (docs/transmissions.md)."""


OF_CALLS = (Transmission, Transcript, SpokenTruth, HearingTruth, AdvisoryAudio)
"""Messages about calls and spoken advisories."""


@dataclass
class CallRecord:
    """Everything known about one transmission."""

    said: SpokenTruth | None = None
    received: Transmission | None = None
    """The call as it was received; None if it reached no receiver."""
    transcripts: list[Transcript] = field(default_factory=list)
    """One transcript for each recogniser that made one."""
    hearings: list[HearingTruth] = field(default_factory=list)

    @property
    def recognised(self) -> list[Transcript]:
        """Transcripts that were made from sound."""
        return [transcript for transcript in self.transcripts if transcript.engine != TEXT]


class CallRecords:
    """All calls of a run, by their ids, in the order in which they ended."""

    def __init__(self) -> None:
        self.spoken: list[AdvisoryAudio] = []
        """The advisories that the assistant spoke, in the order of their beginnings."""
        self._calls: dict[str, CallRecord] = {}

    def __iter__(self) -> Iterator[CallRecord]:
        return iter(self._calls.values())

    def get(self, name: str) -> CallRecord | None:
        """Return the call with an id, None if nothing is known of it."""
        return self._calls.get(name)

    def read(self, key: str, data: bytes) -> None:
        """Add a message of a log, else as `take`; ValidationError if it is of another version."""
        model = bus_message(key)
        if model in OF_CALLS:
            self.take(model.model_validate_json(data))

    def take(self, message: Message) -> None:
        """Add a message about a call or a spoken advisory; other messages are ignored."""
        match message:
            case AdvisoryAudio():
                self.spoken.append(message)
            case SpokenTruth(id=name):
                self._call(name).said = message
            case Transmission(id=name):
                self._call(name).received = message
            case Transcript(id=name):
                self._call(name).transcripts.append(message)
            case HearingTruth(id=name):
                self._call(name).hearings.append(message)

    def _call(self, name: str) -> CallRecord:
        return self._calls.setdefault(name, CallRecord())

    def advice_spoken_s(self, is_called: Callable[[str], bool]) -> float:
        """Return for how long advisories were spoken, in s.

        `is_called` says of a recipient that it hears them on its frequency, where they are calls.
        """
        aside = (audio.duration_s for audio in self.spoken if not is_called(audio.recipient))
        called = (
            _duration_s(said)
            for call in self
            if (said := call.said) is not None and said.id.startswith(ADVISORY_CALL)
        )
        return sum(aside) + sum(called)

    # --- statistics -------------------------------------------------------------------------

    def statistics(self, callsigns: Sequence[str], *, is_recognised: bool) -> RadioStatistics:
        """Return the statistics of the radio, with the callsigns on the roster.

        Transcripts may be missing only if a recogniser took part: `is_recognised`.
        """
        spoken = [(call, said) for call in self if (said := call.said) is not None]
        words = [(call, said) for call, said in spoken if said.text]
        carriers = [
            (call, said) for call, said in spoken if not said.text and not said.is_from_microphone
        ]
        noise = [call for call, said in carriers if not said.blocked_by]
        clear = [(call, said) for call, said in words if not said.blocked_by]
        heard = [call for call, _ in clear if call.received is not None and call.received.samples]
        noise_heard = [transcript for call in noise for transcript in call.recognised]
        scores = [
            (said.snr_db, score(said.text, transcript.text, callsigns))
            for call, said in clear
            for transcript in call.recognised
        ]
        levels = sorted(
            {said.snr_db for _, said in spoken},
            key=lambda level: math.inf if level is None else level,
        )
        meant = [parse_call(said.text, callsigns) for _, said in words]
        outcomes = Counter(hearing.outcome for call, _ in spoken for hearing in call.hearings)
        return RadioStatistics(
            **recognition(
                [one for _, one in scores], levels[0] if len(levels) == 1 else None
            ).model_dump(),
            transmissions=len(spoken),
            blocked=sum(
                bool(said.blocked_by) and (bool(said.text) or said.is_from_microphone)
                for _, said in spoken
            ),
            stuck_microphone=len(carriers),
            transcripts_missing=(
                sum(not call.recognised for call in heard) if is_recognised and heard else None
            ),
            hallucinated=(
                sum(bool(transcript.text) for transcript in noise_heard) if noise_heard else None
            ),
            hearing=dict(sorted(outcomes.items())),
            occupied_s=_occupied_s([said for _, said in spoken]),
            say_agains=sum(call.kind == "say_again" for call in meant),
            clarifications=sum(call.asks_again for call in meant),
            repeats=sum(REPEAT.search(said.id) is not None for _, said in words),
            by_snr=[
                recognition([one for snr_db, one in scores if snr_db == level], level)
                for level in levels
                if scores and len(levels) > 1
            ],
        )


def _duration_s(said: SpokenTruth) -> float:
    return (said.t_end_ns - said.t_tx_ns) / SECOND_NS


def _occupied_s(spoken: Sequence[SpokenTruth]) -> float:
    """Return for how long somebody was on the air, summed over the frequencies, in s."""
    occupied_ns, free_at_ns = 0, defaultdict[int, int](int)
    for said in sorted(spoken, key=lambda one: one.t_tx_ns):
        frequency_khz, end_ns = said.frequency_khz, said.t_end_ns
        occupied_ns += max(end_ns - max(said.t_tx_ns, free_at_ns[frequency_khz]), 0)
        free_at_ns[frequency_khz] = max(end_ns, free_at_ns[frequency_khz])
    return occupied_ns / SECOND_NS
