"""When the cameras of a run expose, and what they give out."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt import load
from airhilt.errors import RendererError
from airhilt.imaging.masks import Mask
from airhilt.imaging.view import Intrinsics, Pose, View, attitude
from airhilt.messages import CameraFrame, CameraInfo, CameraTruth, Message
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.frame import CameraPicture, Prospect, Sighting
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.scene.projected_box import Box
from airhilt.sensors.cameras.sensor import CameraSensor, Exposures, angles_of
from airhilt.sim import Director, Priority, Virtual
from airhilt.units import SECOND_NS
from airhilt.world.actors import build_actors
from airhilt.world.actors.actor import Actor
from airhilt.world.site import ScenarioSite

LENS = Intrinsics(64, 36, 0.8)


@dataclass
class Fake:
    """Takes grey pictures, and fails from a time on."""

    fails_at_ns: int | None = None
    shots: list[tuple[int, tuple[str, ...]]] = field(default_factory=list)
    places: list[dict[str, tuple[float, float]]] = field(default_factory=list)
    own_aircraft: dict[str, Mask] = field(default_factory=dict)
    body_from_ns: dict[str, int] = field(default_factory=dict)
    """Time from which a camera has a body before it."""

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> dict[str, Prospect]:
        view = View(LENS, Pose.of((10.0, 20.0, 30.0), 1.0, 0.1, -0.2))
        return {
            name: Prospect(view, t_ns >= self.body_from_ns.get(name, t_ns + 1)) for name in names
        }

    def take(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> list[CameraPicture]:
        if self.fails_at_ns is not None and t_ns >= self.fails_at_ns:
            raise RendererError("the driver has died")
        self.shots.append((t_ns, tuple(names)))
        self.places.append({body.actor: (body.east_m, body.north_m) for body in bodies})
        view = View(LENS, Pose.of((10.0, 20.0, 30.0), 1.0, 0.1, -0.2))
        pixels = bytes([len(self.shots) % 256]) * (36 * 64 * 3)
        sha256 = hashlib.sha256(pixels).hexdigest()
        seen = Sighting(bodies[0].actor, "airplane", Box(1, 2, 3, 4), 4.0, 1.0, 0.0, 900.0, 0.5)
        return [CameraPicture(name, view, (seen,), sha256, pixels) for name in names]


class Run:
    """A camera sensor on its own, with all that it publishes."""

    def __init__(
        self, scenario: Scenario, frame_source: Fake, until_s: float, is_adaptive: bool = False
    ) -> None:
        site = ScenarioSite.of(scenario)
        self.cast: dict[str, Actor] = build_actors(scenario, site, 0, 0.05)
        self.published: list[tuple[str, Message, bytes | None]] = []
        self.losses: list[tuple[int, str]] = []
        self.director = Director(Virtual())
        self.sensor = CameraSensor(
            self.director,
            frame_source,
            scenario.cameras,
            site,
            self.cast,
            is_adaptive=is_adaptive,
            state_at_ns=lambda: 0,
            publish=lambda key, message, *, raw=None: self.published.append((key, message, raw)),
            lost=lambda cause, _: self.losses.append((self.director.now_ns, cause)),
        )
        end_ns = round(until_s * SECOND_NS)
        self.director.at(end_ns, self.director.stop, Priority.OBSERVE)

    def go(self) -> Run:
        self.sensor.start()
        self.director.run()
        return self

    def frames(self, camera: str) -> list[CameraFrame]:
        return [
            message
            for key, message, _ in self.published
            if key == f"camera/{camera}/frame" and isinstance(message, CameraFrame)
        ]


def scenario_with(**changes: Any) -> Scenario:
    """Return the head-on encounter with its first camera changed."""
    document = json.loads(load("s02a_headon").model_dump_json())
    document["cameras"][0] |= changes
    return Scenario.model_validate(document)


@given(rate_hz=st.floats(1.0, 30.0), seq=st.integers(0, 1_000_000))
def test_exposures_keep_their_rate_without_drift(rate_hz: float, seq: int) -> None:
    exposures = Exposures(rate_hz, 250)
    assert exposures.end_ns(seq) == pytest.approx(250 + seq / rate_hz * 1e9, abs=1.0)
    assert exposures.end_ns(seq + 1) > exposures.end_ns(seq)


def test_cameras_that_are_due_together_share_one_pass() -> None:
    fake = Fake()
    Run(scenario_with(), fake, 1.0).go()
    assert len(fake.shots) == 17
    assert all(names == ("nose-AAL123", "nose-DAL456") for _, names in fake.shots)


def test_each_camera_has_a_rate_and_a_phase_of_its_own() -> None:
    run = Run(scenario_with(rate_hz=5.0, phase_s=0.1), Fake(), 1.0).go()
    ends = [frame.t_frame_ns / SECOND_NS for frame in run.frames("nose-AAL123")]
    assert ends == pytest.approx([0.1, 0.3, 0.5, 0.7, 0.9])
    assert len(run.frames("nose-DAL456")) == 17


def test_with_adaptive_exposure_a_camera_exposes_once_a_second_until_there_is_a_body() -> None:
    fake = Fake(body_from_ns={"nose-DAL456": 2 * SECOND_NS + SECOND_NS // 2})
    run = Run(scenario_with(), fake, 3.0, is_adaptive=True).go()
    taken = {
        name: [frame.seq for frame in run.frames(name) if frame.encoding == "rgb8"]
        for name in ("nose-AAL123", "nose-DAL456")
    }
    assert taken["nose-AAL123"] == [0, 16, 32, 48]
    assert taken["nose-DAL456"] == [0, 16, 32, *range(40, 49)]


def test_an_exposure_that_is_left_out_has_its_number_its_time_and_no_pixels() -> None:
    full = Run(scenario_with(), Fake(), 1.5).go()
    adaptive = Run(scenario_with(), Fake(), 1.5, is_adaptive=True).go()
    names = "t_ns", "camera", "seq", "t_frame_ns", "view"
    grids = [
        [tuple(getattr(message, name) for name in names)
         for _, message, _ in run.published if isinstance(message, CameraFrame)]
        for run in (full, adaptive)
    ]  # fmt: skip
    assert grids[0] == grids[1]
    raw = {len(raw or b"") for _, message, raw in adaptive.published
           if isinstance(message, CameraFrame) and message.encoding == "none"}  # fmt: skip
    assert raw == {0}
    told = [m.seq for _, m, _ in adaptive.published if isinstance(m, CameraTruth)]
    assert told == [0, 0, 16, 16]


def test_what_is_in_a_picture_is_told_as_truth() -> None:
    run = Run(scenario_with(), Fake(), 0.1).go()
    truth = [m for key, m, _ in run.published if key == "truth/camera/nose-AAL123"]
    assert isinstance(truth[0], CameraTruth)
    assert truth[0].sightings[0].range_m == 900.0
    assert all(
        key.startswith("truth/") or not isinstance(message, CameraTruth)
        for key, message, _ in run.published
    )


def test_what_never_changes_is_told_once_before_the_first_picture() -> None:
    mask = np.zeros((360, 640), dtype=bool)
    mask[10, 5:9] = True
    run = Run(scenario_with(), Fake(own_aircraft={"nose-AAL123": mask}), 0.5).go()
    infos = [message for _, message, _ in run.published if isinstance(message, CameraInfo)]
    assert [info.camera for info in infos] == ["nose-AAL123", "nose-DAL456"]
    assert infos[0].own_aircraft == (10 * 640 + 5, 4, 350 * 640 - 9)
    assert infos[0].carrier == "AAL123"
    assert isinstance(run.published[0][1], CameraInfo)


def test_the_camera_of_an_aircraft_that_has_ended_gives_no_more_pictures() -> None:
    run = Run(scenario_with(), Fake(), 1.0)
    run.director.at(SECOND_NS // 2, lambda: end(run.cast["AAL123"]), Priority.PHYSICS)
    run.go()
    assert len(run.frames("nose-AAL123")) == 8
    assert len(run.frames("nose-DAL456")) == 17


def end(actor: Actor) -> None:
    actor.body.ended = "collision"


def test_a_renderer_that_dies_is_told_once_and_asked_no_more() -> None:
    fake = Fake(fails_at_ns=SECOND_NS // 2)
    run = Run(scenario_with(), fake, 2.0).go()
    assert run.losses == [(SECOND_NS // 2, "the driver has died")]
    assert len(fake.shots) == 8


def test_a_picture_taken_between_two_ticks_shows_bodies_further_on() -> None:
    fake = Fake()
    run = Run(scenario_with(), fake, 1.0).go()
    state = run.cast["AAL123"].body.state
    moved = np.hypot(*(np.subtract(fake.places[-1]["AAL123"], fake.places[0]["AAL123"])))
    assert moved == pytest.approx(state.ground_speed_m_s, rel=1e-2)


def test_what_has_ended_lies_where_it_did_while_others_move_on() -> None:
    fake = Fake()
    run = Run(scenario_with(), fake, 1.0)
    run.director.at(SECOND_NS // 2, lambda: end(run.cast["AAL123"]), Priority.PHYSICS)
    run.go()
    before, last = fake.places[-2:]
    assert last["AAL123"] == before["AAL123"]
    assert last["DAL456"] != before["DAL456"]


@given(
    heading=st.floats(0.0, 6.28),
    pitch=st.floats(-1.5, 1.5),
    roll=st.floats(-3.1, 3.1),
)
def test_angles_of_a_view_are_those_of_its_attitude(
    heading: float, pitch: float, roll: float
) -> None:
    rotation = attitude(heading, pitch, roll)
    assert attitude(*angles_of(rotation)) == pytest.approx(rotation, abs=1e-6)
