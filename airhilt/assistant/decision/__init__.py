"""The reference decision worker: ADS-B, radio text and what cameras show in, advisories out."""

from airhilt.assistant.decision.engine import DecisionConfig, DecisionWorker

__all__ = ["DecisionConfig", "DecisionWorker"]
