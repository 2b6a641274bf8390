"""Takes pictures: puts still world, bodies, shadows, lights and rain together, with the truth.

A picture is the world behind everything, and before it one layer for each body. Each body is
drawn alone in its own window, finer than the pixels the smaller it is, so that what a pixel shows
of it, and how much of it others hide, are counted and not guessed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from airhilt.cameras.bodies import BodyState, Model
from airhilt.cameras.lamps import Lamp, shine
from airhilt.cameras.light import Light
from airhilt.cameras.mesh import Floats
from airhilt.cameras.mounts import Camera, Mount
from airhilt.cameras.outline import Box, Outline
from airhilt.cameras.rain import Streaks
from airhilt.cameras.renderers import RendererName, Samples, open_renderer
from airhilt.cameras.view import Pose, View, Window
from airhilt.cameras.world import World
from airhilt.messages import VisibleClass

FINENESS = ((900, 4), (2500, 3), (16_000, 2))
"""Pixels of a window at most, samples along each side of a pixel; larger windows have one."""
STILL_SAMPLES = 3
"""Along each side of a pixel of a background that is drawn once."""
TOUCHES_M = 0.25
"""What is so much farther than a surface still lies on it."""
SHADOW_BELOW_M = 150.0
SMALLEST_SHADOW_PX = 4.0
SMALL_PX = 4000
"""Area of a window in which a body may be coarse."""
TURN_STEPS = 24
"""A picture of the own aircraft is kept while the light turns less than a step of this part of
a radian."""


@dataclass(frozen=True)
class Sighting:
    """What is true of a body in a picture.

    Attributes
    ----------
    box
        About all of the body that is within the picture, whether hidden or not; pixels.
    pixels
        Area that is seen.
    visible_fraction
        Of the body's area within the picture, that nothing hides.
    truncation
        Part of the box about the whole body that lies outside of the picture.
    range_m
        From the camera to the body's reference point.
    transmission
        Part of the body's contrast that the air leaves.
    """

    actor: str
    label: VisibleClass
    box: Box
    pixels: float
    visible_fraction: float
    truncation: float
    range_m: float
    transmission: float

    @property
    def occlusion(self) -> float:
        """Part of the body's area within the picture that something hides."""
        return 1.0 - self.visible_fraction


@dataclass(frozen=True)
class Frame:
    """A picture and what is true of it.

    Attributes
    ----------
    colour
        8-bit sRGB, shape (rows, columns, 3).
    distance_m
        From the camera along the ray, infinite in the sky.
    instance
        0 where no body fills the pixel, else the number of the actor in the studio, from 1.
    """

    camera: str
    t_ns: int
    view: View
    colour: npt.NDArray[np.uint8]
    distance_m: Floats
    instance: npt.NDArray[np.uint8]
    sightings: tuple[Sighting, ...]


@dataclass
class _Layer:
    """A body in its window, in pixels."""

    number: int
    window: Window
    box: Box
    whole: Box
    range_m: float
    silhouette: float
    cover: Floats
    colour: Floats
    distance_m: Floats


