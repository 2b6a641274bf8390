"""The assistants of an evaluation, and the scenarios in which each has something to read."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from fnmatch import fnmatch
from functools import cache
from typing import Literal

from airhilt.host import library
from airhilt.options import MODALITIES
from airhilt.scenario import Scenario
from airhilt.scenario.models import WildlifeSpec
from airhilt.world.loading import load

Equipped = Literal["any", "transponder", "adsb"]
"""Equipment that both of the annotated pair must have."""
ALL = "+".join(MODALITIES)
SURVEILLANCE = "adsb"
CALLS = "asr"


@dataclass(frozen=True)
class Assistant:
    """An assistant, and where it applies.

    Attributes
    ----------
    pattern
        Names of the scenarios that it is made for: those on runways (``s01*``), those in the air
        (``s02*``), or all.
    equipped
        Equipment of the pair without which it has nothing to read of them.
    modalities
        Modalities that it reads; workers of the others need not run.
    """

    name: str
    pattern: str = "*"
    equipped: Equipped = "any"
    modalities: str = ALL

    @property
    def label(self) -> str:
        """Name of its sweeps and rows: its own, or its address without what no folder may have."""
        return re.sub(r"[^A-Za-z0-9_.-]+", "_", self.name).strip("_")

    def applies_to(self, scenario: Scenario) -> bool:
        """Return whether it is made for a scenario, and has something to read there."""
        if not fnmatch(scenario.name, self.pattern):
            return False
        specs = {spec.callsign: spec for spec in scenario.actors}
        return all(_has(specs[callsign], self.equipped) for callsign in scenario.pair or ())


def _has(spec: object, equipped: Equipped) -> bool:
    if equipped == "any":
        return True
    if isinstance(spec, WildlifeSpec):
        return False
    transponder = spec.transponder  # type: ignore[attr-defined]  # aircraft and vehicles
    return bool(transponder.has_adsb if equipped == "adsb" else transponder.equipped)


REFERENCE = Assistant("reference")
ASSISTANTS = (
    REFERENCE,
    Assistant("paper", "s01*"),
    Assistant("adsb_only", equipped="adsb", modalities=SURVEILLANCE),
    Assistant("tcas", "s02*", "transponder", SURVEILLANCE),
    Assistant("well_clear", "s02*", "adsb", SURVEILLANCE),
    Assistant("surf_a", "s01*", "adsb", SURVEILLANCE),
    Assistant("runway_status_lights", "s01*", modalities=SURVEILLANCE),
)
"""Assistants that are compared, in the order of the tables."""
CONTROLS = (
    Assistant("silent", modalities=CALLS),
    Assistant("cry_wolf", modalities=CALLS),
)
"""Negative controls: who says nothing, and who warns of everything."""


@cache
def shipped_scenarios() -> Mapping[str, Scenario]:
    """Return the scenarios that ship with AIRHILT, by name, sorted; they are read once."""
    return {
        name: load(library.find("scenarios", name)) for name in sorted(library.names("scenarios"))
    }
