"""An assistant at an address: it takes slices of the situation, and answers advisories.

One that asks for messages, as AIRHILT's own do, gets those that an engine in the run would get, at
the same instants, and answers the same alerts.
"""

from __future__ import annotations

import base64
import secrets
from collections.abc import Mapping, Sequence
from typing import Any

from airhilt.assistant.decision.alert_ledger import AlertLedger
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, DecisionEngine, ReceivedMessage
from airhilt.assistant.decision.service_messages import (
    AssistantAnswer,
    AssistantRequest,
    DeliveredMessage,
    Delivery,
    ProposedAdvisory,
)
from airhilt.assistant.decision.slices import INPUTS, READS, Slices
from airhilt.engines import Engine
from airhilt.errors import AirhiltError, WorkerError
from airhilt.host.service_headers import ServiceHeaders
from airhilt.host.services import USAGE, HttpService, is_service, key_of
from airhilt.messages import Message, Transcript
from airhilt.units import MILLISECOND_NS, SECOND_NS

KEY_VARIABLE = "AIRHILT_ASSISTANT_KEY"
"""Environment variable with the key of the service; it is sent, and written nowhere."""
EXPECTED = "an AssistantAnswer, see `airhilt schema --services`"
TIMEOUT_S = 5.0
"""Wall time for one answer: that of ``--step-timeout``."""
MAXIMUM_BYTES = 1_000_000
"""Size of the largest answer."""
PERIOD_NS = SECOND_NS
"""Least time between two requests, unless a call was recognised."""


class AssistantService:
    """A service that answers POST requests with `AssistantRequest` by `AssistantAnswer`.

    The third request in a row without a valid answer ends it.
    """

    def __init__(self, url: str, timeout_s: float = TIMEOUT_S) -> None:
        key = key_of(KEY_VARIABLE, "assistant http", WorkerError)
        self._service = HttpService(
            "assistant http", url, timeout_s, MAXIMUM_BYTES, WorkerError, key
        )
        self._run_id = secrets.token_hex(8)

    def introduction(self) -> AssistantAnswer:
        """Return the answer about the time before the run, of which nothing is known.

        Raises
        ------
        WorkerError
            There is no service, or its answer is none.
        """
        return self.ask(AssistantRequest(ts_ms=0, context=None, radio=(), cameras=(), tracks=()))

    def ask(self, request: AssistantRequest) -> AssistantAnswer:
        """Return the answer to a request."""
        context = request.context
        headers = ServiceHeaders(
            run_id=self._run_id,
            ts_ms=request.ts_ms,
            callsigns=None if context is None else tuple(one.callsign for one in context.roster),
        )
        body = request.model_dump_json().encode()
        with self._service.attempt():
            data = self._service.post(body, "application/json", headers.encoded())
            return self._service.parsed(data, AssistantAnswer, EXPECTED)

    def lacks(self, what: str) -> AirhiltError:
        """Return the error of an answer that lacks something."""
        return self._service.error(f"answered without {what}", EXPECTED)


class HttpAssistant:
    """Asks a service with slices.

    It is asked when a call was recognised, and otherwise once a second while something arrives.
    """

    name = "http"
    reads: tuple[type[Message], ...] = READS
    inputs: Mapping[str, object] = INPUTS

    def __init__(self, service: AssistantService) -> None:
        self._service = service
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
        answer = self._service.ask(self._slices.request(t_ns))
        news = self._ledger.update([_alert(each) for each in answer.advisories])
        return Decision([self._slices.checks.marked(each, t_ns) for each in news])


class HttpEngine:
    """Asks a service that wants messages: what arrives is given to it whenever an engine decides.

    What a request that failed has brought comes again with the next one.

    Parameters
    ----------
    keys
        Keys of the messages that the service wants.
    """

    name = "http"
    reads: tuple[type[Message], ...] = ()

    def __init__(self, service: AssistantService, keys: Sequence[str]) -> None:
        self.inputs: Mapping[str, object] = dict.fromkeys(keys, Any)
        self._service = service
        self._waiting: list[DeliveredMessage] = []

    def receive(self, received: ReceivedMessage) -> None:
        """Keep one message for the next request."""
        message: Any = received.message
        self._waiting.append(
            DeliveredMessage(
                key=received.key,
                t_in_ns=received.t_in_ns,
                t_ns=received.t_ns,
                message=message if isinstance(message, dict) else message.model_dump(mode="json"),
                payload=base64.b64encode(received.payload),
            )
        )

    def decide(self, t_ns: int) -> Decision:
        """Return what the service decides."""
        request = AssistantRequest(
            ts_ms=t_ns // MILLISECOND_NS,
            context=None,
            radio=(),
            cameras=(),
            tracks=(),
            delivery=Delivery(t_ns=t_ns, messages=tuple(self._waiting)),
        )
        decided = self._service.ask(request).decision
        if decided is None:
            raise self._service.lacks("a decision, though it asked for messages")
        self._waiting.clear()
        return Decision(decided.alerts, decided.again_ns, decided.exchanges)


def assistant_at(url: str) -> DecisionEngine:
    """Return the engine that asks a service as it wants to be asked.

    Raises
    ------
    WorkerError
        There is no service, or its answer is none.
    """
    service = AssistantService(url)
    keys = service.introduction().inputs
    return HttpEngine(service, keys) if keys else HttpAssistant(service)


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
    create=assistant_at,
    takes=is_service,
    usage=USAGE,
    is_remote=True,
)
