"""Pictures that runs share: each is drawn by the run that takes it first, and by no other.

A picture is determined by its scene, the states of its cameras, the bodies and the time. What the
log has of it is kept under their hash: the truth, the SHA-256 of the pixels, and the states that
it leaves behind. The pixels are not kept. A run that finds a picture has it drawn only if somebody
reads its pixels, by a renderer that is told the states; so it may go its own way at any time.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from typing import Any, Literal

from airhilt.errors import RendererError
from airhilt.host.caches import CacheFolder
from airhilt.imaging.view import View
from airhilt.sensors.cameras.camera_state import CameraState
from airhilt.sensors.cameras.frame import CameraPicture, Prospect, Sighting
from airhilt.sensors.cameras.renderer_process import RendererProcess, States
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.scene.projected_box import Box
from airhilt.sim.payload import DeferredBytes

COMPRESSION = 1
"""Level of zlib."""


class SharedPictures:
    """Takes pictures as `RendererProcess` does, and draws those that no run has drawn before.

    Parameters
    ----------
    renderer
        Draws; opened to share its pictures, with an identity of its scene.
    """

    def __init__(self, renderer: RendererProcess) -> None:
        self.own_aircraft = renderer.own_aircraft
        self._renderer = renderer
        self._folder = CacheFolder("pictures")
        self._states: States = {}
        self._failure: RendererError | None = None
        """Reason why pixels that somebody wanted to read could not be drawn."""

    def take(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> list[CameraPicture]:
        """Take the pictures; it raises what `RendererProcess.take` does.

        So it does, though it may know them, when the pixels of earlier ones could not be drawn.
        """
        states = self._states_of(names)
        drawn: dict[str, CameraPicture] = {}

        def told(taken: dict[str, CameraPicture]) -> dict[str, Any]:
            drawn.update(taken)
            return {
                name: {"sightings": [asdict(one) for one in each.sightings], "sha256": each.sha256}
                for name, each in taken.items()
            }

        views, known = self._known("take", names, bodies, t_ns, told)
        return [
            drawn.get(name)
            or CameraPicture(
                name,
                view,
                tuple(_sighting(found) for found in known[name]["sightings"]),
                known[name]["sha256"],
                DeferredBytes(
                    3 * view.intrinsics.width_px * view.intrinsics.height_px,
                    partial(self._pixels, name, bodies, t_ns, states[name]),
                ),
            )
            for name, view in views.items()
        ]

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> dict[str, Prospect]:
        """Return what pictures would show; it raises what `take` does."""

        def told(found: dict[str, Prospect]) -> dict[str, bool]:
            return {name: each.has_body for name, each in found.items()}

        views, known = self._known("prospects", names, bodies, t_ns, told)
        return {name: Prospect(view, known[name]) for name, view in views.items()}

    def _known(
        self,
        what: Literal["take", "prospects"],
        names: Sequence[str],
        bodies: Sequence[BodyState],
        t_ns: int,
        told: Callable[[dict[str, Any]], dict[str, Any]],
    ) -> tuple[dict[str, View], dict[str, Any]]:
        """Return the views of cameras and what is kept of an answer; take over the states after it.

        Parameters
        ----------
        told
            Returns what is kept of an answer of the renderer, as JSON.
        """
        if self._failure is not None:
            raise self._failure
        views = self._renderer.views(names, bodies)
        states = self._states_of(names)
        key = json.dumps([self._renderer.identity, what, states, bodies, t_ns])

        def make() -> bytes:
            found, after = self._renderer.ask(what, names, bodies, t_ns, states)
            return zlib.compress(json.dumps([told(found), after]).encode(), COMPRESSION)

        known, after = json.loads(zlib.decompress(self._folder.get(key, make)))
        self._states.update(after)
        return views, known

    def _states_of(self, names: Sequence[str]) -> States:
        return {name: self._states.get(name) or CameraState().to_json() for name in names}

    def _pixels(self, name: str, bodies: Sequence[BodyState], t_ns: int, state: Any) -> bytes:
        """Return the pixels of a picture that another run has drawn.

        Raises
        ------
        RendererError
            They cannot be drawn; those who read them go on without, and the next `take` says why.
        """
        try:
            taken, _ = self._renderer.ask("take", [name], bodies, t_ns, {name: state})
        except RendererError as error:
            self._failure = error
            raise
        return bytes(taken[name].pixels)


def _sighting(found: Mapping[str, Any]) -> Sighting:
    """Return a sighting from what `dataclasses.asdict` makes of it, read from JSON."""
    return Sighting(**{**found, "box": Box(*found["box"])})
