"""The cameras of a scenario and of an airport, and where they look from."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from airhilt.errors import CameraError
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.host.library import nearest
from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.scenario import Scenario
from airhilt.scenario.models import ActorMount, AircraftSpec, Imaging
from airhilt.scenario.models import Camera as DeclaredCamera
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.units import DEGREE, FOOT
from airhilt.world.flight.aircraft_type import AircraftType, load_aircraft_type
from airhilt.world.site import ScenarioSite

AIRPORT_CAMERA_PX = (640, 360)
NOSE_LOOKS_DOWN_RAD = 4.0 * DEGREE
"""Angle below the body axis, in rad: about an airliner's angle of attack in level flight, so that
the horizon is in the middle."""
TAIL_LOOKS_UP_RAD = NOSE_LOOKS_DOWN_RAD
"""Angle of the camera on the tail, which looks back, above the body axis, in rad: the same, so
that the horizon is in its middle too."""


@dataclass(frozen=True)
class Mount:
    """A camera on an aircraft: its pose in the aircraft's axes.

    A camera on the nose sees nothing of its aircraft; one on the tail may.
    """

    actor: str
    pose: Pose
    sees_own_aircraft: bool


@dataclass(frozen=True)
class Camera:
    """A camera and where it is: a pose in the world if it stands, or a mount."""

    name: str
    intrinsics: Intrinsics
    at: Pose | Mount
    imaging: Imaging = field(default_factory=Imaging)

    @property
    def is_fixed(self) -> bool:
        """The camera never moves."""
        return isinstance(self.at, Pose)

    @property
    def carrier(self) -> str | None:
        """The actor that carries it; None if it stands."""
        return self.at.actor if isinstance(self.at, Mount) else None

    def view(self, bodies: Mapping[str, BodyState]) -> View:
        """Return the view of the camera.

        Raises
        ------
        CameraError
            The actor that carries the camera is not there, or its pose is not finite.
        """
        if isinstance(self.at, Pose):
            return View(self.intrinsics, self.at)
        carrier = bodies.get(self.at.actor)
        if carrier is None:
            raise CameraError(f"camera {self.name!r} is on {self.at.actor}, which is not there")
        return View(self.intrinsics, self.at.pose.on(carrier.pose))


def local_frame_of(site: ScenarioSite) -> LocalFrame:
    """Return the local frame in which a site is drawn."""
    if site.layout is not None:
        return site.layout.local_frame
    return LocalFrame((site.centre.lat_deg * DEGREE, site.centre.lon_deg * DEGREE))


def cameras_of(scenario: Scenario, site: ScenarioSite) -> dict[str, Camera]:
    """Return the cameras that a scenario declares, and those of its airport, by name.

    Raises
    ------
    CameraError
        A camera is invalid.
    """
    types = {
        actor.callsign: load_aircraft_type(actor.aircraft, scenario.files)
        for actor in scenario.actors
        if isinstance(actor, AircraftSpec)
    }
    cameras: dict[str, Camera] = {}
    if site.layout is not None:
        for given in site.layout.airport.cameras:
            lens = Intrinsics(*AIRPORT_CAMERA_PX, given.horizontal_fov_deg * DEGREE)
            pose = _pose(site, given.place, given.height_m, given.azimuth_deg, given.elevation_deg)
            cameras[given.name] = Camera(given.name, lens, pose)
    for declared in scenario.cameras:
        cameras[declared.name] = _camera(declared, site, types)
    return cameras


def cameras_named(scenario: Scenario, names: Sequence[str]) -> dict[str, Camera]:
    """Return cameras of a scenario or of its airport by name; errors as `find_camera`."""
    known = cameras_of(scenario, ScenarioSite.of(scenario))
    return {name: find_camera(known, name) for name in names}


def find_camera(cameras: Mapping[str, Camera], name: str) -> Camera:
    """Return the camera of that name.

    Raises
    ------
    CameraError
        There is none.
    """
    if name not in cameras:
        raise CameraError(f"no camera named {name!r}{nearest(name, sorted(cameras))}")
    return cameras[name]


def _camera(
    declared: DeclaredCamera, site: ScenarioSite, types: Mapping[str, AircraftType]
) -> Camera:
    lens = Intrinsics(declared.width_px, declared.height_px, declared.horizontal_fov_deg * DEGREE)
    mount = declared.mount
    if isinstance(mount, ActorMount):
        at = station_mount(declared.name, mount.actor, mount.station, types.get(mount.actor))
        return Camera(declared.name, lens, at, declared.imaging)
    place, height_m = site.place(mount.position), mount.height_ft * FOOT
    pose = _pose(site, place, height_m, mount.azimuth_deg, mount.elevation_deg)
    return Camera(declared.name, lens, pose, declared.imaging)


def _pose(
    site: ScenarioSite,
    place: tuple[float, float],
    height_m: float,
    azimuth_deg: float,
    elevation_deg: float,
) -> Pose:
    east, north = local_frame_of(site).to_local(place)
    return Pose.of((east, north, height_m), azimuth_deg * DEGREE, elevation_deg * DEGREE)


def station_mount(name: str, actor: str, station: str, kind: AircraftType | None) -> Mount:
    """Return where a camera sits on the nose of an aircraft, or on its tail and looks back.

    Raises
    ------
    CameraError
        The actor is no aircraft.
    """
    if kind is None:
        raise CameraError(
            f"camera {name!r} is mounted on {actor!r}; expected the callsign of an aircraft"
        )
    size = kind.dimensions
    if station == "nose":
        axis = size.height_m - size.wheel_height_offset_m - kind.mesh.fin_height_m
        place = (0.0, size.length_m / 2.0 + 0.4, min(axis, 1.0))
        return Mount(actor, Pose.of(place, 0.0, -NOSE_LOOKS_DOWN_RAD), False)
    top = size.height_m - size.wheel_height_offset_m
    place = (0.0, -0.45 * size.length_m, top + 0.35)
    return Mount(actor, Pose.of(place, math.pi, TAIL_LOOKS_UP_RAD), True)
