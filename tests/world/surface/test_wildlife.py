"""Animals move as their kind can, flee what frightens them, and do it again by the same seed."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place
from airhilt.units import wrap_angle
from airhilt.world.mover import SurfaceState
from airhilt.world.surface.animal import GREATEST_SPREAD_RAD, AnimalBody
from airhilt.world.surface.kinds import load_kind
from airhilt.world.surface.kinds.flock import flock_aloft
from breadth import examples

HERE: Place = (math.radians(38.8521), math.radians(-77.0377))
GROUND_M = 4.6
LOCAL_FRAME = LocalFrame(HERE, GROUND_M)
TICK_S = 0.05
Local = tuple[float, float]

seeds = st.integers(0, 2**31 - 1)
on_foot = st.sampled_from(["deer", "coyote", "goose", "flock"])
winged = st.sampled_from(["goose", "flock"])
spots = st.tuples(st.floats(-200.0, 200.0), st.floats(-200.0, 200.0))


def animal(kind: str, seed: int = 1, height_m: float = 0.0, heading_rad: float = 0.0) -> AnimalBody:
    made = load_kind(kind, "wildlife").create(
        HERE, heading_rad, ground_m=GROUND_M, tick_s=TICK_S, seed=seed, height_m=height_m
    )
    assert isinstance(made, AnimalBody)
    return made


def at(spot: Local) -> Place:
    return LOCAL_FRAME.to_place(*spot)


def where(state: SurfaceState) -> Local:
    return LOCAL_FRAME.to_local((state.latitude_rad, state.longitude_rad))


def watch(
    body: AnimalBody, until: Callable[[], bool], at_most_s: float = 2000.0
) -> list[SurfaceState]:
    states = [body.state]
    while not until():
        body.advance()
        states.append(body.state)
        assert len(states) * TICK_S < at_most_s
    return states


def until_it_stands(body: AnimalBody) -> list[SurfaceState]:
    return watch(body, lambda: body.phase == "standing")


def watch_for(body: AnimalBody, seconds: float) -> list[SurfaceState]:
    states = [body.state]
    for _ in range(round(seconds / TICK_S)):
        body.advance()
        states.append(body.state)
    return states


@examples(40)
@given(kind=on_foot, spot=spots, seed=seeds, run=st.booleans())
def test_it_walks_or_runs_to_a_place_within_its_limits(
    kind: str, spot: Local, seed: int, run: bool
) -> None:
    body = animal(kind, seed)
    (body.run_to if run else body.walk_to)(at(spot))
    states = until_it_stands(body)
    assert math.dist(where(body.state), spot) < 1.0
    limits = body.kind
    for before, after in itertools.pairwise(states):
        old, new = before.ground_speed_m_s, after.ground_speed_m_s
        assert abs(new - old) <= limits.acceleration_m_s2 * TICK_S + 1e-6
        assert new <= (limits.run_m_s if run else limits.walk_m_s) + 1e-9
        turn_rate = abs(wrap_angle(after.heading_rad - before.heading_rad)) / TICK_S
        assert turn_rate <= limits.turn_rate_rad_s + 1e-6
        assert turn_rate * new <= limits.lateral_m_s2 + 1e-6
        assert after.altitude_m == GROUND_M


@examples(20)
@given(kind=winged, spot=spots, height=st.floats(10.0, 120.0), seed=seeds)
def test_birds_fly_within_their_limits(kind: str, spot: Local, height: float, seed: int) -> None:
    body = animal(kind, seed)
    body.fly_to(at(spot), height)
    flight = body.kind.flight
    assert flight is not None
    for before, after in itertools.pairwise(watch_for(body, 90.0)):
        old, new = before.ground_speed_m_s, after.ground_speed_m_s
        assert abs(new - old) <= flight.acceleration_m_s2 * TICK_S + 1e-6
        assert new <= flight.speed_m_s + 1e-9
        assert -flight.descent_m_s <= after.vertical_rate_m_s <= flight.climb_m_s + 1e-9
        turn_rate = abs(wrap_angle(after.heading_rad - before.heading_rad)) / TICK_S
        assert turn_rate * new <= flight.lateral_m_s2 + 1e-6
        assert after.height_agl_m >= 0.0
        assert after.altitude_m == pytest.approx(GROUND_M + after.height_agl_m)
    assert body.state.height_agl_m == pytest.approx(height, abs=2.0)


def test_a_flock_takes_off_climbs_and_stays_about_the_place() -> None:
    body = animal("flock")
    on_the_ground = body.dimensions
    body.fly_to(at((400.0, 300.0)), 60.0)
    watch_for(body, 90.0)
    assert body.phase == "flying"
    assert not body.on_ground
    assert body.dimensions.height_m > on_the_ground.height_m
    for state in watch_for(body, 60.0):
        assert math.dist(where(state), (400.0, 300.0)) < 150.0
        assert state.height_agl_m == pytest.approx(60.0, abs=2.0)


@examples(20)
@given(kind=winged, spot=spots, seed=seeds)
def test_a_bird_that_flies_to_the_ground_lands_there(kind: str, spot: Local, seed: int) -> None:
    body = animal(kind, seed, height_m=40.0, heading_rad=1.0)
    body.fly_to(at(spot), 0.0)
    states = until_it_stands(body)
    assert body.on_ground
    assert math.dist(where(body.state), spot) < 1.0
    touchdown = next(state for state in states if state.height_agl_m == 0.0)
    last = states[states.index(touchdown) - 1]
    assert abs(last.vertical_rate_m_s) < 0.5
    assert body.kind.flight is not None
    assert last.ground_speed_m_s < 0.7 * body.kind.flight.speed_m_s


def test_a_bird_that_begins_in_the_air_flies_straight_on() -> None:
    body = animal("goose", height_m=100.0, heading_rad=0.5)
    assert body.phase == "flying"
    watch_for(body, 30.0)
    east, north = where(body.state)
    assert math.atan2(east, north) == pytest.approx(0.5, abs=1e-6)
    assert math.hypot(east, north) > 250.0
    assert body.state.height_agl_m == pytest.approx(100.0)


def test_a_bird_in_the_air_lands_before_it_stands_or_walks() -> None:
    body = animal("goose", height_m=30.0)
    body.stand()
    until_it_stands(body)
    assert body.on_ground
    body = animal("goose", height_m=30.0)
    body.walk_to(at((0.0, 300.0)))
    until_it_stands(body)
    assert math.dist(where(body.state), (0.0, 300.0)) < 1.0


def test_a_running_animal_told_to_stand_comes_to_a_stand() -> None:
    body = animal("deer")
    body.run_to(at((0.0, 200.0)))
    watch_for(body, 5.0)
    assert body.phase == "running"
    body.stand()
    states = until_it_stands(body)
    assert 1.0 < len(states) * TICK_S < 5.0
    assert where(body.state)[1] < 100.0


@examples(60)
@given(kind=on_foot, threat=spots, seed=seeds)
def test_a_startled_animal_goes_away_from_what_startles_it(
    kind: str, threat: Local, seed: int
) -> None:
    assume(math.hypot(*threat) > 1.0)
    body = animal(kind, seed)
    body.startle(at(threat))
    states = watch(body, lambda: not body.startled)
    east, north = where(body.state)
    away = math.atan2(-threat[0], -threat[1])
    wander = 3.0 * body.kind.wander_rad
    assert abs(wrap_angle(math.atan2(east, north) - away)) < GREATEST_SPREAD_RAD + wander
    assert math.dist((east, north), threat) > math.hypot(*threat) + 0.4 * body.kind.flees_for_m
    assert body.phase == "standing"
    assert any(state.height_agl_m > 5.0 for state in states) is (body.kind.flight is not None)


def test_animals_scatter_and_react_after_a_while_that_differs() -> None:
    ways, delays = set(), set()
    for seed in range(20):
        body = animal("deer", seed)
        body.startle(at((0.0, -50.0)))
        watched = watch(body, lambda body=body: body.phase == "fleeing")  # type: ignore[misc]
        delays.add(len(watched))
        watch(body, lambda body=body: not body.startled)  # type: ignore[misc]
        ways.add(round(math.atan2(*where(body.state)), 3))
    assert len(ways) == 20
    assert min(delays) * TICK_S > 0.3
    assert max(delays) * TICK_S < 3.0
    assert len(delays) > 5


def test_one_that_flees_already_takes_no_notice() -> None:
    first, second = animal("deer"), animal("deer")
    for body in (first, second):
        body.startle(at((0.0, -50.0)))
    for _ in range(200):
        second.startle(at((0.0, 50.0)))
        first.advance()
        second.advance()
    assert first.state == second.state


def test_a_flying_flock_that_is_startled_turns_away_and_flies_on() -> None:
    body = animal("flock", height_m=80.0)
    body.fly_to(at((0.0, 2000.0)), 80.0)
    watch_for(body, 10.0)
    body.startle(at((0.0, 600.0)))
    watch(body, lambda: not body.startled)
    assert body.phase == "flying"
    assert math.dist(where(body.state), (0.0, 600.0)) > 600.0


def test_the_same_seed_gives_the_same_way_bit_by_bit_and_another_seed_another() -> None:
    def way(seed: int) -> list[SurfaceState]:
        body = animal("flock", seed)
        body.walk_to(at((5.0, 5.0)))
        states = watch_for(body, 5.0)
        body.startle(at((10.0, 10.0)))
        states += watch_for(body, 20.0)
        body.fly_to(at((-100.0, 40.0)), 30.0)
        return states + watch_for(body, 20.0)

    assert way(7) == way(7)
    assert way(7) != way(8)


def test_on_its_way_it_wanders_in_direction_and_speed_by_its_seed() -> None:
    ways = []
    for seed in (1, 2):
        body = animal("deer", seed)
        body.walk_to(at((0.0, 200.0)))
        midway = watch_for(body, 60.0)[200:]
        ways.append(midway)
        assert max(abs(wrap_angle(state.heading_rad)) for state in midway) > 0.1
        speeds = [state.ground_speed_m_s for state in midway]
        assert min(speeds) < 0.95 * max(speeds)
    assert ways[0] != ways[1]


def test_what_has_ended_moves_no_more() -> None:
    body = animal("deer")
    body.run_to(at((0.0, 100.0)))
    body.advance()
    body.ended = "collision"
    before = body.state
    body.advance()
    assert body.state is before


def test_only_what_has_wings_flies() -> None:
    with pytest.raises(ValueError, match="a deer does not fly"):
        animal("deer").fly_to(at((0.0, 100.0)), 10.0)
    with pytest.raises(ValueError, match="a coyote does not fly"):
        animal("coyote", height_m=10.0)


def test_a_flock_grows_with_its_birds() -> None:
    bird = animal("goose").kind.dimensions
    one, few, many = (flock_aloft(bird, count, spacing_m=2.0) for count in (1, 50, 5000))
    assert one.length_m >= bird.length_m
    assert few.length_m < many.length_m
    assert few.span_m < many.span_m
    assert many.height_m < many.length_m < many.span_m
