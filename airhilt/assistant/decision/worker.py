"""The worker around a decision engine: keys, the fusion gate, and advisories in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from pydantic import TypeAdapter

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import (
    KEYS,
    DecisionEngine,
    HasConfiguration,
    ReceivedMessage,
    inputs_of,
)
from airhilt.assistant.decision.fusion import FusionGate
from airhilt.assistant.wording.engine import AdvisoryWording, words
from airhilt.messages import (
    ADVISORY_CALL,
    CONTROLLER,
    Advisory,
    DeclaredLatency,
    InputSpec,
    ModelExchange,
    Recommendation,
    Status,
    Told,
    Transcript,
    Transmission,
    WorkerDescription,
    is_match,
)
from airhilt.sim.worker import Input, Output
from airhilt.workers.pool import require_open_key
from airhilt.workers.protocol import Step


class DecisionWorker:
    """Gives what arrives to a decision engine, and publishes its alerts as advisories.

    Attributes
    ----------
    engine
        The decision engine.

    Parameters
    ----------
    told
        Who is told of conflicts; None: whom the engine tells.
    is_gated
        True to tell nothing while a transcript is to come: the topology ``gated_fusion``.

    Raises
    ------
    WorkerError
        The engine wants truth, or messages without saying on which key they are.
    """

    def __init__(
        self,
        engine: DecisionEngine,
        wording: AdvisoryWording,
        *,
        told: Told | None = None,
        is_gated: bool = False,
        name: str = "decision",
    ) -> None:
        self._name = name
        self.engine = engine
        self._wording = wording
        self._told = told
        self._gate = FusionGate() if is_gated else None
        read = inputs_of(engine)
        self._read = frozenset(read)
        gates = (Transcript, Transmission, Status) if is_gated else ()
        gating = {KEYS[model]: model for model in gates}
        self._models: dict[str, TypeAdapter[Any]] = {
            key: TypeAdapter(model) for key, model in (read | gating).items()
        }
        self._patterns: dict[str, str] = {}
        """Pattern in `_models` of each key that has been seen."""
        self.description = WorkerDescription(
            name=name,
            modality="decision",
            inputs=tuple(InputSpec(key=key, policy="batch") for key in self._models),
            latency=DeclaredLatency(median_s=0.15, sigma=0.3),
            engine=engine.name,
            configuration=engine.configuration.model_dump(mode="json")
            if isinstance(engine, HasConfiguration)
            else {},
        )
        for wanted in self.description.inputs:
            require_open_key(name, wanted.key)

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        """Give the engine what has arrived, and publish what has changed."""
        for item in inputs:
            self._give(t_ns, item)
        if self._gate is not None:
            opens_ns = self._gate.opens_ns(t_ns)
            if opens_ns is not None:
                return Step((), wake_ns=opens_ns)
        t_ready_ns = max((item.t_in_ns for item in inputs), default=t_ns)
        decision = self.engine.decide(t_ns)
        alerts = [self._addressed(alert) for alert in decision.alerts]
        worded = words(self._wording, alerts)
        advisories = (
            self._advisory(alert, recipient, worded.messages[alert.id, recipient], t_ready_ns)
            for alert in alerts
            for recipient in alert.recipients
        )
        told = [
            Output(f"advisory/{each.recipient}", each.model_dump_json().encode())
            for each in advisories
        ]
        answers = self._answers([*decision.exchanges, *worded.exchanges])
        return Step((*told, *answers), wake_ns=decision.again_ns)

    def _give(self, t_ns: int, item: Input) -> None:
        pattern = self._patterns.get(item.key)
        if pattern is None:
            pattern = next(pattern for pattern in self._models if is_match(item.key, pattern))
            self._patterns[item.key] = pattern
        model, header = self._models[pattern], item.attachment
        message = (
            model.validate_json(item.payload) if header is None else model.validate_python(header)
        )
        name = message.get("id") if isinstance(message, dict) else getattr(message, "id", "")
        if str(name).startswith(ADVISORY_CALL):
            return  # It knows what it has said itself.
        if self._gate is not None:
            self._gate.receive(message)
        if pattern in self._read:
            raw = b"" if header is None else item.payload
            self.engine.receive(ReceivedMessage(message, item.t_in_ns, t_ns, raw, item.key))

    def _answers(self, exchanges: Sequence[ModelExchange]) -> Iterator[Output]:
        for exchange in exchanges:
            ids = tuple(f"{self._name}-{each}" for each in exchange.advisories)
            named = exchange.model_copy(update={"advisories": ids})
            yield Output(f"llm/{self._name}", named.model_dump_json().encode())

    def _addressed(self, alert: Alert) -> Alert:
        """Return an alert to those who are told of conflicts; they may be none."""
        crews = tuple(each for each in alert.recipients if each != CONTROLLER)
        match self._told:
            case None:
                return alert
            case "crew":
                recipients = crews
            case "controller":
                recipients = (CONTROLLER,)
            case "both":
                recipients = (*crews, CONTROLLER)
        messages = {each: text for each, text in alert.messages.items() if each in recipients}
        return replace(alert, recipients=recipients, messages=messages)

    def _advisory(self, alert: Alert, recipient: str, message: str, t_ready_ns: int) -> Advisory:
        return Advisory(
            id=f"{self._name}-{alert.id}",
            revision=alert.revision,
            recipient=recipient,
            recipients=alert.recipients,
            kind=alert.kind,
            severity=alert.severity,
            active=alert.active,
            traffic=alert.traffic,
            message=message,
            recommendation=alert.recommendations.get(recipient),
            recommendations=_of_traffic(alert) if recipient == CONTROLLER else {},
            evidence=alert.evidence,
            t_ready_ns=t_ready_ns if alert.t_ready_ns is None else alert.t_ready_ns,
        )


def _of_traffic(alert: Alert) -> dict[str, Recommendation]:
    """Return what is recommended to aircraft and vehicles, which the controller may pass on."""
    recommended = alert.recommendations.items()
    return {callsign: each for callsign, each in recommended if callsign != CONTROLLER}
