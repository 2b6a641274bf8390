"""Draws pictures of a recorded run again, from the true states in its log.

The log has the states of the actors five times a second. Between two of them places and attitudes
are interpolated, so that a picture is close to the one that the run had, and not the same.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image
from pydantic import ValidationError

from airhilt.errors import RendererError, RendererLost, RunFolderError, first_problem
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.messages import ActorTruth
from airhilt.record import RunInfo
from airhilt.record.kept_pictures import encoded
from airhilt.scenario import Scenario
from airhilt.scenario.models import ActorSpec, AircraftSpec
from airhilt.sensors.cameras import AUTO
from airhilt.sensors.cameras.body_states import has_landing_lights_on
from airhilt.sensors.cameras.mounts import local_frame_of
from airhilt.sensors.cameras.renderer_process import RendererProcess
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.units import DEGREE
from airhilt.world.actors.crew import mesh_at
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kinds import load_kind

FLYING_ABOVE_M = 0.5
"""Height above the ground from which an animal is drawn flying, in m."""
INTERPOLATED = (
    "latitude_rad", "longitude_rad", "altitude_m", "height_agl_m", "ground_speed_m_s",
    "heading_rad", "pitch_rad", "roll_rad",
)  # fmt: skip
"""Fields of a state besides its time."""
STATE = np.dtype([("t_ns", np.int64), *((name, np.float64) for name in INTERPOLATED)])
"""Data type of the part of an actor's true state that a picture shows."""
StateRow = tuple[float, ...]
Table = npt.NDArray[Any]
"""States of one actor, of type `STATE`."""
ANGLES = ("longitude_rad", "heading_rad", "roll_rad")
"""Fields that may jump by a full turn."""


def state_row(state: ActorTruth) -> StateRow:
    """Return a true state as a row of the type `STATE`."""
    return (
        state.t_ns,
        state.latitude_deg * DEGREE,
        state.longitude_deg * DEGREE,
        state.altitude_m,
        state.height_agl_m,
        math.hypot(state.velocity_north_m_s, state.velocity_east_m_s),
        state.heading_deg * DEGREE,
        state.pitch_deg * DEGREE,
        state.roll_deg * DEGREE,
    )


def _table(rows: Sequence[StateRow]) -> Table:
    table = np.array(rows, STATE)
    for name in ANGLES:
        table[name] = np.unwrap(table[name])
    return table


class RedrawnPictures:
    """Draws pictures of one run, one at a time, in a process that starts with the first one.

    Parameters
    ----------
    info
        Content of ``run.json``: what is drawn, and by which renderer.
    states
        Rows of the true states of each actor, in the order of their times.
    """

    def __init__(self, info: RunInfo, states: Mapping[str, Sequence[StateRow]]) -> None:
        self._info = info
        self._states = {actor: _table(of_actor) for actor, of_actor in states.items()}
        self._lock = threading.Lock()
        self._scene: _Scene | None = None

    def jpeg(self, camera: str, t_ns: int) -> bytes:
        """Return a picture of a camera at a time.

        Raises
        ------
        AirhiltError
            It cannot be drawn here.
        """
        with self._lock:
            if self._scene is None:
                self._scene = _Scene(self._info)
            try:
                colour = self._scene.colour(camera, t_ns, self._states)
            except RendererLost:
                self._scene.close()
                self._scene = None
                raise
        return encoded(Image.fromarray(colour))

    def close(self) -> None:
        """End the process that draws."""
        with self._lock:
            if self._scene is not None:
                self._scene.close()
            self._scene = None


class _Scene:
    """The scene of a run, and the process that draws it."""

    def __init__(self, info: RunInfo) -> None:
        try:
            scenario = Scenario.model_validate(info.realised)
        except ValidationError as error:
            raise RunFolderError(
                f"the scenario in run.json cannot be drawn by this version: {first_problem(error)}"
            ) from None
        site = ScenarioSite.of(scenario)
        self._actors = {actor.callsign: actor for actor in scenario.actors}
        self._local_frame = local_frame_of(site)
        self._ground_m = site.ground_m
        self._renderer = _renderer(scenario, info.renderer or AUTO)
        self.close = self._renderer.close

    def colour(self, camera: str, t_ns: int, states: dict[str, Table]) -> npt.NDArray[np.uint8]:
        bodies = list(self._bodies(t_ns, states))
        return self._renderer.take([camera], bodies, t_ns)[0].colour

    def _bodies(self, t_ns: int, states: dict[str, Table]) -> Iterator[BodyState]:
        for callsign, actor in self._actors.items():
            if callsign in states:
                yield _body(actor, states[callsign], t_ns, self._local_frame, self._ground_m)


def _renderer(scenario: Scenario, name: str) -> RendererProcess:
    """Return what draws: the renderer of the run, or another one where that is not installed."""
    try:
        return RendererProcess(scenario, renderer=name)
    except RendererLost:
        raise
    except RendererError:
        if name == AUTO:
            raise
        return RendererProcess(scenario, renderer=AUTO)


def _body(
    actor: ActorSpec, states: Table, t_ns: int, local_frame: LocalFrame, ground_m: float
) -> BodyState:
    """Return where an actor is at a time: before its first state there, and after its last."""
    now = {name: float(np.interp(t_ns, states["t_ns"], states[name])) for name in INTERPOLATED}
    east_m, north_m = local_frame.to_local((now["latitude_rad"], now["longitude_rad"]))
    height_m, up_m = now["height_agl_m"], now["altitude_m"] - ground_m
    if isinstance(actor, AircraftSpec):
        angles = now["heading_rad"], now["pitch_rad"], now["roll_rad"]
        lit = has_landing_lights_on(height_m, now["ground_speed_m_s"])
        shape = mesh_at(height_m)
    else:
        angles = now["heading_rad"], 0.0, 0.0
        lit = True
        shape = _shape_of_kind(actor.kind, height_m)
    return BodyState(actor.callsign, east_m, north_m, up_m, *angles, shape, lit)


def _shape_of_kind(kind: str, height_m: float) -> str:
    """Return a mesh of a kind: where it flies, the first one of its wing beat."""
    meshes = [*load_kind(kind).appearance().meshes]
    return meshes[1] if len(meshes) > 1 and height_m > FLYING_ABOVE_M else meshes[0]
