"""JSON that anybody may have written: its size and its number of values are bounded first."""

from __future__ import annotations

import json
from typing import Any

MOST_BYTES = 32_000_000
"""Size of the largest document that is read."""
MOST_VALUES = 500_000
"""Greatest number of values in a document: each takes many times its size in memory."""


def parse(data: bytes) -> Any:
    """Return the document in a JSON text.

    Raises
    ------
    ValueError
        It is not JSON in UTF-8, is nested too deeply, or has too many values.
    """
    require_few_values(data)
    try:
        return json.loads(data.decode("utf-8-sig"))
    except RecursionError:
        raise ValueError("nested too deeply") from None


def require_few_values(data: bytes) -> None:
    """Raise ValueError for too many values, before anything is made of the text.

    Commas and brackets inside its texts count too.
    """
    if sum(map(data.count, (b",", b"[", b"{"))) >= MOST_VALUES:
        raise ValueError(f"found over {MOST_VALUES:,} values; expected fewer")
