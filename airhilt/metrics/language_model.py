"""Questions to a language model, counted."""

from __future__ import annotations

from airhilt.messages import Message, ModelExchange
from airhilt.metrics.summary import LanguageModelStatistics


class LanguageModelRecords:
    """Counts the answers of a language model, and what of them was not used."""

    def __init__(self) -> None:
        self._exchanges: list[ModelExchange] = []

    def take(self, message: Message) -> None:
        """Receive a published message."""
        if isinstance(message, ModelExchange):
            self._exchanges.append(message)

    def statistics(self) -> LanguageModelStatistics | None:
        """Return the numbers of the run; None if no model was asked."""
        if not self._exchanges:
            return None
        return LanguageModelStatistics(
            model=self._exchanges[0].model,
            questions=len(self._exchanges),
            failures=sum(bool(each.failure) for each in self._exchanges),
            rejections=sum(len(each.rejections) for each in self._exchanges),
        )
