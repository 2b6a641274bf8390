"""Pictures from a process of its own, so that a renderer that crashes takes no run with it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from typing import Any

from airhilt.errors import RendererLost
from airhilt.imaging.masks import Mask, mask_of
from airhilt.imaging.view import View
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import AUTO, STILL_SAMPLES
from airhilt.sensors.cameras.camera_state import CameraState
from airhilt.sensors.cameras.frame import Frame, Prospect, Sighting
from airhilt.sensors.cameras.mounts import Camera, cameras_named, find_camera
from airhilt.sensors.cameras.renderer_link import Planes, RendererLink, pixels_bytes, planes_of
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.scene.projected_box import Box

STARTING_S = 120.0
"""Time that the process has to open its scene, in s."""
PATIENCE_S = 60.0
"""Time that it has for the pictures of one instant, in s."""
SLOWEST_SAMPLES_PER_S = 250_000.0
"""Samples that a renderer on a busy core draws in a second; it is given the time for all."""


class RendererProcess:
    """Takes pictures as a `SceneRenderer` does, in another process.

    Parameters
    ----------
    names
        Names of the cameras; None takes those that the scenario declares.
    patience_s
        Time for the pictures of one instant, before the renderer is given up. The time to draw
        all that the cameras see, sample by sample, is added.
    link
        A process that has been started before, which stays; None: a new one, which ends with this.
    shares_pictures
        True if other runs may have the same pictures.

    Attributes
    ----------
    renderer
        Name of the renderer that draws.
    own_aircraft
        Pixels that the aircraft which carries the camera may cover, by camera; shape (rows,
        columns).
    identity
        Identity of the scene if pictures are shared: see `SceneRenderer`.
    states
        States of the cameras as JSON, from which their next pictures are drawn if pictures are
        shared: see `CameraState.to_json`. Each picture changes them, and so may the caller.

    Raises
    ------
    CameraError
        There is no such camera, or it could see nothing.
    RendererError
        The renderer cannot be opened; `RendererLost` if its process has died.
    """

    def __init__(
        self,
        scenario: Scenario,
        names: Sequence[str] | None = None,
        renderer: str = AUTO,
        supersampling: int = 1,
        patience_s: float = PATIENCE_S,
        link: RendererLink | None = None,
        shares_pictures: bool = False,
    ) -> None:
        self.renderer = renderer
        wanted = [camera.name for camera in scenario.cameras] if names is None else list(names)
        self._cameras = cameras_named(scenario, wanted)
        samples = sum(_samples(camera, supersampling) for camera in self._cameras.values())
        drawing_s = samples / SLOWEST_SAMPLES_PER_S
        self._patience_s = patience_s + drawing_s
        self._last: dict[str, Frame] = {}
        self._shares_pictures = shares_pictures
        self.states: dict[str, Any] = dict.fromkeys(self._cameras, CameraState().to_json())
        self._planes: dict[str, Planes] = {}
        self._owned = link is None
        try:
            self._link = link or RendererLink()
        except OSError as error:
            raise _not_started(renderer, error) from None
        try:
            self._planes = self._share_memory()
            opened = self._link.draw(
                {
                    "scenario": scenario.model_dump(mode="json"),
                    "cameras": wanted,
                    "renderer": renderer,
                    "supersampling": supersampling,
                    "shares_pictures": shares_pictures,
                },
                STARTING_S + drawing_s,
                renderer,
            )
        except BaseException:
            self.close()
            raise
        self.renderer = opened["renderer"]
        self.identity: str = opened["identity"]
        self.own_aircraft: Mapping[str, Mask] = {
            name: _mask(runs, self._cameras[name]) for name, runs in opened["own_aircraft"].items()
        }

    def shoot(self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int) -> list[Frame]:
        """Take the pictures of all cameras that are due at an instant.

        Raises
        ------
        CameraError
            A pose is not finite, or a camera is mounted on something that is not there.
        RendererLost
            The renderer's process has died, or does not answer.
        """
        views = self.views(names, bodies)
        pictures = self._ask_of(names, bodies, t_ns, draw=True)["pictures"]
        return [self._frame(name, t_ns, views[name], pictures[name]) for name in names]

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> dict[str, Prospect]:
        """Return what the pictures of an instant would show, by camera, without taking them.

        It raises what `shoot` does.
        """
        views = self.views(names, bodies)
        has_body = self._ask_of(names, bodies, t_ns, draw=False)["has_body"]
        return {name: Prospect(views[name], has_body[name]) for name in names}

    def views(self, names: Sequence[str], bodies: Sequence[BodyState]) -> dict[str, View]:
        """Return the views of cameras by name.

        Raises
        ------
        CameraError
            As `shoot`.
        """
        there = {body.actor: body for body in bodies}
        return {name: find_camera(self._cameras, name).view(there) for name in names}

    def _ask_of(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int, *, draw: bool
    ) -> Any:
        question = {
            "cameras": list(names),
            "bodies": [list(body) for body in bodies],
            "t_ns": t_ns,
            "draw": draw,
        }
        if self._shares_pictures:
            question["states"] = [self.states[name] for name in names]
        answer = self._link.draw(question, self._patience_s, self.renderer)
        if self._shares_pictures:
            self.states.update(zip(names, answer["states"], strict=True))
        return answer

    def _frame(self, name: str, t_ns: int, view: View, answer: Mapping[str, Any]) -> Frame:
        sightings = tuple(sighting_of(found) for found in answer["sightings"])
        last = self._last.get(name)
        if answer["unchanged"] and last is not None:
            return replace(last, t_ns=t_ns, view=view, sightings=sightings, unchanged=True)
        colour, distance, instance = self._planes[name]
        frame = Frame(
            name, t_ns, view, colour.copy(), distance.copy(), instance.copy(), sightings
        ).sealed()
        self._last[name] = frame
        return frame

    def close(self) -> None:
        """End the process, unless it was given."""
        self._planes.clear()
        self._last.clear()
        if self._owned:
            self._link.close()

    def __enter__(self) -> RendererProcess:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def process_id(self) -> int:
        """Identifier of the other process."""
        return self._link.process_id

    def _share_memory(self) -> dict[str, Planes]:
        lenses = {name: camera.intrinsics for name, camera in self._cameras.items()}
        try:
            self._link.shared.truncate(max(pixels_bytes(lenses.values()), 1))
            return planes_of(self._link.shared.fileno(), lenses)
        except OSError as error:
            raise _not_started(self.renderer, error) from None


def probe(renderer: str) -> None:
    """Let a process of its own draw something.

    Raises
    ------
    RendererError
        It could not.
    """
    with closing(RendererLink()) as link:
        link.draw({"probe": renderer}, STARTING_S, renderer)


def _not_started(renderer: str, error: OSError) -> RendererLost:
    return RendererLost(
        f"the renderer {renderer} cannot be started: {error.strerror}; expected memory for one "
        "more process and its pictures"
    )


def _samples(camera: Camera, supersampling: int) -> int:
    """Return how many samples a picture has at most; a fixed camera's first one has more."""
    along = max(supersampling, STILL_SAMPLES) if camera.is_fixed else supersampling
    return camera.intrinsics.width_px * camera.intrinsics.height_px * along**2


def _mask(runs: Sequence[int], camera: Camera) -> Mask:
    return mask_of(runs, camera.intrinsics.height_px, camera.intrinsics.width_px)


def sighting_of(found: Mapping[str, Any]) -> Sighting:
    """Return a sighting from what `dataclasses.asdict` makes of it, read from JSON."""
    return Sighting(**{**found, "box": Box(*found["box"])})