class Studio:
    """A scene with cameras and bodies in it, and what draws it.

    Parameters
    ----------
    models
        How each actor looks, by callsign.
    rain_mm_h
        Of which streaks are drawn; what the rain does to the visibility is in ``light``.
    fine
        Samples along each side of a pixel, at least.

    Raises
    ------
    CameraError
        A fixed camera stands in something.
    RendererError
        The renderer cannot be opened.
    """

    def __init__(
        self,
        world: World,
        light: Light,
        models: Mapping[str, Model],
        cameras: Iterable[Camera],
        renderer: RendererName = "open3d",
        rain_mm_h: float = 0.0,
        fine: int = 1,
    ) -> None:
        self._world = world
        self._light = light
        self._models = dict(models)
        self._numbers = {actor: number for number, actor in enumerate(self._models, start=1)}
        self._cameras = {camera.name: camera for camera in cameras}
        for camera in self._cameras.values():
            if isinstance(camera.at, Pose):
                world.require_free(camera.name, camera.at.position_m)
        shapes = {
            f"{model.kind}/{name}": mesh
            for model in self._models.values()
            for name, mesh in model.shapes.items()
        }
        self._outlines = {name: Outline.of(mesh) for name, mesh in shapes.items()}
        far = {
            f"{model.kind}/{name}/far": mesh
            for model in self._models.values()
            for name, mesh in model.far.items()
        }
        self._renderer = open_renderer(renderer, world.mesh, shapes | far, light)
        self._far = frozenset(far)
        self._fine = fine
        self._backgrounds: dict[str, Samples] = {}
        self._own: dict[str, tuple[tuple[object, ...], _Layer]] = {}
        self._streaks = {
            camera.name: Streaks(
                (camera.intrinsics.width_px, camera.intrinsics.height_px), rain_mm_h, camera.name
            )
            for camera in self._cameras.values()
            if rain_mm_h > 0.0
        }
        self._taken = dict.fromkeys(self._cameras, 0)

    @property
    def actors(self) -> tuple[str, ...]:
        """Those of the numbers in ``Frame.instance``, from 1."""
        return tuple(self._numbers)

    def close(self) -> None:
        """Give back what was taken."""
        self._renderer.close()

    def shoot(self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int) -> list[Frame]:
        """Take the pictures of all cameras that are due at an instant.

        Raises
        ------
        CameraError
            A pose is not finite, or a camera is mounted on something that is not there.
        """
        there = {body.actor: body for body in bodies}
        poses = {actor: body.pose for actor, body in there.items()}
        lamps = self._lamps(there, poses, t_ns)
        return [self._picture(self._cameras[name], there, poses, lamps, t_ns) for name in names]

    # --- one picture ----------------------------------------------------------------------

    def _picture(
        self,
        camera: Camera,
        bodies: Mapping[str, BodyState],
        poses: Mapping[str, Pose],
        lamps: Sequence[tuple[str, Lamp]],
        t_ns: int,
    ) -> Frame:
        view = camera.view(bodies)
        background = self._background(camera, view)
        colour, distance = background.colour.copy(), background.distance_m.copy()
        instance = np.zeros(distance.shape, dtype=np.uint8)
        own = camera.at if isinstance(camera.at, Mount) else None
        layers = []
        for actor, body in bodies.items():
            if own is not None and own.actor == actor:
                continue
            self._cast_shadow(body, poses[actor], view, colour, distance)
            layer = self._layer(body, poses[actor], view, background.distance_m)
            if layer is not None:
                layers.append(layer)
        if own is not None and own.sees_own_aircraft:
            layer = self._own_layer(camera.name, own, bodies[own.actor], poses, view)
            if layer is not None:
                layers.append(layer)
        layers.sort(key=lambda layer: -layer.range_m)
        for layer in layers:
            _lay(layer, colour, distance, instance)
        self._shine(camera, view, lamps, own, colour, distance)
        if camera.name in self._streaks:
            bright = 40.0 + 170.0 * (1.0 - self._light.darkness)
            self._streaks[camera.name].fall(colour, self._taken[camera.name], bright)
        self._taken[camera.name] += 1
        number = self._numbers.get(own.actor) if own is not None else None
        sightings = self._sightings(layers, number)
        return Frame(camera.name, t_ns, view, colour, distance, instance, sightings)

    def _background(self, camera: Camera, view: View) -> Samples:
        if not camera.is_fixed:
            return _resolved(self._renderer.world(view, self._fine), self._fine)
        kept = self._backgrounds.get(camera.name)
        if kept is None:
            samples = max(STILL_SAMPLES, self._fine)
            kept = _resolved(self._renderer.world(view, samples), samples)
            picture = np.ascontiguousarray(kept.colour)
            if self._light.needs_lamps:
                shine(picture, kept.distance_m, self._world.lamps, view, self._light)
            kept = self._backgrounds[camera.name] = Samples(picture, kept.distance_m)
        return kept

    def _layer(self, body: BodyState, pose: Pose, view: View, behind_m: Floats) -> _Layer | None:
        """Return a body as it stands before the world, None if it is not in the picture."""
        shape = self._shape(body)
        whole = self._outlines[shape].box(pose, view)
        if whole is None:
            return None
        box = whole.within(view)
        if box.area <= 0.0:
            return None
        away = math.dist(pose.position_m, view.pose.position_m)
        window = box.window(view)
        samples = max(_fineness(window), self._fine)
        drawn = self._renderer.body(self._drawn(shape, window), pose, view, window, samples)
        rows, columns = window.slices
        behind = behind_m[rows, columns]
        behind = np.repeat(np.repeat(behind, samples, axis=0), samples, axis=1)
        there = np.isfinite(drawn.distance_m)
        seen = there & (drawn.distance_m < behind + TOUCHES_M)
        cover = _mean(seen, samples)
        colour = np.stack(
            [_mean(np.where(seen, drawn.colour[..., c], 0), samples) for c in range(3)], axis=-1
        )
        nearest = np.where(seen, drawn.distance_m, np.float32(np.inf))
        return _Layer(
            self._numbers[body.actor],
            window,
            box,
            whole,
            away,
            float(there.sum()) / samples**2,
            cover,
            colour,
            _least(nearest, samples),
        )

    def _own_layer(
        self, name: str, mount: Mount, body: BodyState, poses: Mapping[str, Pose], view: View
    ) -> _Layer | None:
        """Return the camera's own aircraft; it is drawn anew when its light has changed."""
        pose = poses[mount.actor]
        light = np.round(np.asarray(self._light.sun) @ pose.rotation * TURN_STEPS)
        key = (body.shape, *light.tolist())
        kept = self._own.get(name)
        if kept is None or kept[0] != key:
            far = np.full(
                (view.intrinsics.height_px, view.intrinsics.width_px), np.inf, dtype=np.float32
            )
            layer = self._layer(body, pose, view, far)
            if layer is None:
                return None
            layer.range_m = 0.0
            kept = self._own[name] = (key, layer)
        return kept[1]

    def _cast_shadow(
        self, body: BodyState, pose: Pose, view: View, colour: npt.NDArray[np.uint8],
        distance: Floats,
    ) -> None:  # fmt: skip
        """Darken the flat ground where a body keeps the sun off."""
        light = self._light
        if (
            body.up_m > SHADOW_BELOW_M
            or light.sun[2] < math.sin(math.radians(4.0))
            or light.overcast > 0.8
        ):
            return
        shape = self._shape(body)
        box = self._outlines[shape].shadow_box(pose, view, light.sun)
        if box is None or box.within(view).area < SMALLEST_SHADOW_PX:
            return
        window = box.within(view).window(view)
        samples = max(min(_fineness(window), 2), self._fine)
        fitting = self._drawn(shape, window)
        shaded = _mean(self._renderer.shadow(fitting, pose, view, window, samples), samples)
        rows, columns = window.slices
        down = view.directions(*view.sample_places(window, 1))[2]
        away = distance[rows, columns]
        with np.errstate(invalid="ignore"):
            on_ground = np.abs(away * down + np.float32(view.pose.position_m[2])) < 0.3
            kept = shaded * on_ground * np.exp(-np.float32(light.extinction_per_m) * away)
        lit = light.diffuse + light.direct * max(float(light.sun[2]), 0.0)
        darker = 1.0 - (light.diffuse / lit) ** (1.0 / 2.2)
        part = colour[rows, columns]
        part[...] = (part * (1.0 - kept[..., None] * darker)).astype(np.uint8)

    # --- lights and truth -----------------------------------------------------------------

    def _lamps(
        self, bodies: Mapping[str, BodyState], poses: Mapping[str, Pose], t_ns: int
    ) -> list[tuple[str, Lamp]]:
        found = []
        for number, (actor, body) in enumerate(bodies.items()):
            pose = poses[actor]
            # Nobody's lights flash together with another's.
            t_s = t_ns / 1e9 + 0.37 * number
            for lamp in self._models[actor].lamps(t_s, body.lit):
                place = pose.rotation @ np.asarray(lamp.place_m) + np.asarray(pose.position_m)
                beam = None if lamp.beam is None else pose.rotation @ np.asarray(lamp.beam)
                found.append((actor, lamp._replace(
                    place_m=tuple(place.tolist()),
                    beam=None if beam is None else tuple(beam.tolist()),
                )))  # fmt: skip
        return found

    def _shine(
        self,
        camera: Camera,
        view: View,
        lamps: Sequence[tuple[str, Lamp]],
        own: Mount | None,
        colour: npt.NDArray[np.uint8],
        distance: Floats,
    ) -> None:
        others = [lamp for actor, lamp in lamps if own is None or actor != own.actor]
        if not camera.is_fixed and self._light.needs_lamps:
            others.extend(self._world.lamps)
        shine(colour, distance, others, view, self._light)

    def _sightings(self, layers: Sequence[_Layer], own: int | None) -> tuple[Sighting, ...]:
        """Return what is true of each body; layers are in order, the nearest last."""
        found = []
        for index, layer in enumerate(layers):
            if layer.number == own:
                continue
            seen = layer.cover.copy()
            for nearer in layers[index + 1 :]:
                _hide(seen, layer.window, nearer)
            actor = self.actors[layer.number - 1]
            pixels = float(seen.sum())
            inside = layer.box.area / max(layer.whole.area, 1e-9)
            found.append(
                Sighting(
                    actor,
                    self._models[actor].label,
                    layer.box,
                    pixels,
                    min(pixels / layer.silhouette, 1.0) if layer.silhouette else 0.0,
                    1.0 - min(inside, 1.0),
                    layer.range_m,
                    math.exp(-self._light.extinction_per_m * layer.range_m),
                )
            )
        return tuple(sorted(found, key=lambda sighting: sighting.range_m))

    def _drawn(self, shape: str, window: Window) -> str:
        """Return the mesh of a shape that fits the size in which it is seen."""
        far = f"{shape}/far"
        return far if window.area < SMALL_PX and far in self._far else shape

    def _shape(self, body: BodyState) -> str:
        return f"{self._models[body.actor].kind}/{body.shape}"


