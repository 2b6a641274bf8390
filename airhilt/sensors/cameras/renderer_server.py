"""The process of a renderer: draws what it is asked for, until there are no more questions.

`airhilt.sensors.cameras.renderer_process` starts it. Given the name of a renderer instead of
descriptors, it tries whether that can draw here.
"""

from __future__ import annotations

import json
import mmap
import os
import select
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from threading import Thread
from typing import Any

from airhilt.errors import AirhiltError, RendererError
from airhilt.imaging.masks import runs_of
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import UNSEEN_FIELDS
from airhilt.sensors.cameras.camera_state import CameraState
from airhilt.sensors.cameras.frame import Frame
from airhilt.sensors.cameras.mounts import Camera, cameras_named
from airhilt.sensors.cameras.renderers import require_renderer
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.scene.builder import open_scene_renderer
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.sensors.cameras.shared_pixels import places_of, planes
from airhilt.world.site import ScenarioSite

GRACE_S = 0.5
"""Time for which a picture that nobody waits for any more is still drawn, in s."""


class RendererServer:
    """Answers questions: a first one, which opens a scene, and those for pictures of it.

    Parameters
    ----------
    shared
        Descriptor of the file for pixels, which has its size when a scene is opened.
    """

    def __init__(self, shared: int) -> None:
        self._shared = shared
        self._opening: dict[str, Any] = {}
        self._scene: SceneRenderer | None = None
        self._cameras: Mapping[str, Camera] = {}
        self._opened: dict[str, Any] = {}

    def answer(self, question: dict[str, Any]) -> dict[str, Any]:
        """Return the answer to a question, or an error as JSON."""
        try:
            if "scenario" in question:
                return self._open(question)
            return self._draw(question)
        except AirhiltError as error:
            return {"error": type(error).__name__, "text": str(error)}

    def close(self) -> None:
        """Close the scene."""
        if self._scene is not None:
            self._scene.close()
        self._scene, self._opening = None, {}

    def _open(self, question: dict[str, Any]) -> dict[str, Any]:
        """Open a scene, or begin anew with the one that is open if it is the same."""
        names = question["cameras"]
        scenario = Scenario.model_validate(question["scenario"])
        seen = scenario.model_dump(mode="json", exclude=set(UNSEEN_FIELDS))
        opening = {**question, "scenario": seen}
        if self._scene is None or opening != self._opening:
            self.close()
            self._scene = scene = self._opened_scene(scenario, question)
            self._opening = opening
            self._opened = {
                "renderer": scene.renderer,
                "actors": scene.actors,
                "identity": scene.identity,
                "own_aircraft": {name: runs_of(scene.own_aircraft(name)) for name in names},
            }
        for name in names:
            self._scene.resume(name, CameraState())
        self._places, self._pixels = places_of(self._cameras), mmap.mmap(self._shared, 0)
        return self._opened

    def _opened_scene(self, scenario: Scenario, question: Mapping[str, Any]) -> SceneRenderer:
        names = question["cameras"]
        self._cameras = cameras_named(scenario, names)
        return open_scene_renderer(
            scenario,
            ScenarioSite.of(scenario),
            names,
            question["renderer"],
            question["supersampling"],
            keeps_backgrounds=True,
            shares_pictures=question["shares_pictures"],
        )

    def _draw(self, question: Mapping[str, Any]) -> dict[str, Any]:
        """Draw pictures, or tell what they would show, from the states that are given if any are.

        Raises
        ------
        CameraError
            A camera cannot see anything.
        RendererError
            No scene is open.
        """
        scene, names = self._scene, question["cameras"]
        if scene is None:
            raise RendererError("no scene is open")
        for name, given in zip(names, question.get("states", ()), strict=False):
            if scene.state(name).to_json() != given:
                lens = self._cameras[name].intrinsics
                scene.resume(name, CameraState.of_json(given, lens))
        bodies = [BodyState(*body) for body in question["bodies"]]
        told: dict[str, Any] = {}
        if question["draw"]:
            frames = scene.shoot(names, bodies, question["t_ns"])
            told["pictures"] = {frame.camera: self._told(frame) for frame in frames}
        else:
            told["has_body"] = scene.has_body(names, bodies, question["t_ns"])
        if "states" in question:
            told["states"] = [scene.state(name).to_json() for name in names]
        return told

    def _told(self, frame: Frame) -> dict[str, Any]:
        """Write the pixels of a picture if they are new, and return what is answered besides."""
        if not frame.unchanged:
            place, camera = self._places[frame.camera], self._cameras[frame.camera]
            colour, instance, distance = planes(self._pixels, place, camera)
            colour[...] = frame.colour
            instance[...] = frame.instance
            distance[...] = frame.distance_m
        return {
            "sightings": [asdict(sighting) for sighting in frame.sightings],
            "unchanged": frame.unchanged,
        }


def _end_with_asker(questions: int) -> None:
    """End this process when nobody can ask any more, even in the middle of a picture."""
    hang_up = select.poll()
    hang_up.register(questions, 0)  # What is always reported is that the other end is closed.
    hang_up.poll()
    time.sleep(GRACE_S)
    os._exit(1)


def main(arguments: Sequence[str]) -> None:
    """Serve on the pipes and the file of these descriptors, or try the renderer of that name."""
    if len(arguments) == 1:
        try:
            require_renderer(arguments[0])
        except RendererError as error:
            sys.exit(str(error))
        return
    questions, answers, shared = (int(number) for number in arguments)
    Thread(target=_end_with_asker, args=(questions,), daemon=True).start()
    server = RendererServer(shared)
    with os.fdopen(questions, "rb") as asked, os.fdopen(answers, "wb", buffering=0) as told:
        for line in asked:
            told.write(json.dumps(server.answer(json.loads(line))).encode() + b"\n")
    server.close()


if __name__ == "__main__":
    main(sys.argv[1:])
