"""Identities of landscapes and scenes: hashes of all that reaches into their pictures."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping

import numpy as np
import numpy.typing as npt
import PIL

import airhilt.imaging
import airhilt.sensors.cameras
import airhilt.shapes
import airhilt.world.surface.kinds
from airhilt.host.files import packages_sha256
from airhilt.host.machine import processor_sha256
from airhilt.imaging.view import View
from airhilt.sensors.cameras.mounts import Camera, Mount
from airhilt.sensors.cameras.renderers import library_of
from airhilt.sensors.cameras.scene.bodies import Model
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import Landscape
from airhilt.world.surface.kinds import FAMILY


def landscape_identity(renderer: str, landscape: Landscape, light: Illumination) -> str:
    """Return the identity of a landscape in some light, as a renderer draws it.

    It is empty if not all that determines the pictures is known, as with a graphics card.
    """
    library = library_of(renderer)
    if not library:
        return ""
    code = packages_sha256(
        airhilt.imaging, airhilt.sensors.cameras, airhilt.shapes, airhilt.world.surface.kinds
    )
    drawn_by = [code, library, np.__version__, PIL.__version__, processor_sha256(), renderer]
    return _sha256([*drawn_by, light.key, landscape.lights, _arrays(landscape.mesh.arrays)])


def scene_identity(
    landscape: str,
    rain_mm_h: float,
    models: Mapping[str, Model],
    cameras: Iterable[Camera],
    supersampling: int,
) -> str:
    """Return the identity of a scene: of all but bodies and time.

    It is empty if not all is known: the landscape, or the lights of a kind of actor from another
    package, which are a function.
    """
    own = {point.name for point in FAMILY.own()}
    if not landscape or any(not each.aircraft and each.kind not in own for each in models.values()):
        return ""
    parts: list[object] = [landscape, rain_mm_h, supersampling]
    for callsign, model in models.items():
        parts.append((callsign, model.label, model.kind, model.aircraft))
        for shapes in (model.shapes, model.far):
            parts += ((name, _arrays(mesh.arrays)) for name, mesh in shapes.items())
    for camera in cameras:
        mount = camera.at if isinstance(camera.at, Mount) else None
        pose = camera.at.pose if isinstance(camera.at, Mount) else camera.at
        carried = None if mount is None else (mount.actor, mount.sees_own_aircraft)
        parts.append((camera.name, carried, View(camera.intrinsics, pose).key, camera.imaging))
    return _sha256(parts)


def _sha256(parts: Iterable[object]) -> str:
    return hashlib.sha256(repr(parts).encode()).hexdigest()


def _arrays(arrays: Iterable[npt.NDArray[np.generic]]) -> str:
    """Return the SHA-256 of the content of some arrays."""
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()