def _fineness(window: Window) -> int:
    return next((samples for area, samples in FINENESS if window.area <= area), 1)


def _resolved(drawn: Samples, samples: int) -> Samples:
    """Return the pixels of samples: their mean colours, and the distance of one in the middle."""
    if samples == 1:
        return drawn
    rows, columns = (side // samples for side in drawn.distance_m.shape)
    fine = drawn.colour.reshape(rows, samples, columns, samples, 3)
    colour = np.round(fine.mean(axis=(1, 3), dtype=np.float32)).astype(np.uint8)
    middle = samples // 2
    return Samples(colour, np.ascontiguousarray(drawn.distance_m[middle::samples, middle::samples]))


def _mean(samples: npt.NDArray[np.generic], count: int) -> Floats:
    if count == 1:
        return samples.astype(np.float32)
    rows, columns = (side // count for side in samples.shape)
    blocks = samples.reshape(rows, count, columns, count)
    return np.asarray(blocks.mean(axis=(1, 3), dtype=np.float32))


def _least(samples: Floats, count: int) -> Floats:
    if count == 1:
        return samples
    rows, columns = (side // count for side in samples.shape)
    return np.asarray(samples.reshape(rows, count, columns, count).min(axis=(1, 3)))


def _lay(
    layer: _Layer, colour: npt.NDArray[np.uint8], distance: Floats, instance: npt.NDArray[np.uint8]
) -> None:
    """Put a layer before what is already in the picture."""
    rows, columns = layer.window.slices
    part = colour[rows, columns]
    part[...] = np.rint(part * (1.0 - layer.cover[..., None]) + layer.colour).astype(np.uint8)
    filled = layer.cover >= 0.5
    instance[rows, columns][filled] = layer.number
    distance[rows, columns][filled] = layer.distance_m[filled]


def _hide(seen: Floats, window: Window, nearer: _Layer) -> None:
    """Take from what is seen of a layer what a nearer one covers."""
    left, top = max(window.left, nearer.window.left), max(window.top, nearer.window.top)
    right = min(window.right, nearer.window.right)
    bottom = min(window.bottom, nearer.window.bottom)
    if left >= right or top >= bottom:
        return
    cover = nearer.cover[
        top - nearer.window.top : bottom - nearer.window.top,
        left - nearer.window.left : right - nearer.window.left,
    ]
    seen[top - window.top : bottom - window.top, left - window.left : right - window.left] *= (
        1.0 - cover
    )
