"""A decision engine behind an address: `AssistantRequest` in, `AssistantAnswer` out."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping

from pydantic import TypeAdapter

from airhilt.assistant.decision.engine import ReceivedMessage, inputs_of
from airhilt.assistant.decision.service_messages import (
    AssistantAnswer,
    AssistantRequest,
    Delivery,
    EngineDecision,
    ProposedAdvisory,
)
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.errors import WorkerError
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

SERVED = "service"
"""Receiver of reports, and engine of transcripts and detections, that came with a request."""


MOST_RUNS = 32
"""Number of runs that are remembered; the one that was asked about longest ago is forgotten."""


class ServedAssistant:
    """Answers the requests of several runs, each by an engine of its own.

    Requests of one run come in the order of their times.

    Parameters
    ----------
    create
        Returns a new decision worker, whose wording words what a run with slices is told.
    """

    def __init__(self, create: Callable[[], DecisionWorker]) -> None:
        self._create = create
        self._keys = tuple(inputs_of(create().engine))
        self._runs: OrderedDict[str, ServedRun] = OrderedDict()

    def answer(self, request: AssistantRequest, run_id: str) -> AssistantAnswer:
        """Return what is decided of a delivery, or else all conflicts that hold.

        Raises
        ------
        WorkerError
            There is a delivery of a run of which nothing is known.
        """
        run = self._runs.get(run_id)
        if request.delivery is not None:
            if run is None:
                raise WorkerError(
                    f"X-Run-Id {run_id!r}: no such run is known here; expected one whose first "
                    f"request had no delivery, among the last {MOST_RUNS} runs"
                )
            self._runs.move_to_end(run_id)
            decided = run.decided(request.delivery)
            return AssistantAnswer(advisories=(), inputs=self._keys, decision=decided)
        if run is None or request.ts_ms < run.ts_ms:
            run = self._runs[run_id] = ServedRun(self._create())
        self._runs.move_to_end(run_id)
        if len(self._runs) > MOST_RUNS:
            self._runs.popitem(last=False)
        return AssistantAnswer(advisories=run.holding(request), inputs=self._keys)


class ServedRun:
    """One run, with the worker that decides in it."""

    def __init__(self, worker: DecisionWorker) -> None:
        self.ts_ms = 0
        """Time of the last request with slices."""
        self._worker, self._engine = worker, worker.engine
        self._models = {key: TypeAdapter(model) for key, model in inputs_of(self._engine).items()}
        self._known: dict[str, Part] = {}
        """Last message that was given, by what it is of."""
        self._told: dict[str, dict[str, Advisory]] = {}
        """Last advisory to each recipient, by its id."""

    def decided(self, delivery: Delivery) -> EngineDecision:
        """Return what the engine decides after the messages of a delivery."""
        for each in delivery.messages:
            found = [model for key, model in self._models.items() if is_match(each.key, key)]
            if not found:
                raise WorkerError(f"{each.key!r} is no key of the inputs; expected one of them")
            message = found[0].validate_python(each.message)
            self._engine.receive(
                ReceivedMessage(message, each.t_in_ns, each.t_ns, each.payload, each.key)
            )
        decision = self._engine.decide(delivery.t_ns)
        return EngineDecision(
            alerts=tuple(decision.alerts),
            again_ns=decision.again_ns,
            exchanges=tuple(decision.exchanges),
        )

    def holding(self, request: AssistantRequest) -> tuple[ProposedAdvisory, ...]:
        """Give the worker what is new in a request, and return all conflicts that hold."""
        self.ts_ms, t_ns = request.ts_ms, request.ts_ms * MILLISECOND_NS
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
        return tuple(
            _proposed(told)
            for told in self._told.values()
            if all(each.active for each in told.values())
        )

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
