"""The kinds of services that a run asks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, get_args

from airhilt.engine_families import ASSISTANTS, DETECTORS, RECOGNISERS, VOICES
from airhilt.engines import EngineFamily

ServiceKind = Literal["asr", "tts", "vision", "decision"]
KINDS: tuple[ServiceKind, ...] = get_args(ServiceKind)
FAMILY: Mapping[ServiceKind, EngineFamily[Any]] = {
    "asr": RECOGNISERS,
    "tts": VOICES,
    "vision": DETECTORS,
    "decision": ASSISTANTS,
}
"""The family of engines that a service of each kind is one of."""
PATHS: Mapping[ServiceKind, str] = {
    "asr": "/v1/audio/transcriptions",
    "tts": "/v1/audio/speech",
    "vision": "/v1/detections",
    "decision": "/v1/advisories",
}
"""Path of each kind where AIRHILT serves it."""
