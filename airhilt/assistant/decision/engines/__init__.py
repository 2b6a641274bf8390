"""The decision engines: one file an engine, each with its `ENGINE`.

An engine of another package is found by an entry point of the group ``airhilt.assistants`` that
names its `airhilt.engines.Engine`, such as ``mine = "my_package.assistant:ENGINE"``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from airhilt.assistant.decision.engine import DecisionEngine
from airhilt.engine_families import ASSISTANTS
from airhilt.engines import EngineFamily

FAMILY: EngineFamily[DecisionEngine] = ASSISTANTS


def decision_engine(name: str, configuration: Mapping[str, Any] | None = None) -> DecisionEngine:
    """Return the decision engine of a name such as ``reference``.

    Parameters
    ----------
    configuration
        Values of its configuration; None: the defaults.

    Raises
    ------
    AirhiltError
        There is none of that name, or it cannot be loaded, or its configuration is wrong.
    """
    return FAMILY.create(name, configuration)
