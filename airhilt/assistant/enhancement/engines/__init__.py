"""The speech enhancers: one file an engine, each with its `ENGINE`.

An enhancer of another package is found by an entry point of the group ``airhilt.enhancers`` that
names its `airhilt.engines.Engine`, such as ``mine = "my_package.enhancer:ENGINE"``.
"""

from __future__ import annotations

from airhilt.assistant.enhancement.engine import Enhancer
from airhilt.engines import EngineFamily
from airhilt.errors import SpeechError

FAMILY = EngineFamily[Enhancer](
    "enhancer", "airhilt.enhancers", __name__, "ENGINE", error=SpeechError, product=Enhancer
)


def enhancer(name: str) -> Enhancer:
    """Return the enhancer of a name such as ``spectral``.

    Raises
    ------
    SpeechError
        There is none of that name, or it cannot be loaded.
    """
    return FAMILY.create(name)
