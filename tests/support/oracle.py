"""A run whose cameras draw nothing, and a detector that is told what is in their pictures.

What it finds is what is large enough and not lost in the air; boxes have errors, and now and then
something is missed. For tests of what is made of detections, quickly and without a renderer.
"""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from airhilt.assistant.vision.detector import Found
from airhilt.assistant.vision.tracker import Tracker
from airhilt.cosim import cameras as vision
from airhilt.cosim import participants as team
from airhilt.cosim import simulation as cosim
from airhilt.cosim.reference_workers import reference_workers
from airhilt.imaging.masks import Mask
from airhilt.messages import (
    CameraFrame,
    CameraView,
    DeclaredLatency,
    Detection,
    Detections,
    InputSpec,
    WorkerDescription,
)
from airhilt.metrics.summary import Summary
from airhilt.options import Options
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.frame import CameraPicture, Sighting
from airhilt.sensors.cameras.mounts import cameras_of
from airhilt.sensors.cameras.scene.bodies import BodyState, model_of
from airhilt.sensors.cameras.scene.projected_box import Outline
from airhilt.sim.worker import Input, Output
from airhilt.units import SECOND_NS
from airhilt.workers.protocol import Step
from airhilt.world.site import ScenarioSite
from nominal import nominal

SMALLEST_PX = 8.0
LEAST_TRANSMISSION = 0.15
MISSED = 0.1
ERROR_PX = 0.7
LABELS = ("airplane", "truck", "bird", "deer", "coyote")
"""Labels that a false box may have."""
PICTURES_MISSED, FALSE_BOXES = 0.1, 0.1
SURE = 0.4
HIDDEN_EVERY_NS, HIDDEN_NS = 10 * SECOND_NS, 3 * SECOND_NS // 2


@cache
def _blank(size: int) -> tuple[bytes, str]:
    """Return black pixels and their SHA-256."""
    return bytes(size), hashlib.sha256(bytes(size)).hexdigest()


