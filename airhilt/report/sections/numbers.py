"""The headline numbers of the summary, and the state of each modality."""

from __future__ import annotations

import json
from typing import Any

from airhilt.record import Logged, RunFolder
from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section


class Modalities(Content):
    """The last state of each modality, under its present name."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._states: dict[str, str] = {}

    def take(self, logged: Logged) -> None:
        """Receive a `Status`."""
        status = json.loads(logged.data)
        self._states[status["modality"]] = status["state"]

    def as_json(self, run: RunData) -> dict[str, Any]:
        """Return the states in the order of the log; those of the summary count."""
        final = {} if run.summary is None else run.summary.modalities
        return {"modalities": self._states | final}


SECTION = Section("numbers", order=20, module=__file__, content=Modalities, keys=("status/",))
