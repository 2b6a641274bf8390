"""The reference engine in its worker, with the wording that ships."""

from __future__ import annotations

from typing import Any

from airhilt.assistant.decision.engines.reference import ReferenceConfig, ReferenceEngine
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.messages import Transcript, Word


def reference(config: ReferenceConfig | None = None, **options: Any) -> DecisionWorker:
    """Return a worker that decides by the reference rules."""
    return DecisionWorker(ReferenceEngine(config), Template(), **options)


UNSURE = 0.5
"""Confidence in a word that is followed by a question mark."""


def transcript(
    name: str, frequency_khz: int, t_tx_ns: int, t_end_ns: int, text: str, unsure: float = UNSURE
) -> Transcript:
    """Return a transcript; ``runway one? niner`` is unsure of "one"."""
    return Transcript(
        id=name,
        frequency_khz=frequency_khz,
        t_tx_ns=t_tx_ns,
        t_end_ns=t_end_ns,
        text=text.replace("?", ""),
        words=tuple(
            Word(text=word.replace("?", ""), confidence=unsure if "?" in word else 1.0)
            for word in text.split()
        ),
        confidence=1.0,
        engine="text",
    )
