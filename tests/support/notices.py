"""An observer that keeps what a run tells its user."""

from __future__ import annotations

from airhilt.cosim.observer import Observer


class Notices(Observer):
    """Keeps all notices."""

    def __init__(self) -> None:
        self.texts: list[str] = []

    def notice(self, text: str) -> None:
        """Keep a notice."""
        self.texts.append(text)
