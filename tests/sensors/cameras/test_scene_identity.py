"""Scenes have the same identity if all that reaches into their pictures is the same."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from airhilt.imaging.view import Intrinsics, Pose
from airhilt.sensors.cameras.mounts import Camera, Mount
from airhilt.sensors.cameras.renderers import embree
from airhilt.sensors.cameras.scene.bodies import aircraft_model, kind_model
from airhilt.sensors.cameras.scene.identity import landscape_identity, scene_identity
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import Landscape
from airhilt.shapes.lights import Light
from airhilt.shapes.mesh import Mesh

POSE = Pose.of((0.0, 0.0, 5.0), 0.2)
GROUND = Mesh.of(np.eye(3), np.array([[0, 1, 2]]), np.array([[0.5, 0.5, 0.5]]))
BLACK = replace(GROUND, colours=np.zeros((1, 3), dtype=np.float32))
LAMP = Light((0.0, 200.0, 2.0), (1.0, 1.0, 1.0), 5_000.0)
SCENE: dict[str, Any] = {
    "renderer": "embree",
    "landscape": Landscape(GROUND, (), ()),
    "light": Illumination(np.array((0.0, 0.6, 0.8)), visibility_m=9_000.0, overcast=0.2),
    "rain_mm_h": 0.0,
    "models": {"OPS1": kind_model("follow_me")},
    "cameras": [Camera("tower", Intrinsics(96, 54, 0.8), POSE)],
    "supersampling": 1,
}


def identity(**changes: Any) -> str:
    scene = {**SCENE, **changes}
    landscape = (scene.pop(name) for name in ("renderer", "landscape", "light"))
    return scene_identity(landscape_identity(*landscape), **scene)


def test_the_same_scene_has_the_same_identity() -> None:
    assert identity() == identity()
    assert len(identity()) == 64


@pytest.mark.parametrize(
    "changes",
    [
        {"landscape": Landscape(BLACK, (), ())},
        {"landscape": Landscape(GROUND, (LAMP,), ())},
        {"light": replace(SCENE["light"], visibility_m=800.0)},
        {"light": replace(SCENE["light"], overcast=0.1)},
        {"light": replace(SCENE["light"], sun=np.array((0.6, 0.0, 0.8)))},
        {"rain_mm_h": 2.0},
        {"models": {"OPS2": kind_model("follow_me")}},
        {"models": {"OPS1": kind_model("deer")}},
        {"models": {"OPS1": aircraft_model("737")}},
        {"cameras": [Camera("tower", Intrinsics(96, 54, 0.9), POSE)]},
        {"cameras": [Camera("tower", Intrinsics(96, 54, 0.8), Mount("OPS1", POSE, False))]},
        {"supersampling": 2},
    ],
    ids=lambda changes: next(iter(changes)),
)
def test_a_scene_that_looks_different_has_another(changes: dict[str, Any]) -> None:
    assert identity(**changes) not in ("", identity())


def test_another_version_of_what_draws_makes_another(monkeypatch: pytest.MonkeyPatch) -> None:
    before = identity()
    monkeypatch.setattr(embree.RENDERER, "distributions", ("numpy",), raising=False)
    assert identity() != before


def test_another_processor_and_other_code_make_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The instructions of a processor decide the last bits of what libraries compute."""
    found = {identity()}
    (tmp_path / "cpuinfo").write_text("model name: another one\n")
    monkeypatch.setattr("airhilt.host.machine.PROCESSOR", tmp_path / "cpuinfo")
    found.add(identity())
    code = "airhilt.sensors.cameras.scene.identity.packages_sha256"
    monkeypatch.setattr(code, lambda *_: "other code")
    assert len(found | {identity()}) == 3


def test_a_scene_of_which_not_all_is_known_has_none() -> None:
    foreign = replace(kind_model("follow_me"), kind="drone")
    assert identity(models={"OPS1": foreign}) == ""
    assert identity(renderer="moderngl") == ""
