"""A decision engine behind an address: `AssistantRequest` in, `AssistantAnswer` out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from airhilt.assistant.decision.service_messages import (
    AssistantAnswer,
    AssistantRequest,
    ProposedAdvisory,
)
from airhilt.messages import (
    AdsbReport,
    Advisory,
    Briefing,
    Detections,
    Message,
    Part,
    Transcript,
    is_match,
)
from airhilt.sim.worker import Input
from airhilt.units import MILLISECOND_NS
from airhilt.workers.protocol import Worker

SERVED = "service"
"""Receiver of reports, and engine of transcripts and detections, that came with a request."""


class ServedAssistant:
    """Gives a decision worker what is new in each request, and answers all that holds.

    Requests of one run come in the order of their times. One of an earlier time begins a new run.

    Parameters
    ----------
    create
        Returns a new decision worker.
    """

    def __init__(self, create: Callable[[], Worker]) -> None:
        self._create = create
        self._t_ns = 0
        """Time of the last request."""
        self._begin()

    def answer(self, request: AssistantRequest) -> AssistantAnswer:
        """Return all conflicts that hold."""
        t_ns = request.ts_ms * MILLISECOND_NS
        if t_ns < self._t_ns:
            self._begin()
        self._t_ns = t_ns
        keys = [each.key for each in self._worker.description.inputs]
        news = [
            Input(key, t_ns, message.model_dump_json().encode())
            for key, message in self._news(request)
            if any(is_match(key, pattern) for pattern in keys)
        ]
        for output in self._worker.step(t_ns, news).outputs:
            if output.key.startswith("advisory/"):
                advisory = Advisory.model_validate_json(output.payload)
                self._told.setdefault(advisory.id, {})[advisory.recipient] = advisory
        holding = [
            _proposed(told)
            for told in self._told.values()
            if all(each.active for each in told.values())
        ]
        return AssistantAnswer(advisories=tuple(holding))

    def _begin(self) -> None:
        self._worker = self._create()
        self._known: dict[str, Part] = {}
        """Last message that was given, by what it is of."""
        self._told: dict[str, dict[str, Advisory]] = {}
        """Last advisory to each recipient, by its id."""

    def _news(self, request: AssistantRequest) -> Iterator[tuple[str, Message]]:
        """Yield the messages that a request is made of and that have not been given yet."""
        for name, key, message in _messages(request):
            if self._known.get(name) != message:
                self._known[name] = message
                yield key, message


def _messages(request: AssistantRequest) -> Iterator[tuple[str, str, Message]]:
    """Yield what each message is of, its key, and the message."""
    if request.context is not None:
        yield "briefing", "briefing", Briefing(**request.context.model_dump())
    for track in request.tracks:
        t_ns = track.ts_ms * MILLISECOND_NS
        report = AdsbReport(
            **track.model_dump(exclude={"ts_ms"}),
            t_ns=t_ns,
            receiver=SERVED,
            t_adsb_in_ns=t_ns,
            t_adsb_out_ns=t_ns,
        )
        yield f"adsb/{track.icao24}", f"adsb/{track.icao24}", report
    for camera in request.cameras:
        t_ns = camera.ts_ms * MILLISECOND_NS
        seen = Detections(
            t_ns=t_ns,
            camera=camera.camera_id,
            seq=camera.ts_ms,
            t_frame_ns=t_ns,
            view=camera.view,
            detections=camera.detections,
            engine=SERVED,
        )
        yield f"vision/{camera.camera_id}/{t_ns}", f"vision/{camera.camera_id}", seen
    for turn in request.radio:
        transcript = Transcript(
            t_ns=turn.end_ms * MILLISECOND_NS,
            id=turn.turn_id,
            frequency_khz=turn.frequency_khz,
            t_tx_ns=turn.ts_ms * MILLISECOND_NS,
            t_end_ns=turn.end_ms * MILLISECOND_NS,
            text=turn.text,
            words=turn.words,
            confidence=turn.confidence,
            engine=SERVED,
            speaker=turn.speaker,
            addressee=turn.addressed_callsign,
            overheard=turn.overheard,
        )
        yield f"radio/{turn.turn_id}", f"asr/{turn.frequency_khz}", transcript


def _proposed(told: Mapping[str, Advisory]) -> ProposedAdvisory:
    """Return the advisories of one conflict to all its recipients as one."""
    first = next(iter(told.values()))
    return ProposedAdvisory(
        id=first.id.partition("-")[2],
        kind=first.kind,
        severity=first.severity,
        recipients=first.recipients,
        traffic=first.traffic,
        messages={each: told[each].message for each in first.recipients if each in told},
        recommendations={
            each: advice
            for each in first.recipients
            if each in told and (advice := told[each].recommendation) is not None
        },
        evidence=first.evidence,
    )
