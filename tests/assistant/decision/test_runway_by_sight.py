"""What cameras show on a runway, or in the air before it, is in the way like anything else."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import pytest

from airfield import (
    BRIEFING,
    FIELD,
    NORTH,
    SOUTH,
    Airfield,
    Mover,
    lands,
    stands,
)
from airhilt.messages import Severity, VisibleClass
from airhilt.units import DEGREE
from breadth import mostly_slow
from field_cameras import at, beside_threshold, camera, on_tower, silent
from projected import AIRLINER, DEER, FLOCK, TRUCK, Body, Camera, standing, still

SEEDS = mostly_slow(range(3), 0)
LANDS_S = 70.0


def arrival(**how: Any) -> Mover:
    return Mover("AAL123", NORTH, lands(LANDS_S), **how)


def look_at(
    *movers: Mover,
    cameras: Sequence[Camera],
    seconds: float = LANDS_S - 5.0,
) -> Airfield:
    return Airfield(list(movers), cameras=list(cameras)).run(seconds)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("look", [beside_threshold, on_tower])
def test_a_silent_truck_on_the_runway_sends_the_arrival_around(
    look: Callable[..., Any], seed: int
) -> None:
    truck = silent(stands(800))
    field = look_at(
        arrival(seed=seed), truck, cameras=[look(truck.body("truck", TRUCK), seed=seed)]
    )
    caution_s, _ = field.first("CAUTION")
    warning_s, warning = field.first("WARNING")
    assert LANDS_S - caution_s == pytest.approx(60.0, abs=5.0)
    assert LANDS_S - warning_s == pytest.approx(35.0, abs=3.0)
    assert set(field.advice("AAL123")) == {("go_around", "01")}
    assert warning.recipients == ("AAL123", "ATC")
    assert warning.evidence.sources == ("vision", "adsb")
    assert "unidentified truck on runway 01" in warning.message
    assert len({advisory.id for _, advisory in field.told}) == 1


@pytest.mark.parametrize("across_m", [-90.0, 110.0])
@pytest.mark.parametrize("look", [beside_threshold, on_tower])
def test_one_beside_the_runway_does_not(look: Callable[..., Any], across_m: float) -> None:
    truck = silent(stands(500, across_m))
    field = look_at(arrival(), truck, cameras=[look(truck.body("truck", TRUCK))])
    assert field.worst.rank <= Severity.ADVISORY.rank
    assert {advisory.recipient for _, advisory in field.told} <= {"ATC"}


@pytest.mark.parametrize("seed", SEEDS)
def test_what_squitters_is_no_second_obstacle_however_it_is_seen(seed: int) -> None:
    """An arrival lands and turns off, a vehicle holds short: both are seen, and known."""
    aircraft = Mover("DAL456", NORTH, lands(12.0), seed=seed)
    vehicle = Mover("OPS1", NORTH, stands(800, -90), 90.0, "C2", seed)
    bodies = [aircraft.body("airplane", AIRLINER), vehicle.body("truck", TRUCK)]
    cameras = [beside_threshold(*bodies), on_tower(*bodies)]
    movers = (Mover("AAL123", NORTH, lands(88.0), seed=seed), aircraft, vehicle)
    assert look_at(*movers, cameras=cameras, seconds=85.0).told == []


def test_a_flicker_is_not_there() -> None:
    truck = silent(stands(800))
    flicker = on_tower(truck.body("truck", TRUCK), confidence=0.4, recall=0.1)
    assert look_at(arrival(), truck, cameras=[flicker]).worst.rank <= Severity.ADVISORY.rank


@pytest.mark.parametrize("label", ["deer", "moose"])
def test_an_animal_of_the_briefing_is_announced_by_a_camera_that_is_near_enough(
    label: VisibleClass,
) -> None:
    animal = still(label, at(760.0, 0.0), DEER)
    look = {"width_px": 1280, "height_px": 720, "smallest_px": 8.0}
    near = camera("side", (600.0, 110.0, 8.0), -35.0, [animal], **look)
    far = camera("far", (0.0, 110.0, 8.0), -8.0, [animal], **look)
    briefing = BRIEFING.model_copy(update={"animals": (*BRIEFING.animals, "moose")})
    field = Airfield([arrival()], cameras=[near], briefing=briefing).run(LANDS_S - 5.0)
    _, warning = field.first("WARNING")
    assert f", {label} on runway 01" in warning.message
    assert warning.traffic == ("AAL123", "wildlife")
    assert set(field.advice("AAL123")) == {("go_around", "01")}
    assert look_at(arrival(), cameras=[far]).told == []


def test_the_nose_camera_of_the_arrival_itself_sees_what_is_on_its_runway() -> None:
    own, truck = arrival(), silent(stands(800))

    def look(t_s: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        place, heading = own.body("airplane", AIRLINER).at(t_s)
        return place, (heading, 0.0, 2.0 * DEGREE)

    nose = Camera(
        "nose", FIELD, look, [truck.body("truck", TRUCK)], "AAL123", 25.0, 1280, 720, 4.0,
        smallest_px=6.0,
    )  # fmt: skip
    field = look_at(own, truck, cameras=[nose])
    warning_s, _ = field.first("WARNING")
    assert 15.0 < LANDS_S - warning_s < 36.0
    assert set(field.advice("AAL123")) == {("go_around", "01")}


def test_a_camera_that_gives_no_more_pictures_clears_nothing_at_once_but_in_time() -> None:
    truck = silent(stands(800))
    off = on_tower(truck.body("truck", TRUCK), off_after_s=40.0)
    field = look_at(arrival(), truck, cameras=[off])
    over_s = next(t_s for t_s, advisory in field.told if not advisory.active)
    assert 48.0 < over_s < 58.0


def test_an_aircraft_on_the_ground_has_nothing_to_avoid_in_the_air() -> None:
    """It stands lined up, and somebody without transponder comes towards it."""
    other = Mover("N172SP", SOUTH, lands(LANDS_S), equipped=False)
    own = Mover("DAL456", NORTH, stands(40.0), 0.0)
    look = standing(at(40.0, 0.0, 4.0), NORTH.course_deg, 2.0)
    nose = Camera("nose", FIELD, look, [other.body("airplane", AIRLINER)], "DAL456", 25.0)
    assert look_at(own, other, cameras=[nose], seconds=LANDS_S).told == []


# --- birds in the air -----------------------------------------------------------------------


def flock(across: Callable[..., Any], height: Callable[..., Any]) -> Body:
    """Return a flock 900 m before the threshold, as functions of time."""
    return Body(
        "bird",
        *FLOCK,
        lambda t_s: (at(-900.0, across(t_s), height(t_s)), NORTH.course_deg * DEGREE),
    )


def approach_cameras(bird: Body) -> list[Camera]:
    """Return two cameras beside the threshold that look at the final approach."""
    how = {"rate_hz": 4.0, "fov_deg": 40.0}
    return [
        camera("west", (-30.0, -110.0, 4.0), 180.0, [bird], 5.0, **how),
        camera("east", (-30.0, 110.0, 4.0), 180.0, [bird], 5.0, **how),
    ]


def rises(t_s: float, at_s: float = 45.0) -> float:
    return min(max(t_s - at_s, 0.0) * 3.0, 70.0)


def test_a_flock_that_rises_into_the_final_approach_sends_the_arrival_around() -> None:
    bird = flock(lambda t_s: -280.0 + 15.0 * max(t_s - 45.0, 0.0), rises)
    field = look_at(arrival(), cameras=approach_cameras(bird))
    warning_s, warning = field.first("WARNING")
    assert 45.0 < warning_s < 51.0
    assert "birds on final for runway 01" in warning.message
    assert warning.traffic == ("AAL123", "wildlife")
    assert set(field.advice("AAL123")) == {("go_around", "01")}


def test_heights_of_cameras_are_above_the_airport_and_not_above_the_end_of_a_runway() -> None:
    """By the runway's elevation the arrival would be 127 m higher than it is."""
    airport = BRIEFING.airport
    lower = [each.model_copy(update={"elevation_ft": -400.0}) for each in airport.runways]
    field = Airfield([arrival()], cameras=approach_cameras(flock(lambda _: 0.0, lambda _: 230.0)))
    field.briefing = BRIEFING.model_copy(
        update={"airport": airport.model_copy(update={"runways": tuple(lower)})}
    )
    assert field.run(LANDS_S - 5.0).told == []


# --- hints that are not enough alone --------------------------------------------------------


def test_a_faint_sighting_is_for_the_controller_alone_until_somebody_reports_the_same() -> None:
    deer = still("deer", at(760.0, 0.0), DEER)
    look = {"width_px": 1280, "height_px": 720, "confidence": 0.4}
    faint = camera("side", (600.0, 110.0, 8.0), -35.0, [deer], **look)
    field = look_at(arrival(), cameras=[faint])
    assert field.worst is Severity.ADVISORY
    assert {advisory.recipient for _, advisory in field.told} == {"ATC"}
    assert "deer on runway 01" in field.told[0][1].message
