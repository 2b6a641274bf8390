"""The identity of a scene: a hash of all that reaches into its pictures but bodies and time."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import astuple

import numpy as np

import airhilt.imaging
import airhilt.sensors.cameras
import airhilt.shapes
import airhilt.world.surface.kinds
from airhilt.host.files import packages_sha256
from airhilt.host.processor import processor_sha256
from airhilt.sensors.cameras.mounts import Camera, Mount
from airhilt.sensors.cameras.renderers import library_of
from airhilt.sensors.cameras.scene.bodies import Model
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import Landscape
from airhilt.shapes.mesh import Mesh
from airhilt.world.surface.kinds import FAMILY

CODE = airhilt.imaging, airhilt.sensors.cameras, airhilt.shapes, airhilt.world.surface.kinds
"""Packages that draw, and that say what bodies look like."""


def scene_identity(
    renderer: str,
    landscape: Landscape,
    light: Illumination,
    rain_mm_h: float,
    models: Mapping[str, Model],
    cameras: Iterable[Camera],
    supersampling: int,
) -> str:
    """Return the identity of a scene, empty if not all that determines its pictures is known.

    A graphics card is not known, nor is a kind of actor from another package, whose lights are a
    function.
    """
    library = library_of(renderer)
    own = {point.name for point in FAMILY.own()}
    if not library or any(not each.aircraft and each.kind not in own for each in models.values()):
        return ""
    digest = hashlib.sha256()
    for part in (
        packages_sha256(*CODE), renderer, library, np.__version__,
        processor_sha256(), light.sun.tolist(), light.visibility_m, light.overcast,
        light.background, rain_mm_h, landscape.lights, supersampling,
    ):  # fmt: skip
        digest.update(f"{part!r}\n".encode())
    _add(digest, landscape.mesh)
    for callsign, model in models.items():
        digest.update(f"{callsign} {model.label} {model.kind} {model.aircraft!r}\n".encode())
        for shapes in (model.shapes, model.far):
            for name, mesh in shapes.items():
                digest.update(f"{name}\n".encode())
                _add(digest, mesh)
    for camera in cameras:
        mount = camera.at if isinstance(camera.at, Mount) else None
        pose = camera.at.pose if isinstance(camera.at, Mount) else camera.at
        carried = None if mount is None else (mount.actor, mount.sees_own_aircraft)
        place = *pose.position_m, *pose.rotation.ravel().tolist()
        digest.update(f"{camera.name} {astuple(camera.intrinsics)} {carried} {place}\n".encode())
    return digest.hexdigest()


def _add(digest: hashlib._Hash, mesh: Mesh) -> None:
    for array in mesh.arrays:
        digest.update(np.ascontiguousarray(array).data)
