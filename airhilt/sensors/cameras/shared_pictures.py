"""Pictures that runs share: each is drawn by the run that takes it first, and by no other.

A picture is determined by its scene, the states of its cameras, the bodies and the time. What the
log has of it is kept under their hash: the truth, the SHA-256 of the pixels, and the states that
it leaves behind. The pixels are not kept. A run that finds a picture has it drawn only if somebody
reads its pixels, by a renderer that is told the states; so it may go its own way at any time.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Callable, Sequence
from dataclasses import asdict
from functools import partial
from typing import Any

from airhilt.errors import RendererError
from airhilt.host.caches import CacheFolder
from airhilt.sensors.cameras.camera_state import CameraState
from airhilt.sensors.cameras.frame import Prospect
from airhilt.sensors.cameras.pictures import CameraPicture, DrawnPictures
from airhilt.sensors.cameras.renderer_process import RendererProcess, sighting_of
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sim.payload import DeferredBytes

COMPRESSION = 1
"""Level of zlib. States differ little from those before, which are its dictionary."""


class SharedPictures:
    """Takes pictures as `DrawnPictures` does, and draws those that no run has drawn before.

    Parameters
    ----------
    process
        Process that draws, opened to share its pictures, with an identity of its scene.
    """

    def __init__(self, process: RendererProcess) -> None:
        self.own_aircraft = process.own_aircraft
        self._process = process
        self._drawn = DrawnPictures(process)
        self._folder = CacheFolder("pictures")
        self._states: dict[str, Any] = dict.fromkeys(process.states, CameraState().to_json())
        self._failure: RendererError | None = None
        """Reason why pixels that somebody wanted to read could not be drawn."""

    def take(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> list[CameraPicture]:
        """Take the pictures; it raises what `RendererProcess.shoot` does.

        So it does, though it may know them, when the pixels of earlier ones could not be drawn.
        """
        self._require_renderer()
        views = self._process.views(names, bodies)
        before = dict(self._states)
        drawn: dict[str, CameraPicture] = {}

        def draw() -> dict[str, Any]:
            drawn.update({each.camera: each for each in self._drawn.take(names, bodies, t_ns)})
            return {
                name: {"sightings": [asdict(one) for one in each.sightings], "sha256": each.sha256}
                for name, each in drawn.items()
            }

        known = self._known("picture", names, bodies, t_ns, draw)
        return [
            drawn.get(name)
            or CameraPicture(
                name,
                view,
                tuple(sighting_of(found) for found in known[name]["sightings"]),
                known[name]["sha256"],
                DeferredBytes(
                    3 * view.intrinsics.width_px * view.intrinsics.height_px,
                    partial(self._pixels, name, bodies, t_ns, before[name]),
                ),
            )
            for name, view in views.items()
        ]

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> dict[str, Prospect]:
        """Return what pictures would show; it raises what `take` does."""
        self._require_renderer()
        views = self._process.views(names, bodies)

        def look() -> dict[str, bool]:
            found = self._process.prospects(names, bodies, t_ns)
            return {name: each.has_body for name, each in found.items()}

        known = self._known("prospect", names, bodies, t_ns, look)
        return {name: Prospect(view, known[name]) for name, view in views.items()}

    def _known(
        self,
        question: str,
        names: Sequence[str],
        bodies: Sequence[BodyState],
        t_ns: int,
        answer: Callable[[], dict[str, Any]],
    ) -> dict[str, Any]:
        """Return the answer to a question, and take over the states that it leaves behind."""
        states = {name: self._states[name] for name in names}
        key = json.dumps([self._process.identity, question, states, bodies, t_ns])

        def make() -> bytes:
            self._process.states.update(states)
            made = answer()
            after = {name: self._process.states[name] for name in names}
            packer = zlib.compressobj(COMPRESSION, zdict=key.encode())
            return packer.compress(json.dumps([made, after]).encode()) + packer.flush()

        kept = self._folder.get(key, make)
        unpacker = zlib.decompressobj(zdict=key.encode())
        known, after = json.loads(unpacker.decompress(kept) + unpacker.flush())
        self._states.update(after)
        found: dict[str, Any] = known
        return found

    def _pixels(self, name: str, bodies: Sequence[BodyState], t_ns: int, state: Any) -> bytes:
        """Return the pixels of a picture that another run has drawn.

        Raises
        ------
        RendererError
            They cannot be drawn; those who read them go on without, and the next `take` says why.
        """
        self._process.states[name] = state
        try:
            return bytes(self._drawn.take([name], bodies, t_ns)[0].pixels)
        except RendererError as error:
            self._failure = error
            raise

    def _require_renderer(self) -> None:
        if self._failure is not None:
            raise self._failure
