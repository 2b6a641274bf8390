"""The reference decision worker: ADS-B and radio text in, advisories out."""

from airhilt.workers.decision.engine import DecisionConfig, DecisionWorker

__all__ = ["DecisionConfig", "DecisionWorker"]
