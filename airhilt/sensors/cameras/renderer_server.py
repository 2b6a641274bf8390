"""The process of a renderer: draws what it is asked for, until there are no more questions.

`airhilt.sensors.cameras.renderer_link` starts it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from airhilt.errors import AirhiltError
from airhilt.host.child_process import serve
from airhilt.imaging.masks import runs_of
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import UNSEEN_FIELDS
from airhilt.sensors.cameras.camera_state import CameraState
from airhilt.sensors.cameras.frame import Frame
from airhilt.sensors.cameras.renderer_link import planes_of
from airhilt.sensors.cameras.renderers import require_renderer
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.scene.builder import open_scene_renderer
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.world.site import ScenarioSite


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
        self._opened: dict[str, Any] = {}

    def answer(self, question: dict[str, Any]) -> str:
        """Return the answer to a question, or an error, as JSON."""
        try:
            return json.dumps(self._answer(question))
        except AirhiltError as error:
            return json.dumps({"error": type(error).__name__, "text": str(error)})

    def _answer(self, question: dict[str, Any]) -> dict[str, Any]:
        if "probe" in question:
            require_renderer(question["probe"])
            return {}
        return self._open(question) if "scenario" in question else self._draw(question)

    def _open(self, question: dict[str, Any]) -> dict[str, Any]:
        """Open a scene, or begin anew with the one that is open if it is the same."""
        names = question["cameras"]
        scenario = Scenario.model_validate(question["scenario"])
        seen = scenario.model_dump(mode="json", exclude=set(UNSEEN_FIELDS))
        opening = {**question, "scenario": seen}
        if self._scene is None or opening != self._opening:
            if self._scene is not None:
                self._scene.close()
            self._scene = None  # Nothing is open if this one cannot be opened.
            self._scene = scene = open_scene_renderer(
                scenario,
                ScenarioSite.of(scenario),
                names,
                question["renderer"],
                question["supersampling"],
                keeps_backgrounds=True,
                shares_pictures=question["shares_pictures"],
            )
            self._opening = opening
            self._opened = {
                "renderer": scene.renderer,
                "identity": scene.identity,
                "own_aircraft": {name: runs_of(scene.own_aircraft(name)) for name in names},
            }
        for name in names:
            self._scene.resume(name, CameraState())
        lenses = {name: self._scene.cameras[name].intrinsics for name in names}
        self._planes = planes_of(self._shared, lenses)
        return self._opened

    def _draw(self, question: Mapping[str, Any]) -> dict[str, Any]:
        """Draw pictures, or tell what they would show, from the states that are given if any are.

        Raises
        ------
        CameraError
            A camera cannot see anything.
        """
        scene, names = self._scene, question["cameras"]
        assert scene is not None, "the first question opens a scene"
        for name, given in zip(names, question.get("states", ()), strict=False):
            if scene.state(name).to_json() != given:
                scene.resume(name, CameraState.of_json(given, scene.cameras[name].intrinsics))
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
            colour, distance, instance = self._planes[frame.camera]
            colour[...] = frame.colour
            distance[...] = frame.distance_m
            instance[...] = frame.instance
        return {
            "sightings": [asdict(sighting) for sighting in frame.sightings],
            "unchanged": frame.unchanged,
        }


if __name__ == "__main__":
    questions, answers, shared = (int(number) for number in sys.argv[1:])
    serve(questions, answers, RendererServer(shared).answer)
