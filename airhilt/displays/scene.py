"""The scene of a recorded run: its airport, the shapes and poses of its actors, its cameras.

Axes are east, north and up from the centre of the scene, in metres. Up is from the level ground of
the run.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from datetime import UTC, datetime, time, timedelta
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt
from pydantic import ValidationError

from airhilt.errors import RunFolderError, first_problem
from airhilt.geodesy.wgs84 import horizontal_axes, vertical
from airhilt.imaging.pinhole import Pinhole
from airhilt.imaging.view import Matrix, Pose, attitude
from airhilt.messages import ActorTruth, CameraView
from airhilt.record import Run
from airhilt.scenario import Scenario
from airhilt.scenario.models import ActorSpec
from airhilt.sensors.cameras.mounts import local_frame_of
from airhilt.sensors.cameras.scene.bodies import model_of
from airhilt.sensors.cameras.scene.illumination import encode
from airhilt.shapes.mesh import Mesh
from airhilt.units import DEGREE
from airhilt.world.site import ScenarioSite

Local = tuple[float, float]
Position = tuple[float, float, float]
Area = Literal["runway", "protected area", "taxiway", "building"]
AREA_COLOURS: dict[Area, tuple[int, int, int]] = {
    "runway": (70, 74, 80),
    "protected area": (220, 60, 50),
    "taxiway": (150, 140, 90),
    "building": (120, 130, 145),
}
ACTOR_COLOURS = (
    (0, 130, 255), (255, 120, 0), (0, 190, 120), (220, 80, 200), (230, 190, 0), (0, 190, 220),
)  # fmt: skip
"""Colours of up to six actors; from there on they begin again."""
HOURS_A_DEGREE = 24.0 / 360.0
"""Turn of the mean sun, in h for each degree of longitude."""


class Outline(NamedTuple):
    """The outline of an area of the airport, or a centre line of a taxiway, in local metres."""

    name: str
    area: Area
    points: list[Local]
    """Its last point is its first where it encloses an area."""


class Scene:
    """The scene of a run.

    Attributes
    ----------
    actors
        Actors of the scenario, by callsign.
    ground_m
        Altitude of the ground.

    Raises
    ------
    AirhiltError
        This version cannot read the scenario in ``run.json``.
    """

    def __init__(self, run: Run) -> None:
        try:
            self._scenario = Scenario.model_validate(run.info.realised)
        except ValidationError as error:
            raise RunFolderError(
                f"{run.paths.info_path}: its scenario cannot be shown: {first_problem(error)}; "
                "expected one of this version of AIRHILT"
            ) from None
        self.site = ScenarioSite.of(self._scenario)
        self.ground_m = self.site.ground_m
        self.actors: dict[str, ActorSpec] = {
            actor.callsign: actor for actor in self._scenario.actors
        }
        self._local_frame = local_frame_of(self.site)

    def time_of_day(self, t_ns: int) -> str:
        """Return a time of the run in UTC, by ISO 8601.

        The run begins at the time of its daylight, by the mean sun.
        """
        daylight = self._scenario.daylight
        hours = daylight.solar_time_h - self.site.centre.lon_deg * HOURS_A_DEGREE
        midnight = datetime.combine(daylight.date, time(tzinfo=UTC))
        at = midnight + timedelta(seconds=round(hours * 3600.0), microseconds=t_ns // 1000)
        return at.isoformat(timespec="milliseconds").replace("+00:00", "Z")

    def outlines(self) -> Iterator[Outline]:
        """Yield the outlines of the airport; none en route."""
        layout = self.site.layout
        if layout is None:
            return
        for strip in layout.strips.values():
            yield Outline(strip.name, "protected area", [*strip.protected_area.exterior.coords])
            yield Outline(strip.name, "runway", [*strip.pavement.exterior.coords])
        for edge in layout.airport.taxiways.edges:
            yield Outline(edge.taxiway, "taxiway", [*layout.leg(edge)])
        for building in layout.airport.buildings:
            corners = layout.outline(building.footprint)
            yield Outline(building.name, "building", [*corners, corners[0]])

    def degrees(self, point: Local) -> tuple[float, float]:
        """Return latitude and longitude of a point of the ground, in degrees."""
        latitude, longitude = self._local_frame.to_place(*point)
        return latitude / DEGREE, longitude / DEGREE

    def pose(self, state: ActorTruth) -> Pose:
        """Return where an actor is, and its attitude."""
        return Pose.of(
            self._position_m(
                state.latitude_deg, state.longitude_deg, state.altitude_m - self.ground_m
            ),
            state.heading_deg * DEGREE,
            state.pitch_deg * DEGREE,
            state.roll_deg * DEGREE,
        )

    def camera_pose(self, view: CameraView) -> Pose:
        """Return where a camera is; its axes are those of a pinhole: x right, y down, z ahead."""
        place = self._position_m(view.latitude_deg, view.longitude_deg, view.height_m)
        return Pose(place, Pinhole(view).axes)

    def mesh(self, actor: str) -> Mesh:
        """Return the coarsest shape of an actor, in its axes: right, ahead, up."""
        model = model_of(self.actors[actor], self._scenario.files)
        return next(iter((model.far or model.shapes).values()))

    def colour(self, actor: str) -> tuple[int, int, int]:
        """Return the colour of an actor in tracks and plots, as 8-bit sRGB."""
        return ACTOR_COLOURS[self._numbers[actor] % len(ACTOR_COLOURS)]

    @cached_property
    def _numbers(self) -> dict[str, int]:
        return {actor: number for number, actor in enumerate(self.actors)}

    def _position_m(self, latitude_deg: float, longitude_deg: float, up_m: float) -> Position:
        east_m, north_m = self._local_frame.to_local(
            (latitude_deg * DEGREE, longitude_deg * DEGREE)
        )
        return east_m, north_m, up_m


def attitude_on_earth(state: ActorTruth) -> Matrix:
    """Return the rotation from the axes of an actor (right, ahead, up) to Earth-centred ones."""
    place = state.latitude_deg * DEGREE, state.longitude_deg * DEGREE
    axes = np.column_stack((*horizontal_axes(place), vertical(place)))
    angles = state.heading_deg * DEGREE, state.pitch_deg * DEGREE, state.roll_deg * DEGREE
    return np.asarray(axes @ attitude(*angles))


def quaternion(rotation: Matrix) -> tuple[float, float, float, float]:
    """Return a rotation as a unit quaternion: x, y, z, w."""
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(rotation).as_quat().tolist()
    return x, y, z, w


def srgb_colours(mesh: Mesh) -> npt.NDArray[np.uint8]:
    """Return the colour of each triangle in 8-bit sRGB, shape (n, 3)."""
    return encode(mesh.colours.T)


def ground_speed_m_s(state: ActorTruth) -> float:
    """Return the speed of an actor over the ground."""
    return math.hypot(state.velocity_north_m_s, state.velocity_east_m_s)