class BlankSceneRenderer:
    """Takes pictures without colours, with what is true of the bodies in them."""

    renderer = "blank"
    identity = ""

    def __init__(self, scenario: Scenario) -> None:
        site = ScenarioSite.of(scenario)
        self._models = {
            actor.callsign: model_of(actor, scenario.files) for actor in scenario.actors
        }
        self._cameras = cameras_of(scenario, site)
        self._extinction_per_m = 3.912 / scenario.weather.visibility_m
        self._outlines = {
            (actor, name): Outline.of(mesh)
            for actor, model in self._models.items()
            for name, mesh in model.shapes.items()
        }
        self.own_aircraft: Mapping[str, Mask] = {}
        self.sightings: dict[tuple[str, int], tuple[Sighting, ...]] = {}
        """By camera and time."""

    def close(self) -> None:
        """Do nothing."""

    def take(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> list[CameraPicture]:
        return [self._picture(name, {body.actor: body for body in bodies}, t_ns) for name in names]

    def _picture(self, name: str, bodies: Mapping[str, BodyState], t_ns: int) -> CameraPicture:
        camera = self._cameras[name]
        view = camera.view(bodies)
        others = [body for body in bodies.values() if body.actor != camera.carrier]
        found = [self._sighting(body, view) for body in others]
        sightings = tuple(each for each in found if each is not None)
        self.sightings[name, t_ns] = sightings
        blank, sha256 = _blank(3 * view.intrinsics.height_px * view.intrinsics.width_px)
        return CameraPicture(name, view, sightings, sha256, blank)

    def _sighting(self, body: Any, view: Any) -> Any:
        projected = self._outlines[body.actor, body.shape].seen(body.pose, view)
        if projected is None:
            return None
        box, whole = projected.in_picture, projected.whole
        if box.area <= 0.0:
            return None
        range_m = math.dist(body.pose.position_m, view.pose.position_m)
        left = math.exp(-self._extinction_per_m * range_m)
        model, cut = self._models[body.actor], 1.0 - whole.within(view).area / whole.area
        return Sighting(body.actor, model.label, box, box.area, 1.0, cut, range_m, left)


class Oracle:
    """A vision worker that is told the truth, and errs a little."""

    def __init__(self, renderer: BlankSceneRenderer, seed: int, smallest_px: float) -> None:
        self.description = WorkerDescription(
            name="vision",
            modality="vision",
            inputs=(InputSpec(key="camera/*/frame", policy="latest"),),
            latency=DeclaredLatency(median_s=0.05),
        )
        self._renderer = renderer
        self._smallest_px = smallest_px
        self._generator = np.random.default_rng((seed, 71))
        self._hits: dict[tuple[str, str], int] = {}
        self.first_m: dict[tuple[str, str], float] = {}
        """Distance of the first detection, by camera and actor."""

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        outputs = []
        for item in inputs:
            frame = CameraFrame.model_validate(item.attachment)
            detections = self._look(frame)
            if detections is None:
                continue
            found = Detections(
                camera=frame.camera, seq=frame.seq, t_frame_ns=frame.t_frame_ns, view=frame.view,
                detections=detections, engine="oracle",
            )  # fmt: skip
            outputs.append(Output(f"vision/{frame.camera}", found.model_dump_json().encode()))
        return Step(tuple(outputs))

    def _look(self, frame: CameraFrame) -> tuple[Detection, ...] | None:
        """Return what is in a picture; None if it was missed."""
        seen = self._renderer.sightings[frame.camera, frame.t_frame_ns]
        return tuple(d for s in seen if (d := self._detect(frame.camera, s)))

    def _detect(self, camera: str, sighting: Sighting) -> Detection | None:
        box, key = sighting.box, (camera, sighting.actor)
        noise = self._generator.normal(0.0, ERROR_PX, 4)
        is_missed = self._generator.random() < MISSED
        side = max(box.right - box.left, box.bottom - box.top)
        if is_missed or side < self._smallest_px or sighting.transmission < LEAST_TRANSMISSION:
            return None
        self._hits[key] = self._hits.get(key, 0) + 1
        self.first_m.setdefault(key, sighting.range_m)
        left, top, right, bottom = (float(edge) for edge in np.add(box, noise))
        return Detection(
            label=sighting.label, confidence=0.8, hits=self._hits[key],
            box=(left, top, max(right, left + 1.0), max(bottom, top + 1.0)),
            track_id=1 + sorted(self._renderer._models).index(sighting.actor),
        )  # fmt: skip


class Follower(Oracle):
    """One that errs for moments, and follows what it finds with the tracker that ships.

    Some pictures are missed, in some it finds for once what is not there, and every few seconds
    something is before the lens for longer than a track lives.
    """

    def __init__(self, renderer: BlankSceneRenderer, seed: int, smallest_px: float) -> None:
        super().__init__(renderer, seed, smallest_px)
        self._errors = np.random.default_rng((seed, 72))
        self._trackers: dict[str, Tracker] = {}
        self.erred: Counter[str] = Counter()
        """Number of errors of each kind."""

    def _look(self, frame: CameraFrame) -> tuple[Detection, ...] | None:
        if self._errors.random() < PICTURES_MISSED:
            self.erred["missed"] += 1
            return None
        found = []
        if frame.t_frame_ns % HIDDEN_EVERY_NS < HIDDEN_NS:
            self.erred["hidden"] += 1
        else:
            found = [self._unsure(each) for each in super()._look(frame) or ()]
        if self._errors.random() < FALSE_BOXES:
            self.erred["false"] += 1
            found.append(self._false(frame.view))
        tracker = self._trackers.setdefault(frame.camera, Tracker(SURE))
        return tuple(tracker.follow(frame.t_frame_ns, frame.view, found))

    def _unsure(self, found: Detection) -> Found:
        """Return a finding, of which one in six is not sure."""
        return Found(found.label, float(self._errors.uniform(0.3, 0.9)), found.box)

    def _false(self, view: CameraView) -> Found:
        """Return something somewhere."""
        draws = self._errors
        side, label = float(draws.uniform(8.0, 40.0)), str(draws.choice(LABELS))
        left = float(draws.uniform(0.0, view.width_px - side))
        top = float(draws.uniform(0.0, view.height_px - side))
        return Found(label, float(draws.uniform(0.3, 0.6)), (left, top, left + side, top + side))


def watched(
    name: str,
    out: Path,
    patch: pytest.MonkeyPatch,
    seed: int = 0,
    smallest_px: float = SMALLEST_PX,
    scenario: Scenario | None = None,
    oracle: type[Oracle] = Oracle,
) -> tuple[Summary, Oracle]:
    """Run a scenario with its cameras, an oracle and the reference assistant."""
    made: list[Oracle] = []

    def open_scene_renderer(realised: Scenario, *_: object) -> BlankSceneRenderer:
        renderer = BlankSceneRenderer(realised)
        made[0]._renderer = renderer
        return renderer

    reference = reference_workers

    def workers(given: Options, scenario: Scenario, taken: Any, *_: Any) -> Any:
        made.append(oracle(cast(Any, None), seed, smallest_px))
        others = reference(given.model_copy(update={"detector": "none"}), scenario, taken)
        return [*others, made[0]]

    patch.setattr(vision, "_start_renderers", lambda *_: ())
    patch.setattr(vision, "_open_renderer", open_scene_renderer)
    patch.setattr(team, "reference_workers", workers)
    options = Options(seed=seed, out=out, latency="fixed")
    return cosim.run(scenario or nominal(name), options).summary, made[0]
