"""Scenarios cut short, as documents of files: no line of theirs comes after the end."""

from __future__ import annotations

import math
from typing import Any


def shortened(document: dict[str, Any], duration_s: float) -> dict[str, Any]:
    """Return a scenario with another duration; lines after it are due at its very end."""
    radio = document.get("radio", {})
    last_s = math.nextafter(duration_s, 0.0)
    lines = [_due_by(last_s, {"at_s": 0.0} | line) for line in radio.get("lines", [])]
    return document | {"duration_s": duration_s, "radio": radio | {"lines": lines}}


def _due_by(last_s: float, part: Any) -> Any:
    """Return a line, or a part of its condition, with no time after the last."""
    if isinstance(part, list):
        return [_due_by(last_s, each) for each in part]
    if not isinstance(part, dict):
        return part
    return {
        name: min(value, last_s) if name == "at_s" else _due_by(last_s, value)
        for name, value in part.items()
    }
