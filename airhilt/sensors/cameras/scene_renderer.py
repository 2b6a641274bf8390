"""Takes pictures: puts landscape, bodies, shadows, lights and rain together, with the truth.

A picture is the landscape behind everything, and before it one layer for each body. Each body is
drawn alone in its own window, finer than the pixels the smaller it is, so that what a pixel shows
of it, and how much of it others hide, are counted and not guessed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.imaging.masks import Mask, grown
from airhilt.imaging.view import Pose, View
from airhilt.sensors.cameras import AUTO, STILL_SAMPLES
from airhilt.sensors.cameras.camera_state import CameraState
from airhilt.sensors.cameras.frame import Frame, Prospect
from airhilt.sensors.cameras.image_sensor import IDEAL, ImageSensor
from airhilt.sensors.cameras.mounts import Camera, Mount, find_camera
from airhilt.sensors.cameras.renderers import Part, Samples, open_renderer
from airhilt.sensors.cameras.scene.background import Background
from airhilt.sensors.cameras.scene.bodies import BodyState, Model, numbered
from airhilt.sensors.cameras.scene.identity import landscape_identity, scene_identity
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import Landscape
from airhilt.sensors.cameras.scene.layers import Layer, by_sample, darken, sightings_of
from airhilt.sensors.cameras.scene.lights import Lights, Spot, shine
from airhilt.sensors.cameras.scene.rain import Streaks
from airhilt.sensors.cameras.scene.visible_bodies import VisibleBodies, VisibleBody
from airhilt.shapes.lights import Light
from airhilt.shapes.mesh import Floats

OWN_SAMPLES = 2
OWN_MARGIN_PX = 2
"""Margin of the mask of the own aircraft, in pixels."""
AT_ORIGIN = Pose.of((0.0, 0.0, 0.0), 0.0)
TURN_STEPS = 24
"""Steps a radian: a picture of the own aircraft is kept until the light has turned by one."""


class _OwnAircraft(NamedTuple):
    """The aircraft that carries a camera, drawn as it was in one light."""

    light: tuple[object, ...]
    layer: Layer
    body: BodyState


class _Plain(NamedTuple):
    """A picture of the landscape with at most the own aircraft before it, and what it shows."""

    drawn: int
    own: Layer | None
    frame: Frame


class SceneRenderer:
    """A scene with cameras and bodies in it, and what draws it.

    Parameters
    ----------
    rain_mm_h
        Rain of which streaks are drawn; what the rain does to the visibility is in ``light``.
    keeps_backgrounds
        True if other processes may draw for the same fixed cameras: see `kept_background`.
    shares_pictures
        True if other runs may have the same pictures; see `identity`.

    Attributes
    ----------
    identity
        Hash of all that reaches into pictures but bodies and time; empty if that is not known, or
        pictures are not shared.

    Raises
    ------
    CameraError
        A fixed camera stands in something, or there are more actors than pictures tell apart.
    RendererError
        The renderer cannot be opened.
    """

    def __init__(
        self,
        landscape: Landscape,
        light: Illumination,
        models: Mapping[str, Model],
        cameras: Iterable[Camera],
        renderer: str = AUTO,
        rain_mm_h: float = 0.0,
        supersampling: int = 1,
        keeps_backgrounds: bool = False,
        shares_pictures: bool = False,
    ) -> None:
        self._light = light
        self._models = dict(models)
        self._numbers = numbered(self._models)
        self.cameras = {camera.name: camera for camera in cameras}
        for camera in self.cameras.values():
            if isinstance(camera.at, Pose):
                landscape.require_free(camera.name, camera.at.position_m)
        self._bodies = VisibleBodies(self._models, light, supersampling)
        self.renderer, self._renderer = open_renderer(
            renderer, landscape.mesh, self._bodies.shapes, light
        )
        self._fixed_lights = Lights.of(landscape.lights)
        identity = ""
        if shares_pictures or keeps_backgrounds:
            identity = landscape_identity(self.renderer, landscape, light)
        samples = max(STILL_SAMPLES, supersampling)
        kept_as = identity if keeps_backgrounds else ""
        self._backgrounds = {
            camera.name: Background(self._renderer, samples, self._light_up, kept_as)
            if camera.is_fixed
            else Background(self._renderer, supersampling)
            for camera in self.cameras.values()
        }
        self._sensors: dict[str, ImageSensor] = {}
        self._plain: dict[str, _Plain] = {}
        self._own: dict[str, _OwnAircraft] = {}
        self._streaks = {
            camera.name: Streaks(
                (camera.intrinsics.width_px, camera.intrinsics.height_px), rain_mm_h, camera.name
            )
            for camera in self.cameras.values()
            if rain_mm_h > 0.0
        }
        self._taken = dict.fromkeys(self.cameras, 0)
        self.identity = ""
        if shares_pictures:
            cameras = self.cameras.values()
            self.identity = scene_identity(identity, rain_mm_h, models, cameras, supersampling)

    @property
    def actors(self) -> tuple[str, ...]:
        """Actors of the numbers in ``Frame.instance``, from 1."""
        return tuple(self._numbers)

    def close(self) -> None:
        """Release what the renderer holds."""
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
        lights = self._bodies.lights(there, t_ns)
        return [self._picture(self.cameras[name], there, poses, lights, t_ns) for name in names]

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> dict[str, Prospect]:
        """Return what pictures of an instant would show, by camera, without taking them.

        A body counts, hidden or not, if it would change a pixel through the air that there is. An
        exposure without a body counts as taken by the rain, which is the same with or without it.
        """
        there = {body.actor: body for body in bodies}
        poses = {actor: body.pose for actor, body in there.items()}
        lights = self._bodies.lights(there, t_ns)
        found = {}
        for name in names:
            camera = self.cameras[name]
            view = camera.view(there)
            others = [body for actor, body in there.items() if actor != camera.carrier]
            has_body = bool(self._bodies.spots(view, lights, poses, camera.carrier)) or any(
                (seen := self._bodies.seen(body, poses[body.actor], view)) and seen.is_large
                for body in others
            )
            found[name] = Prospect(view, has_body)
            self._taken[name] += not has_body
        return found

    def state(self, name: str) -> CameraState:
        """Return the state of a camera, from which its next picture is drawn."""
        own = self._own.get(name)
        moves = not self.cameras[name].is_fixed
        return CameraState(
            self._backgrounds[name].drawings if moves else (),
            None if own is None else own.body,
            self._taken[name] if self._changes(name) else 0,
        )

    def resume(self, name: str, state: CameraState) -> None:
        """Continue from a state of a camera, as if the pictures that led to it had been drawn."""
        camera = self.cameras[name]
        self._plain.pop(name, None)
        self._own.pop(name, None)
        self._taken[name] = state.taken
        if not camera.is_fixed:
            self._backgrounds[name].resume(state.drawings)
        if state.own is not None:
            view = camera.view({state.own.actor: state.own})
            self._own_layer(name, state.own, state.own.pose, view)

    def own_aircraft(self, name: str) -> Mask:
        """Return the pixels of a camera that its own aircraft may cover, shape (rows, columns).

        It is in its place with wheels up or down, and some pixels larger; none of a camera that
        does not see the aircraft that carries it.
        """
        camera = find_camera(self.cameras, name)
        lens = camera.intrinsics
        covered = np.zeros((lens.height_px, lens.width_px), dtype=bool)
        if isinstance(camera.at, Pose) or not camera.at.sees_own_aircraft:
            return covered
        model = self._models[camera.at.actor]
        view = View(lens, camera.at.pose)
        for name in model.shapes:
            shape = f"{model.kind}/{name}"
            projected = self._bodies.outlines[shape].seen(AT_ORIGIN, view)
            if projected is None or projected.in_picture.area <= 0.0:
                continue
            window = projected.in_picture.window(view)
            part = Part(shape, AT_ORIGIN, window, OWN_SAMPLES)
            drawn = by_sample(self._renderer.parts(view, [part])[0].distance_m, OWN_SAMPLES)
            covered[window.slices] |= np.isfinite(drawn).any(axis=0)
        return grown(covered, OWN_MARGIN_PX)

    def _picture(
        self,
        camera: Camera,
        bodies: Mapping[str, BodyState],
        poses: Mapping[str, Pose],
        lights: Mapping[str, Sequence[Light]],
        t_ns: int,
    ) -> Frame:
        name, view = camera.name, camera.view(bodies)
        background = self._backgrounds[name]
        background.look(view)
        others = [body for actor, body in bodies.items() if actor != camera.carrier]
        seen = [one for body in others if (one := self._bodies.seen(body, poses[body.actor], view))]
        drawn = [one for one in seen if one.leaves_a_trace]
        shadows = [
            part for body in others if (part := self._bodies.shadow(body, poses[body.actor], view))
        ]
        own = None
        if isinstance(camera.at, Mount) and camera.at.sees_own_aircraft:
            carrier = camera.at.actor
            own = self._own_layer(name, bodies[carrier], poses[carrier], view)
        spots = self._bodies.spots(view, lights, poses, camera.carrier)
        if not camera.is_fixed and self._light.needs_lights:
            spots.extend(self._fixed_lights.seen(view, self._light))
        is_plain = not (drawn or shadows or spots or self._changes(name))
        last = self._plain.pop(name, None)
        layers: list[Layer] = []
        unchanged = False
        if is_plain and last and last.drawn == background.drawn and last.own is own:
            frame, unchanged = last.frame, True
        else:
            frame, layers = self._draw(name, t_ns, view, background, drawn, shadows, own, spots)
        if is_plain:
            self._plain[name] = _Plain(background.drawn, own, frame)
        sightings = sightings_of(
            layers,
            [one for one in seen if not one.leaves_a_trace],
            {actor: one.label for actor, one in self._models.items() if actor != camera.carrier},
            self._light.extinction_per_m,
        )
        return replace(frame, t_ns=t_ns, view=view, sightings=sightings, unchanged=unchanged)

    def _draw(
        self,
        name: str,
        t_ns: int,
        view: View,
        background: Background,
        drawn: Sequence[VisibleBody],
        shadows: Sequence[Part],
        own: Layer | None,
        spots: Sequence[Spot],
    ) -> tuple[Frame, list[Layer]]:
        """Return a picture without its sightings, and its layers from far to near."""
        colour, distance = background.colour.copy(), background.distance_m.copy()
        instance = np.zeros(distance.shape, dtype=np.uint8)
        parts = [self._bodies.part(one) for one in drawn]
        pictures = self._renderer.parts(view, [*shadows, *parts])
        for part, picture in zip(shadows, pictures, strict=False):
            darken(colour, part, picture, view, background, self._light)
        layers = [
            self._layer(one, part, picture, background.distance_m[one.window.slices])
            for one, part, picture in zip(drawn, parts, pictures[len(shadows) :], strict=True)
        ]
        if own is not None:
            layers.append(own)
        layers.sort(key=lambda layer: -layer.range_m)
        for layer in layers:
            layer.lay(colour, distance, instance)
        shine(colour, distance, spots)
        if name in self._streaks:
            bright = 40.0 + 170.0 * (1.0 - self._light.darkness)
            self._streaks[name].fall(colour, self._taken[name], bright)
        if self.cameras[name].imaging != IDEAL:
            colour = self._sensor(name).expose(colour, self._taken[name])
        self._taken[name] += 1
        for plane in (colour, distance, instance):
            plane.flags.writeable = False  # Several frames may have it.
        return Frame(name, t_ns, view, colour, distance, instance, ()), layers

    def _changes(self, name: str) -> bool:
        """Return whether two pictures of the same differ, by rain or by noise."""
        return name in self._streaks or self.cameras[name].imaging.noise_levels > 0.0

    def _sensor(self, name: str) -> ImageSensor:
        """Return the sensor of a camera, which is made when it takes its first picture."""
        if name not in self._sensors:
            camera = self.cameras[name]
            self._sensors[name] = ImageSensor(name, camera.intrinsics, camera.imaging)
        return self._sensors[name]

    def _light_up(self, colour: npt.NDArray[np.uint8], distance_m: Floats, view: View) -> None:
        """Draw the lights of the landscape, which are always on, into what is drawn once."""
        if self._light.needs_lights:
            shine(colour, distance_m, self._fixed_lights.seen(view, self._light))

    def _layer(self, seen: VisibleBody, part: Part, drawn: Samples, behind_m: Floats) -> Layer:
        return Layer.of(self._numbers[seen.body.actor], seen, drawn, part.samples, behind_m)

    def _own_layer(self, name: str, body: BodyState, pose: Pose, view: View) -> Layer | None:
        """Return the camera's own aircraft; it is drawn anew when its light has changed."""
        light = np.round(np.asarray(self._light.sun) @ pose.rotation * TURN_STEPS)
        key = (body.shape, *light.tolist())
        kept = self._own.get(name)
        if kept is None or kept.light != key:
            seen = self._bodies.seen(body, pose, view)
            if seen is None:
                return None
            part = self._bodies.part(seen)
            drawn = self._renderer.parts(view, [part])[0]
            nothing = np.full((seen.window.height, seen.window.width), np.inf, dtype=np.float32)
            layer = self._layer(seen, part, drawn, nothing)
            layer.range_m = 0.0
            kept = self._own[name] = _OwnAircraft(key, layer, body)
        return kept.layer
