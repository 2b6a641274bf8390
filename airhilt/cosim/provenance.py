"""Content of ``run.json`` when a run begins, and the origin of what AIRHILT does not bring."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime

from airhilt.cosim.engines_in_use import UsedEngine, engines_in_use
from airhilt.cosim.participants import Participants
from airhilt.cosim.setup import Setup
from airhilt.host.files import content_sha256
from airhilt.record import RunInfo
from airhilt.record.folder import WorkerRecord, machine, versions
from airhilt.scenario.models import AircraftSpec
from airhilt.sensors.base import FAMILY as SENSORS
from airhilt.sensors.radio.backends.selection import channel_files
from airhilt.sim import Pace
from airhilt.world.surface.kinds import FAMILY as KINDS


def run_info(
    setup: Setup, participants: Participants, pace: Pace, endpoint: str, renderer: str
) -> RunInfo:
    """Return what ``run.json`` says of a run when it begins."""
    named = setup.options.model_copy(update={"assistant": participants.assistant})
    engines = engines_in_use(named, setup.scenario.equipment, participants.workers)
    return RunInfo(
        run=setup.name,
        options=setup.options,
        assistant=participants.assistant,
        pace=pace.name,
        scenario=setup.given.model_dump(mode="json"),
        realised=setup.scenario.model_dump(mode="json"),
        draws=[draw.model_dump() for draw in setup.draws],
        workers=[
            WorkerRecord(description=worker.description, where=worker.where)
            for worker in participants.workers
        ],
        endpoint=endpoint,
        started_at=datetime.now(UTC).isoformat(timespec="seconds"),
        versions=versions(),
        platform=machine(),
        renderer=renderer,
        models=_model_files(setup, engines),
        other_packages=_other_packages(setup, engines, renderer),
    )


def _model_files(setup: Setup, engines: Sequence[UsedEngine]) -> dict[str, str]:
    """Return the SHA-256 of each file or folder of the user that an engine works with, by path."""
    found = channel_files(setup.scenario.radio) if setup.options.speech else {}
    for _, engine, argument in engines:
        if argument and (path := engine.files(argument)).exists():
            found[str(path)] = content_sha256(path)
    return found


def _other_packages(setup: Setup, engines: Sequence[UsedEngine], renderer: str) -> dict[str, str]:
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
