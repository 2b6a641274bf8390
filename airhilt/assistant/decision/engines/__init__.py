"""The decision engines: one file an engine, each with its `ENGINE`.

An engine of another package is found by an entry point of the group ``airhilt.assistants`` that
names its `airhilt.engines.Engine`, such as ``mine = "my_package.assistant:ENGINE"``.
"""

from __future__ import annotations

from airhilt.assistant.decision.engine import DecisionEngine
from airhilt.engines import EngineFamily

FAMILY = EngineFamily[DecisionEngine](
    "assistant",
    "airhilt.assistants",
    __name__,
    "ENGINE",
    product=DecisionEngine,
    also=("none", "external"),
)


def decision_engine(name: str) -> DecisionEngine:
    """Return the decision engine of a name such as ``reference``.

    Raises
    ------
    AirhiltError
        There is none of that name, or it cannot be loaded.
    """
    return FAMILY.create(name)
