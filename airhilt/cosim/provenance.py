"""Origin of what a run uses and AIRHILT does not bring: files of models, and other packages."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from airhilt.cosim.engines_in_use import UsedEngine
from airhilt.host.files import content_sha256
from airhilt.scenario.models import AircraftSpec
from airhilt.sensors.base import FAMILY as SENSORS
from airhilt.sensors.radio.backends.selection import channel_files
from airhilt.world.surface.kinds import FAMILY as KINDS

if TYPE_CHECKING:
    from airhilt.cosim.setup import Setup


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
