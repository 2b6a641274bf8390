"""The synthesisers that speak calls for training and testing: each a file with a `SYNTHESISER`.

README.md beside this file has a table of their voices and licences.
"""

from __future__ import annotations

from airhilt.errors import SpeechError
from airhilt.plugins import Family
from synthesisers.synthesiser import Synthesiser

FAMILY = Family(
    "synthesiser",
    "airhilt.synthesisers",
    __name__,
    "SYNTHESISER",
    protocol=Synthesiser,
    error=SpeechError,
    not_members=frozenset({"synthesiser"}),
)


def synthesiser(name: str) -> Synthesiser:
    """Return the synthesiser of a name.

    Raises
    ------
    SpeechError
        There is none of that name, or it is not installed.
    """
    found: Synthesiser = FAMILY.load(name)
    if lacks := found.lacks():
        raise SpeechError(f"synthesiser {name}: it is not installed; install it with `{lacks}`")
    return found
