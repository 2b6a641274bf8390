"""The process of a renderer; `airhilt.sensors.cameras.renderer_process` starts it."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from airhilt.host.child_process import serve
from airhilt.imaging.masks import Mask
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import UNSEEN_FIELDS
from airhilt.sensors.cameras.camera_state import CameraState
from airhilt.sensors.cameras.frame import CameraPicture, Frame, Prospect
from airhilt.sensors.cameras.renderer_process import States
from airhilt.sensors.cameras.renderers import require_renderer
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.scene.builder import open_scene_renderer
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.world.site import ScenarioSite


class RendererServer:
    """Draws the pictures of one scene at a time."""

    def __init__(self) -> None:
        self._scene: SceneRenderer | None = None
        self._opening: object = None
        self._sha256: dict[str, str] = {}

    def probe(self, renderer: str) -> None:
        """Draw something."""
        require_renderer(renderer)

    def open(
        self,
        scenario: Scenario,
        names: Sequence[str],
        renderer: str,
        supersampling: int,
        shares_pictures: bool,
    ) -> tuple[str, str, dict[str, Mask]]:
        """Open a scene, or begin anew with the one that is open if it is the same.

        Returns
        -------
        tuple
            Name of the renderer that draws, identity of the scene, masks of own aircraft by camera.
        """
        seen = scenario.model_dump(mode="json", exclude=set(UNSEEN_FIELDS))
        opening = (seen, names, renderer, supersampling, shares_pictures)
        if self._scene is None or opening != self._opening:
            if self._scene is not None:
                self._scene.close()
            self._scene = None  # Nothing is open if this one cannot be opened.
            self._scene = open_scene_renderer(
                scenario,
                ScenarioSite.of(scenario),
                names,
                renderer,
                supersampling,
                keeps_backgrounds=True,
                shares_pictures=shares_pictures,
            )
            self._opening = opening
        scene = self._scene
        for name in names:
            scene.resume(name, CameraState())
        own_aircraft = {name: scene.own_aircraft(name) for name in names}
        return scene.renderer, scene.identity, own_aircraft

    def take(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int, states: States
    ) -> tuple[dict[str, CameraPicture], States]:
        """Return pictures by camera; one that is the camera's last one again has no pixels.

        Parameters
        ----------
        states
            States from which they are drawn; those that they leave behind are returned too. Empty:
            the states that earlier pictures have left, and none are returned.
        """
        scene = self._in(states)
        pictures = {
            frame.camera: self._picture(frame) for frame in scene.shoot(names, bodies, t_ns)
        }
        return pictures, {name: scene.state(name).to_json() for name in states}

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int, states: States
    ) -> tuple[dict[str, Prospect], States]:
        """Return what pictures would show; states as `take`."""
        scene = self._in(states)
        prospects = scene.prospects(names, bodies, t_ns)
        return prospects, {name: scene.state(name).to_json() for name in states}

    def _in(self, states: States) -> SceneRenderer:
        """Return the scene with its cameras in these states."""
        assert self._scene is not None, "a scene is opened first"
        for name, given in states.items():
            if self._scene.state(name).to_json() != given:
                lens = self._scene.cameras[name].intrinsics
                self._scene.resume(name, CameraState.of_json(given, lens))
        return self._scene

    def _picture(self, frame: Frame) -> CameraPicture:
        pixels = b"" if frame.unchanged else frame.colour.tobytes()
        if pixels:
            self._sha256[frame.camera] = hashlib.sha256(pixels).hexdigest()
        sha256 = self._sha256[frame.camera]
        return CameraPicture(frame.camera, frame.view, frame.sightings, sha256, pixels)


if __name__ == "__main__":
    serve(RendererServer())
