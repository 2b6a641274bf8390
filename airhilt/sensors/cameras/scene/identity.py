"""The identity of a scene: a hash of all that reaches into its pictures but bodies and time."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping

import airhilt.shapes
import airhilt.world.surface.kinds
from airhilt.imaging.view import View
from airhilt.sensors.cameras.drawing_keys import arrays_sha256, drawn_by, view_key
from airhilt.sensors.cameras.mounts import Camera, Mount
from airhilt.sensors.cameras.renderers import library_of
from airhilt.sensors.cameras.scene.bodies import Model
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import Landscape
from airhilt.world.surface.kinds import FAMILY


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
    parts: list[object] = [
        *drawn_by(library, airhilt.shapes, airhilt.world.surface.kinds), renderer, light.key,
        rain_mm_h, landscape.lights, supersampling, arrays_sha256(landscape.mesh.arrays),
    ]  # fmt: skip
    for callsign, model in models.items():
        parts.append((callsign, model.label, model.kind, model.aircraft))
        for shapes in (model.shapes, model.far):
            parts += ((name, arrays_sha256(mesh.arrays)) for name, mesh in shapes.items())
    for camera in cameras:
        mount = camera.at if isinstance(camera.at, Mount) else None
        pose = camera.at.pose if isinstance(camera.at, Mount) else camera.at
        carried = None if mount is None else (mount.actor, mount.sees_own_aircraft)
        parts.append((camera.name, carried, view_key(View(camera.intrinsics, pose))))
    return hashlib.sha256(repr(parts).encode()).hexdigest()
