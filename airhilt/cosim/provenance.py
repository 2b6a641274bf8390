"""Origin of what a run uses and AIRHILT does not bring: files of models, and other packages."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from airhilt.assistant.decision.engines import FAMILY as DECISION_ENGINES
from airhilt.assistant.reference import EXTERNAL, NO_ASSISTANT, families
from airhilt.engines import Engine, EngineFamily
from airhilt.errors import AirhiltError
from airhilt.host.files import content_sha256
from airhilt.scenario.models import AircraftSpec
from airhilt.sensors.base import FAMILY as SENSORS
from airhilt.sensors.radio.backends.selection import channel_files
from airhilt.world.surface.kinds import FAMILY as KINDS

if TYPE_CHECKING:
    from airhilt.cosim.participants import Participants
    from airhilt.cosim.setup import Setup


UsedEngine = tuple[EngineFamily[Any], Engine[Any], str]
"""An engine with its family and its argument."""


def model_files(setup: Setup, engines: Sequence[UsedEngine]) -> dict[str, str]:
    """Return the SHA-256 of each file or folder of the user that an engine works with, by path."""
    found = channel_files(setup.scenario.radio) if setup.options.speech else {}
    for _, _, argument in engines:
        if argument and Path(argument).exists():
            found[argument] = content_sha256(Path(argument))
    return found


def other_packages(setup: Setup, engines: Sequence[UsedEngine], renderer: str) -> dict[str, str]:
    """Return name and version of the package of each member in use that AIRHILT does not bring."""
    from airhilt.sensors.cameras.renderers import FAMILY as RENDERERS

    actors = setup.scenario.actors
    members = [
        *((SENSORS, each.name) for each in setup.sensor_types),
        *((KINDS, each.kind) for each in actors if not isinstance(each, AircraftSpec)),
        *((family, engine.name) for family, engine, _ in engines),
        *([(RENDERERS, renderer)] if renderer else []),
    ]
    origins = {f"{family.word} {name}": family.origin(name) for family, name in members}
    return {member: origin for member, origin in origins.items() if origin}


def engines_in_use(setup: Setup, participants: Participants) -> list[UsedEngine]:
    """Return the engines in use; it looks for them in every installed package."""
    used: list[UsedEngine] = []
    options = setup.options
    does = {
        each.description.modality for each in participants.workers if each.where == "in process"
    }
    decides = "decision" in does and participants.assistant not in (NO_ASSISTANT, EXTERNAL)
    asked = {
        "airhilt.enhancers": (options.enhancer, "enhancement" in does),
        "airhilt.asr": (options.asr, "asr" in does),
        "airhilt.tts": (options.tts, options.speech),  # Crews and controllers speak with it.
        "airhilt.detectors": (options.detector, "vision" in does),
        "airhilt.assistants": (participants.assistant, decides),
        "airhilt.wording": (options.wording, decides),
    }
    for family in families():
        text, is_used = asked[family.group]
        if is_used:
            with suppress(AirhiltError):  # A replay takes its results from the record.
                used.append((family, *family.choose(text)))
    for name in setup.scenario.equipment:
        with suppress(AirhiltError):
            used.append((DECISION_ENGINES, *DECISION_ENGINES.choose(name)))
    return used
