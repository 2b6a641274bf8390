"""The negative control that never says anything."""

from __future__ import annotations

from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.engines import Engine
from airhilt.messages import Briefing, Message


class SilentEngine:
    """Is given the briefing, and warns nobody: what it avoids would not have come about."""

    name = "silent"
    reads: tuple[type[Message], ...] = (Briefing,)

    def receive(self, received: ReceivedMessage) -> None:
        """Take in a message, and do nothing with it."""

    def decide(self, t_ns: int) -> Decision:  # noqa: ARG002
        """Return no alerts."""
        return Decision()


ENGINE = Engine(
    name="silent",
    summary="warns nobody, as a negative control",
    create=lambda _: SilentEngine(),
)
