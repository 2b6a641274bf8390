"""The process of a renderer: draws what it is asked for, until there are no more questions.

`airhilt.sensors.cameras.renderer_process` starts it. Given the name of a renderer instead of
descriptors, it tries whether that can draw here.
"""

from __future__ import annotations

import json
import mmap
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import IO, Any

from airhilt.errors import AirhiltError, RendererError
from airhilt.imaging.masks import runs_of
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.camera_state import CameraState
from airhilt.sensors.cameras.frame import Frame
from airhilt.sensors.cameras.mounts import Camera, cameras_named
from airhilt.sensors.cameras.renderers import require_renderer
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.scene.builder import open_scene_renderer
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.sensors.cameras.shared_pixels import Planes, places_of, planes
from airhilt.world.site import ScenarioSite


def serve(questions: IO[bytes], answer: Callable[[Any], None], shared: int) -> None:
    """Answer questions; the first one says what to draw, and with what.

    Parameters
    ----------
    shared
        Descriptor of the file for pixels, which has its size when the first question comes.
    """
    line = questions.readline()
    if not line:
        return
    opening = json.loads(line)
    scenario = Scenario.model_validate(opening["scenario"])
    names = opening["cameras"]
    cameras = cameras_named(scenario, names)
    places, pixels = places_of(cameras), mmap.mmap(shared, 0)
    try:
        scene_renderer = open_scene_renderer(
            scenario,
            ScenarioSite.of(scenario),
            names,
            opening["renderer"],
            opening["supersampling"],
            keeps_backgrounds=True,
            shares_pictures=opening["shares_pictures"],
        )
    except AirhiltError as error:
        answer(_failure(error))
        return
    answer(
        {
            "renderer": scene_renderer.renderer,
            "actors": scene_renderer.actors,
            "identity": scene_renderer.identity,
            "own_aircraft": {name: runs_of(scene_renderer.own_aircraft(name)) for name in names},
        }
    )
    for line in questions:
        question = json.loads(line)
        bodies = [BodyState(*body) for body in question["bodies"]]
        ask = question["cameras"], bodies, question["t_ns"]
        try:
            _resume(scene_renderer, cameras, question)
            if question["draw"]:
                frames = scene_renderer.shoot(*ask)
                told: dict[str, Any] = {
                    "pictures": {frame.camera: _picture(frame) for frame in frames}
                }
            else:
                frames = []
                told = {"has_body": scene_renderer.has_body(*ask)}
        except AirhiltError as error:
            answer(_failure(error))
            continue
        for frame in frames:
            if not frame.unchanged:
                _write_pixels(frame, planes(pixels, places[frame.camera], cameras[frame.camera]))
        if "states" in question:
            states = [scene_renderer.state(name).to_json() for name in question["cameras"]]
            told["states"] = states
        answer(told)
    scene_renderer.close()


def _resume(
    scene_renderer: SceneRenderer, cameras: Mapping[str, Camera], question: Mapping[str, Any]
) -> None:
    """Take up the states from which a question wants pictures drawn, if it has any."""
    for name, given in zip(question["cameras"], question.get("states", ()), strict=False):
        if scene_renderer.state(name).to_json() != given:
            state = CameraState.of_json(given, cameras[name].intrinsics)
            scene_renderer.resume(name, state)


def _write_pixels(frame: Frame, planes: Planes) -> None:
    colour, instance, distance = planes
    colour[...] = frame.colour
    instance[...] = frame.instance
    distance[...] = frame.distance_m


def _picture(frame: Frame) -> dict[str, Any]:
    """Return what is answered about a picture besides its pixels."""
    return {
        "sightings": [asdict(sighting) for sighting in frame.sightings],
        "unchanged": frame.unchanged,
    }


def _failure(error: AirhiltError) -> dict[str, str]:
    return {"error": type(error).__name__, "text": str(error)}


def main(arguments: Sequence[str]) -> None:
    """Serve on the pipes and the file of these descriptors, or try the renderer of that name."""
    if len(arguments) == 1:
        try:
            require_renderer(arguments[0])
        except RendererError as error:
            sys.exit(str(error))
        return
    questions, answers, shared = (int(number) for number in arguments)
    with os.fdopen(questions, "rb") as asked, os.fdopen(answers, "wb", buffering=0) as told:
        serve(asked, lambda message: _write(told, message), shared)


def _write(answers: IO[bytes], message: Any) -> None:
    answers.write(json.dumps(message).encode() + b"\n")


if __name__ == "__main__":
    main(sys.argv[1:])
