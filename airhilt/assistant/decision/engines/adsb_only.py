"""The baseline that has ADS-B alone: the reference engine without its ears and eyes."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from airhilt.assistant.decision.engines.reference import ReferenceConfig, ReferenceEngine
from airhilt.engines import Engine
from airhilt.messages import AdsbReport, Briefing, Message


class AdsbOnlyEngine(ReferenceEngine):
    """Judges times to go and closest points of approach by ADS-B; nothing is heard or seen."""

    name = "adsb_only"
    reads: tuple[type[Message], ...] = (Briefing, AdsbReport)
    inputs: Mapping[str, object] = MappingProxyType({})


ENGINE = Engine(
    name="adsb_only",
    summary="the rules of reference by ADS-B alone, as a baseline; ships with AIRHILT",
    create=lambda _, configuration: AdsbOnlyEngine(configuration),
    configuration=ReferenceConfig,
)
