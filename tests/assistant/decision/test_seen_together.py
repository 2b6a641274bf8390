"""Things on the ground and over it, as one or two cameras show them together."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from airfield import FIELD, degrees
from airhilt.assistant.decision.occupancy import (
    SeenAloft,
    SeenOnGround,
    seen_aloft,
    seen_on_ground,
)
from airhilt.assistant.decision.visual_tracks import VisualTracks
from airhilt.messages import Detections
from airhilt.units import SECOND_NS
from instants import AERODROME
from projected import DEER, FLOCK, TRUCK, Body, Camera, Place, standing, still

ANIMALS = ("deer", "bird")
THERE = (20.0, 200.0, 0.0)


def local(place: Sequence[float]) -> tuple[float, ...]:
    """Return a place in the frame of the aerodrome, with its height if it has one."""
    return (*AERODROME.locate(*degrees((place[0], place[1]))), *place[2:])


def camera(
    *bodies: Body, name: str = "west", east_m: float = -120.0, towards: Place = THERE,
    confidence: float = 0.9, **how: Any,
) -> Camera:  # fmt: skip
    """Return a camera 30 m above the ground that looks at a place."""
    azimuth = math.degrees(math.atan2(towards[0] - east_m, towards[1]))
    level_m = math.hypot(towards[0] - east_m, towards[1])
    pitch = math.degrees(math.atan2(towards[2] - 30.0, level_m))
    return Camera(
        name, FIELD, standing((east_m, 0.0, 30.0), azimuth, pitch), list(bodies), error_px=0.0,
        width_px=1280, height_px=720, confidence=confidence, **how,
    )  # fmt: skip


def east_of(*bodies: Body, **how: Any) -> Camera:
    return camera(*bodies, name="east", east_m=160.0, **how)


def watched(*cameras: Camera, seconds: float = 1.0, change: Any = None) -> VisualTracks:
    """Return the visual tracks after eight pictures a second of each camera."""
    tracks = VisualTracks()
    for step in range(round(8 * seconds) + 1):
        for each in cameras:
            found: Detections = each.detections(step * SECOND_NS // 8)
            tracks.take_detections(change(found) if change else found, step * SECOND_NS // 8)
    return tracks


def on_ground(tracks: VisualTracks, *aloft: SeenAloft) -> list[SeenOnGround]:
    return list(seen_on_ground(tracks, AERODROME, aloft, ANIMALS))


def moves(body: Body, place: Place, velocity: tuple[float, float, float]) -> Body:
    """Return a body that is at a place after a second and flies or drives straight on."""

    def at(t_s: float) -> tuple[Place, float]:
        east, north, up = (p + (t_s - 1.0) * v for p, v in zip(place, velocity, strict=True))
        return (east, north, up), 0.0

    return replace(body, at=at)


# --- on the ground ----------------------------------------------------------------------------


def test_what_two_cameras_show_at_one_place_is_one_thing_that_is_surer() -> None:
    truck = still("truck", THERE, TRUCK)
    (alone,) = on_ground(watched(camera(truck, confidence=0.6), seconds=0.75))
    assert (alone.label, alone.is_animal, len(alone.tracks)) == ("truck", False, 1)
    assert not alone.is_established
    (both,) = on_ground(
        watched(camera(truck, confidence=0.6), east_of(truck, confidence=0.7), seconds=0.75)
    )
    assert both.belief == pytest.approx(1.0 - 0.4 * 0.3)
    assert both.is_established
    assert [track.camera for track in both.tracks] == ["east", "west"]  # The surer one first.
    assert both.fix.point == pytest.approx(local(THERE[:2]), abs=4.0)
    assert both.fix.north_m2 < alone.fix.north_m2


def test_two_things_of_one_camera_and_things_apart_are_different() -> None:
    near = [still("truck", (20.0 + 6.0 * n, 200.0, 0.0), TRUCK) for n in (0, 1)]
    assert len(on_ground(watched(camera(*near)))) == 2
    apart = [still("truck", (20.0 + 60.0 * n, 200.0, 0.0), TRUCK) for n in (0, 1)]
    assert len(on_ground(watched(camera(apart[0]), east_of(apart[1])))) == 2


def test_an_animal_and_a_vehicle_at_one_place_are_two_things() -> None:
    deer, truck = still("deer", THERE, DEER), still("truck", THERE, TRUCK)
    found = on_ground(watched(camera(truck), east_of(deer)))
    assert {(each.label, each.is_animal) for each in found} == {("truck", False), ("deer", True)}
    plane = still("airplane", THERE, TRUCK)
    assert len(on_ground(watched(camera(truck), east_of(plane)))) == 1


def test_the_surest_thing_comes_first() -> None:
    sure, unsure = (
        still("truck", (20.0, 200.0, 0.0), TRUCK),
        still("deer", (80.0, 200.0, 0.0), DEER),
    )
    for pair in ((sure, unsure), (unsure, sure)):
        cameras = [
            camera(each, name=each.label, confidence=0.9 if each is sure else 0.5) for each in pair
        ]
        found = on_ground(watched(*cameras))
        assert [each.label for each in found] == ["truck", "deer"]


def test_what_flies_is_not_on_the_ground() -> None:
    tracks = watched(camera(still("truck", THERE, TRUCK)))
    (track,) = tracks
    aloft = SeenAloft(True, (), (0.0, 0.0, 0.0), True, 0, (track,))
    assert on_ground(tracks) != []
    assert on_ground(tracks, aloft) == []


# --- in the air -------------------------------------------------------------------------------

FLYING = (20.0, 200.0, 40.0)


def above(*cameras: Camera, **how: Any) -> list[SeenAloft]:
    return list(seen_aloft(watched(*cameras, **how), AERODROME))


def flock(place: Place = FLYING, label: Any = "bird", velocity: Any = (0.0, 0.0, 0.0)) -> Body:
    return moves(still(label, place, FLOCK), place, velocity)


@pytest.mark.parametrize("velocity", [(0.0, 0.0, 0.0), (10.0, -5.0, 2.0), (-8.0, 0.0, -3.0)])
def test_two_cameras_tell_where_birds_are_and_where_they_fly_to(
    velocity: tuple[float, float, float],
) -> None:
    birds = flock(velocity=velocity)
    (found,) = above(camera(birds, towards=FLYING), east_of(birds, towards=FLYING), seconds=2.0)
    assert (found.are_birds, found.is_located) == (True, True)
    assert found.t_ns == 2 * SECOND_NS
    (place,) = found.places
    expected = [p + v for p, v in zip(FLYING, velocity, strict=True)]
    assert (*place.point, place.height_m) == pytest.approx(local(expected), abs=3.0)
    assert found.velocity == pytest.approx(velocity, abs=0.5)
    assert {track.camera for track in found.tracks} == {"west", "east"}


@pytest.mark.parametrize(("seconds", "is_measured"), [(0.875, False), (1.0, True)])
def test_a_velocity_takes_a_second(seconds: float, is_measured: bool) -> None:
    birds = flock(velocity=(10.0, 0.0, 0.0))
    (found,) = above(camera(birds, towards=FLYING), east_of(birds, towards=FLYING), seconds=seconds)
    assert (found.velocity != (0.0, 0.0, 0.0)) is is_measured


@pytest.mark.parametrize(
    ("labels", "are_birds"),
    [(("bird", "airplane"), True), (("airplane", "bird"), True), (("airplane", "airplane"), False)],
)
def test_what_any_camera_takes_for_birds_is_birds(labels: tuple[Any, Any], are_birds: bool) -> None:
    first, second = (flock(label=label) for label in labels)
    (found,) = above(camera(first, towards=FLYING), east_of(second, towards=FLYING))
    assert found.are_birds is are_birds
    truck = flock(label="truck")
    assert above(camera(first, towards=FLYING), east_of(truck, towards=FLYING)) == [] or (
        labels[0] == "bird"
    )


@pytest.mark.parametrize(("above_m", "is_aloft"), [(-0.1, False), (0.1, True)])
def test_what_is_low_may_stand_on_the_ground(above_m: float, is_aloft: bool) -> None:
    """In the air is what is higher than 4 m and two standard deviations of its height."""
    (high,) = above(camera(flock(), towards=FLYING), east_of(flock(), towards=FLYING))
    least_m = 4.0 + 2.0 * high.places[0].height_error_m
    # What is told is the middle of the flock.
    place = (20.0, 200.0, least_m - FLOCK[2] / 2.0 + above_m)
    birds = flock(place)
    found = above(camera(birds, towards=place), east_of(birds, towards=place))
    assert bool(found) is is_aloft


def test_of_birds_that_one_camera_shows_above_its_horizon_each_distance_is_possible() -> None:
    """From one small bird of 0.4 m to a flock of 20 m."""
    birds = flock((20.0, 200.0, 60.0))
    (found,) = above(camera(birds, towards=(20.0, 200.0, 60.0)), seconds=1.5)
    assert (found.are_birds, found.is_located, found.velocity) == (True, False, (0.0, 0.0, 0.0))
    ranges = [
        math.dist((*each.point, each.height_m), local((-120.0, 0.0, 30.0))) for each in found.places
    ]
    assert len(ranges) == 13
    (track,) = found.tracks
    size_rad = max(track.last.size_rad)
    assert ranges[0] == pytest.approx(0.4 / size_rad)
    assert ranges[-1] == pytest.approx(20.0 / size_rad)
    steps = [after / before for before, after in itertools.pairwise(ranges)]
    assert steps == pytest.approx([50.0 ** (1.0 / 12.0)] * 12)


@pytest.mark.parametrize(
    ("label", "up_m", "is_told"),
    [("bird", 60.0, True), ("bird", 10.0, False), ("airplane", 60.0, False)],
)
def test_one_camera_alone_tells_of_birds_above_its_horizon_only(
    label: str, up_m: float, is_told: bool
) -> None:
    place = (20.0, 200.0, up_m)
    assert bool(above(camera(flock(place, label), towards=place), seconds=1.5)) is is_told


@pytest.mark.parametrize(("apart_s", "is_located"), [(0.3, False), (0.2, True)])
def test_two_cameras_locate_what_they_see_within_a_quarter_of_a_second(
    apart_s: float, is_located: bool
) -> None:
    tracks = VisualTracks()
    west, east = (look(flock(), towards=FLYING) for look in (camera, east_of))
    for step in range(5):
        tracks.take_detections(west.detections(step * SECOND_NS), step * SECOND_NS)
        later_ns = step * SECOND_NS + round(apart_s * SECOND_NS)
        tracks.take_detections(east.detections(later_ns), later_ns)
    assert any(each.is_located for each in seen_aloft(tracks, AERODROME)) is is_located
