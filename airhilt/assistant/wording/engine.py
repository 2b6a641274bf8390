"""The protocol of wordings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple, Protocol, runtime_checkable

from airhilt.assistant.decision.alerts import Alert
from airhilt.messages import ModelExchange


@runtime_checkable
class AdvisoryWording(Protocol):
    """Puts alerts into words. It changes no callsign, runway, action or severity."""

    @property
    def name(self) -> str:
        """Short name, such as ``template``."""

    def message(self, alert: Alert, recipient: str) -> str:
        """Return what one recipient of an alert is told."""


class Worded(NamedTuple):
    """The messages of all alerts of one step."""

    messages: Mapping[tuple[str, str], str]
    """Text by the id of the alert and the recipient."""
    exchanges: tuple[ModelExchange, ...] = ()
    """Questions to a language model, with their answers, that the texts come from."""


@runtime_checkable
class WordsTogether(Protocol):
    """Part that a wording may have besides: it words all alerts of a step with one question."""

    def words(self, alerts: Sequence[Alert]) -> Worded:
        """Return what all recipients of some alerts are told."""


def words(wording: AdvisoryWording, alerts: Sequence[Alert]) -> Worded:
    """Return what all recipients of some alerts are told.

    A text that an engine has written itself stays as it is.
    """
    own = {
        (alert.id, recipient): text
        for alert in alerts
        for recipient, text in alert.messages.items()
    }
    rest = [alert for alert in alerts if not set(alert.recipients) <= set(alert.messages)]
    if rest and isinstance(wording, WordsTogether):
        worded = wording.words(rest)
        return Worded({**worded.messages, **own}, worded.exchanges)
    texts = {
        (alert.id, recipient): wording.message(alert, recipient)
        for alert in rest
        for recipient in alert.recipients
    }
    return Worded({**texts, **own})
