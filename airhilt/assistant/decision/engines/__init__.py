"""The decision engines: one file an engine, each with its `ENGINE`.

An engine of another package is found by an entry point of the group ``airhilt.assistants`` that
names its `airhilt.engines.Engine`, such as ``mine = "my_package.assistant:ENGINE"``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import BaseModel

from airhilt.assistant.decision.engine import DecisionEngine
from airhilt.engines import EngineFamily
from airhilt.errors import AirhiltError

FAMILY = EngineFamily[DecisionEngine](
    "assistant",
    "airhilt.assistants",
    __name__,
    "ENGINE",
    product=DecisionEngine,
)


def decision_engine(
    name: str, also: Sequence[str] = (), configuration: Mapping[str, Any] | None = None
) -> DecisionEngine:
    """Return the decision engine of a name such as ``reference``.

    Parameters
    ----------
    also
        Words that the caller takes in the place of a name, such as ``none``, for error messages.
    configuration
        Values of its configuration; None: the defaults.

    Raises
    ------
    AirhiltError
        There is none of that name, or it cannot be loaded, or its configuration is wrong.
    """
    return FAMILY.create(name, also, configuration)


def configuration_model(name: str) -> type[BaseModel]:
    """Return the model of the configuration of an engine.

    Raises
    ------
    AirhiltError
        There is no engine of that name, or it has no configuration.
    """
    engine, _ = FAMILY.choose(name)
    if engine.configuration is None:
        having = [
            each for each in FAMILY.names() if FAMILY.choose(each)[0].configuration is not None
        ]
        raise AirhiltError(
            f"assistant {name!r} has no configuration; expected one that has: {', '.join(having)}"
        )
    return engine.configuration
