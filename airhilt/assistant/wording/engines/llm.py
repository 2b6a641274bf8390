"""A language model rewords the messages of the template, and a check refuses what it changes.

The model is given the template's messages alone: no transcript, no track. What it answers is read
by the project's phraseology (`airhilt.assistant.wording.fidelity`). A message that it changes, and
all messages if it does not answer in time, are spoken as the template has them.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from pydantic import BaseModel, RootModel

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.language_model import LanguageModel, LanguageModelSettings
from airhilt.assistant.wording.engine import Worded
from airhilt.assistant.wording.engines.template import Template
from airhilt.assistant.wording.fidelity import LONGEST, change
from airhilt.engines import Engine
from airhilt.messages import SPEAK_MIN_LEVEL, ModelExchange, Rejection, Severity

INSTRUCTIONS = (
    "You reword advisories to pilots and air traffic controllers, so that they are understood at "
    "the first hearing. You are given JSON with messages by key. Answer with JSON of the same "
    "keys: the severity unchanged, and the text in one short sentence. Keep every callsign, "
    "runway, number and action as it is written, in the same order. Begin with the callsign that "
    "the message begins with, and put the action where the message has it: who is to act first "
    "hears what to do, then why. Add nothing, and leave out nothing."
)


class _Reworded(BaseModel):
    severity: str
    text: str


class _Answer(RootModel[dict[str, _Reworded]]):
    """The reworded messages, by key."""


class _Asked(NamedTuple):
    """One message of the template that the model is to reword."""

    alert: Alert
    recipient: str
    text: str


class LanguageModelWording:
    """Rewords what is spoken: alerts that are active and at least a CAUTION."""

    name = "llm"

    def __init__(self) -> None:
        self._template = Template()
        self._model: LanguageModel | None = None

    def use(self, settings: LanguageModelSettings) -> None:
        """Ask this language model."""
        self._model = LanguageModel(settings)

    def message(self, alert: Alert, recipient: str) -> str:
        """Return what one recipient of an alert is told, without asking the model."""
        return self._template.message(alert, recipient)

    def words(self, alerts: Sequence[Alert]) -> Worded:
        """Return what all recipients are told, with one question for all of them."""
        messages = {
            (alert.id, recipient): self._template.message(alert, recipient)
            for alert in alerts
            for recipient in alert.recipients
        }
        spoken = [
            _Asked(alert, recipient, messages[alert.id, recipient])
            for alert in alerts
            if alert.active and alert.severity.rank >= SPEAK_MIN_LEVEL.rank
            for recipient in alert.recipients
        ]
        if not spoken or self._model is None:
            return Worded(messages)
        asked = {f"m{number}": each for number, each in enumerate(spoken, start=1)}
        reworded, exchange = _reworded(self._model, asked)
        return Worded({**messages, **reworded}, (exchange,))


def _reworded(
    model: LanguageModel, asked: Mapping[str, _Asked]
) -> tuple[dict[tuple[str, str], str], ModelExchange]:
    """Return the texts that the model has reworded without changing them, and its answer."""
    question = json.dumps(
        {key: {"severity": each.alert.severity, "text": each.text} for key, each in asked.items()}
    )
    exchange = ModelExchange(
        model=model.name,
        task="wording",
        advisories=tuple(dict.fromkeys(each.alert.id for each in asked.values())),
        question=question,
        answer=None,
    )
    answer, exchange = model.answer_to(exchange, INSTRUCTIONS, _schema(asked), _Answer)
    if answer is None:
        return {}, exchange
    kept: dict[tuple[str, str], str] = {}
    rejections: list[Rejection] = []
    for key, each in asked.items():
        reworded = answer.root.get(key)
        why = _refused(each, reworded)
        if reworded is not None and not why:
            kept[each.alert.id, each.recipient] = reworded.text.strip()
            continue
        answered = "" if reworded is None else f"{reworded.severity}: {reworded.text}"
        subject = f"{each.alert.id} to {each.recipient}"
        rejections.append(Rejection(subject=subject, answered=answered, reason=why))
    return kept, exchange.model_copy(update={"rejections": tuple(rejections)})


def _refused(asked: _Asked, reworded: _Reworded | None) -> str:
    severity = asked.alert.severity
    if reworded is None:
        return "it is missing in the answer"
    if reworded.severity != severity:
        return f"it changes the severity: {reworded.severity}; expected {severity}"
    return change(asked.text, reworded.text.strip(), asked.recipient, severity)


def _schema(asked: Mapping[str, _Asked]) -> dict[str, Any]:
    message = {
        "type": "object",
        "properties": {
            "severity": {"type": "string", "enum": [each.value for each in Severity]},
            "text": {"type": "string", "pattern": f"^[A-Za-z0-9 ,.;:'/-]{{1,{LONGEST}}}$"},
        },
        "required": ["severity", "text"],
        "additionalProperties": False,
    }
    return {
        "type": "object",
        "properties": dict.fromkeys(asked, message),
        "required": list(asked),
        "additionalProperties": False,
    }


ENGINE = Engine(
    name="llm",
    summary="a language model rewords the template; asks the endpoint of --llm",
    create=lambda _: LanguageModelWording(),
    is_remote=True,
)
