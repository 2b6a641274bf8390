"""An assistant at an address: it takes slices of the situation, and answers advisories."""

from __future__ import annotations

from collections.abc import Mapping

from airhilt.assistant.decision.alert_ledger import AlertLedger
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.service_messages import (
    AssistantAnswer,
    AssistantRequest,
    ProposedAdvisory,
)
from airhilt.assistant.decision.slices import INPUTS, READS, Slices
from airhilt.engines import Engine
from airhilt.errors import WorkerError
from airhilt.host.service_headers import ServiceHeaders
from airhilt.host.services import USAGE, HttpService, is_service, key_of
from airhilt.messages import Message, Transcript
from airhilt.units import SECOND_NS

KEY_VARIABLE = "AIRHILT_ASSISTANT_KEY"
"""Environment variable with the key of the service; it is sent, and written nowhere."""
EXPECTED = "an AssistantAnswer, see `airhilt schema --services`"
TIMEOUT_S = 5.0
"""Wall time for one answer: that of ``--step-timeout``."""
MAXIMUM_BYTES = 1_000_000
"""Size of the largest answer."""
PERIOD_NS = SECOND_NS
"""Least time between two requests, unless a call was recognised."""


class HttpAssistant:
    """Asks a service that answers POST requests with `AssistantRequest` by `AssistantAnswer`.

    It is asked when a call was recognised, and otherwise once a second while something arrives. The
    third request in a row without a valid answer ends it.
    """

    name = "http"
    reads: tuple[type[Message], ...] = READS
    inputs: Mapping[str, object] = INPUTS

    def __init__(self, url: str, timeout_s: float = TIMEOUT_S) -> None:
        key = key_of(KEY_VARIABLE, "assistant http", WorkerError)
        self._service = HttpService(
            "assistant http", url, timeout_s, MAXIMUM_BYTES, WorkerError, key
        )
        self._slices = Slices()
        self._ledger = AlertLedger()
        self._due_ns: int | None = None
        """Time of the next request; None if nothing has arrived since the last one."""
        self._earliest_ns = 0

    def receive(self, received: ReceivedMessage) -> None:
        """Keep one message for the next request."""
        self._slices.receive(received)
        is_call = isinstance(received.message, Transcript)
        due_ns = received.t_ns if is_call else max(received.t_ns, self._earliest_ns)
        self._due_ns = due_ns if self._due_ns is None else min(self._due_ns, due_ns)

    def decide(self, t_ns: int) -> Decision:
        """Return what the service says that is new, has changed, or is over."""
        if self._due_ns is None or t_ns < self._due_ns:
            return Decision(again_ns=self._due_ns)
        self._due_ns, self._earliest_ns = None, t_ns + PERIOD_NS
        answer = self._ask(self._slices.request(t_ns))
        news = self._ledger.update([_alert(each) for each in answer.advisories])
        return Decision([self._slices.checks.marked(each, t_ns) for each in news])

    def probe(self) -> None:
        """Ask about the time before the run, of which nothing is known.

        Raises
        ------
        WorkerError
            There is no service, or its answer is none.
        """
        self._ask(AssistantRequest(ts_ms=0, context=None, radio=(), cameras=(), tracks=()))

    def _ask(self, request: AssistantRequest) -> AssistantAnswer:
        context = request.context
        headers = ServiceHeaders(
            ts_ms=request.ts_ms,
            callsigns=None if context is None else tuple(one.callsign for one in context.roster),
        )
        body = request.model_dump_json().encode()
        with self._service.attempt():
            data = self._service.post(body, "application/json", headers.encoded())
            return self._service.parsed(data, AssistantAnswer, EXPECTED)


def _alert(proposed: ProposedAdvisory) -> Alert:
    return Alert(
        id=proposed.id,
        revision=0,
        kind=proposed.kind,
        severity=proposed.severity,
        recipients=tuple(dict.fromkeys(proposed.recipients)),
        traffic=proposed.traffic,
        evidence=proposed.evidence,
        recommendations=proposed.recommendations,
        messages=proposed.messages,
    )


ENGINE = Engine(
    name="http",
    summary="service that takes JSON and answers advisories",
    create=HttpAssistant,
    takes=is_service,
    usage=USAGE,
    is_remote=True,
    probe=lambda url: HttpAssistant(url).probe(),
)
