"""The protocol of wordings."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from airhilt.assistant.decision.alerts import Alert


@runtime_checkable
class AdvisoryWording(Protocol):
    """Puts alerts into words. It changes no callsign, runway, action or severity."""

    @property
    def name(self) -> str:
        """Short name, such as ``template``."""
        ...

    def message(self, alert: Alert, recipient: str) -> str:
        """Return what one recipient of an alert is told."""
        ...
