"""Shipped scenarios that fly as their files say, for tests of what comes of that very geometry."""

from __future__ import annotations

from airhilt import load
from airhilt.scenario import Scenario


def nominal(name: str) -> Scenario:
    """Return a shipped scenario without perturbations: all seeds fly it alike."""
    return load(name).model_copy(update={"perturbations": ()})
