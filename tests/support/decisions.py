"""The reference engine in its worker, with the wording that ships."""

from __future__ import annotations

from typing import Any

from airhilt.assistant.decision.engines.reference import ReferenceConfig, ReferenceEngine
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template


def reference(config: ReferenceConfig | None = None, **options: Any) -> DecisionWorker:
    """Return a worker that decides by the reference rules."""
    return DecisionWorker(ReferenceEngine(config), Template(), **options)
