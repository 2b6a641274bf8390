"""A short run that cameras look at, quickly and without a renderer."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, cast

import pytest

from airhilt import load
from airhilt.cosim import cameras as vision
from airhilt.cosim import participants as team
from airhilt.cosim import simulation as cosim
from airhilt.cosim.reference_workers import reference_workers
from airhilt.metrics.result import Result
from airhilt.options import Options
from airhilt.scenario import Scenario
from oracle import BlankSceneRenderer, Oracle


def passing() -> Scenario:
    """Ten seconds of two aircraft that fly at each other and past each other, 100 m apart."""
    document = json.loads(load("s02a_headon").model_dump_json())
    for actor in document["actors"]:
        actor["initial"]["position"]["distance_nm"] = 0.8
    document["actors"][0]["initial"]["altitude_ft"] += 330
    for camera in document["cameras"]:
        camera["rate_hz"] = 4.0
    return Scenario.model_validate(document | {"name": "passing", "duration_s": 10.0})


def camera_run(
    out: Path, patch: pytest.MonkeyPatch, scenario: Scenario | None = None, **options: Any
) -> Result:
    """Run it with an oracle that looks; what it finds is true, with errors."""
    oracle = Oracle(cast(Any, None), 0, 8.0)
    reference = reference_workers

    def open_scene_renderer(realised: Scenario, *_: Any) -> BlankSceneRenderer:
        oracle._renderer = BlankSceneRenderer(realised)
        return oracle._renderer

    def workers(given: Options, scenario: Scenario, taken: Any, *_: Any) -> list[Any]:
        others = reference(given.model_copy(update={"detector": "none"}), scenario, taken)
        return [*others, oracle] if given.assistant != "none" else others

    patch.setattr(vision, "_start_renderers", lambda *_: ())
    patch.setattr(vision, "_open_renderer", open_scene_renderer)
    patch.setattr(team, "reference_workers", workers)
    given = Options(**{"latency": "fixed", "speech": False, "out": out} | options)
    return cosim.run(scenario or passing(), given)
