"""Notices about answers of a language model that were not used."""

from __future__ import annotations

from collections.abc import Callable

from airhilt.messages import Message, ModelExchange


class LanguageModelNotices:
    """Gives one notice of the first answer that is missing, and one of the first rejected one.

    The log has all of them.

    Parameters
    ----------
    notice
        Called with the text of a notice.
    """

    def __init__(self, notice: Callable[[str], None]) -> None:
        self._notice = notice
        self._told: set[str] = set()

    def take(self, publisher: str, message: Message) -> None:
        """Receive a message with the name of its publisher."""
        if not isinstance(message, ModelExchange):
            return
        if message.failure:
            self._tell(publisher, "failure", f"{message.failure}; the rules do without it")
        elif message.rejections:
            first = message.rejections[0]
            what = f"{first.subject}: {first.answered!r} is refused"
            self._tell(publisher, "rejection", f"{what}: {first.reason}; the rules stand")

    def _tell(self, publisher: str, kind: str, text: str) -> None:
        if kind not in self._told:
            self._told.add(kind)
            self._notice(f"worker {publisher!r}: {text}; see llm/{publisher} in log.mcap")
