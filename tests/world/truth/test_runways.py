"""Who is on a runway, who comes, and who is in whose way: at KDCA, runway 01 and its crossings."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache
from typing import Any, cast

import pytest

from airhilt.messages import RunwayTruth
from airhilt.shapes.sizes import Dimensions
from airhilt.units import FOOT, KNOT, SECOND_NS
from airhilt.world.flight import load_aircraft_type
from airhilt.world.mover import SurfaceState
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.layout import Layout
from airhilt.world.truth.runways import RunwayMonitor

B737 = load_aircraft_type("737")
CAR = Dimensions(length_m=5.0, span_m=2.0, height_m=2.0)


@cache
def kdca() -> Layout:
    return Layout(load_airport("KDCA"))


@dataclass
class Body:
    """Something beside a runway, ``along_m`` past its threshold, moving along it."""

    along_m: float
    right_m: float = 0.0
    height_m: float = 0.0
    speed_kt: float = 0.0
    runway: str = "01"
    phase: str = "standing"
    on_ground: bool = True
    dimensions: object = CAR
    ended: str | None = None
    turned_deg: float = 0.0

    @property
    def state(self) -> SurfaceState:
        end = kdca().runway(self.runway)
        east, north = kdca().local_frame.to_local(end.threshold)
        sin, cos = math.sin(end.course_rad), math.cos(end.course_rad)
        east += self.along_m * sin + self.right_m * cos
        north += self.along_m * cos - self.right_m * sin
        speed = self.speed_kt * KNOT
        return SurfaceState(
            *kdca().local_frame.to_place(east, north),
            altitude_m=self.height_m,
            height_agl_m=self.height_m,
            velocity_north_m_s=speed * cos,
            velocity_east_m_s=speed * sin,
            velocity_down_m_s=0.0,
            heading_rad=(end.course_rad + math.radians(self.turned_deg)) % (2 * math.pi),
        )


@dataclass
class Performing:
    body: Any
    bound_runway: str | None = None
    category: str = "aircraft"


def airliner(along_m: float, phase: str, *, runway: str = "01", **kw: Any) -> Performing:
    body: Any = Body(along_m, runway=runway, phase=phase, dimensions=B737.dimensions, **kw)
    body.kind = B737
    return Performing(body, runway)


def arrival(time_s: float, runway: str = "01") -> Performing:
    """An airliner so far from its threshold, on the glide path."""
    away = time_s * 140 * KNOT
    height = (away + 180.0) * math.tan(math.radians(3.0))
    return airliner(-away, "glide", runway=runway, speed_kt=140.0, height_m=height, on_ground=False)


def vehicle(along_m: float, right_m: float = 0.0, runway: str = "01") -> Performing:
    return Performing(Body(along_m, right_m, runway=runway), category="vehicle")


@dataclass
class Watch:
    """A monitor over some actors, and what it has told."""

    actors: dict[str, Any]
    affected: set[str] = field(default_factory=set)
    uncleared: set[str] = field(default_factory=set)
    now_ns: int = 0

    def __post_init__(self) -> None:
        self.occupied: list[tuple[str, tuple[str, ...]]] = []
        self.incurred: list[tuple[str | None, str]] = []
        self.monitor = RunwayMonitor(
            kdca(),
            self.actors,
            self.affected,
            self.uncleared,
            lambda key, truth: self.occupied.append((key, truth.occupants)),
            lambda incursion: self.incurred.append((incursion.user, incursion.intruder)),
        )

    def look(self) -> Watch:
        self.now_ns += SECOND_NS // 5
        self.monitor.tick(self.now_ns)
        return self

    @property
    def categories(self) -> list[str]:
        return [incursion.category for incursion in self.monitor.incursions.values()]


# --- occupancy ------------------------------------------------------------------------------


@pytest.mark.parametrize(("nose_past_line_m", "inside"), [(-1.0, False), (1.0, True)])
def test_a_nose_beyond_the_hold_line_occupies_the_runway(
    nose_past_line_m: float, inside: bool
) -> None:
    half = kdca().strip_of("01").hold_distance_m
    away = half + B737.dimensions.length_m / 2.0 - nose_past_line_m
    waiting = Performing(
        Body(900.0, right_m=-away, turned_deg=90.0, dimensions=B737.dimensions, phase="standing")
    )
    watch = Watch({"A": waiting}).look()
    assert watch.monitor.is_on("A", "01") is inside
    assert watch.monitor.is_on("A", "19") is inside


def test_who_is_in_the_air_occupies_nothing_but_low_birds_do() -> None:
    """Up to 15 m: an airliner on the runway is about as high."""
    plane = airliner(500.0, "climb_out", height_m=5.0, on_ground=False)
    bird = Performing(Body(500.0, height_m=14.9, on_ground=False), category="wildlife")
    high = Performing(Body(500.0, height_m=15.1, on_ground=False), category="wildlife")
    watch = Watch({"A": plane, "B": bird, "C": high}).look()
    assert [watch.monitor.is_on(name, "01") for name in "ABC"] == [False, True, False]


def test_occupancy_is_told_when_it_changes_and_not_again() -> None:
    car = vehicle(500.0, right_m=-300.0)
    watch = Watch({"OPS": car}).look().look()
    car.body.right_m = 0.0
    watch.look().look()
    car.body.ended = "collision with A"
    watch.look()
    told = [occupants for key, occupants in watch.occupied if key == "truth/runway/01-19"]
    assert told == [("OPS",), ()]


def test_at_an_intersection_both_runways_are_occupied() -> None:
    watch = Watch({"OPS": vehicle(609.0)}).look()
    assert watch.monitor.is_on("OPS", "01")
    assert watch.monitor.is_on("OPS", "22")
    assert not watch.monitor.is_on("OPS", "33")


@pytest.mark.parametrize("time_s", [10.0, 60.0])
def test_the_time_to_the_threshold_is_distance_over_speed(time_s: float) -> None:
    watch = Watch({"A": arrival(time_s)})
    assert watch.monitor.time_to_threshold_s("A", "01") == pytest.approx(time_s, rel=1e-4)
    assert watch.monitor.time_to_threshold_s("A", "19") is None


# --- incursions -----------------------------------------------------------------------------


@pytest.mark.parametrize(("time_s", "incursions"), [(60.0, []), (29.0, [("A", "OPS")])])
def test_a_vehicle_in_the_way_counts_once_the_arrival_is_near(
    time_s: float, incursions: list[tuple[str, str]]
) -> None:
    watch = Watch({"A": arrival(time_s), "OPS": vehicle(800.0)}).look().look()
    assert watch.incurred == incursions


@pytest.mark.parametrize("phase", ["glide", "flare", "rollout"])
@pytest.mark.parametrize(("speed_kt", "uses"), [(4.0, True), (1.0, False), (-60.0, False)])
def test_who_hovers_or_moves_back_does_not_use_a_runway(
    phase: str, speed_kt: float, uses: bool
) -> None:
    """A metre a second is 1.9 knots."""
    landing = airliner(10.0, phase, speed_kt=speed_kt)
    incurred = Watch({"A": landing, "OPS": vehicle(800.0)}).look().incurred
    assert incurred == ([("A", "OPS")] if uses else [])


def test_what_lies_behind_a_landing_is_not_in_its_way() -> None:
    rolling = airliner(1_200.0, "rollout", speed_kt=60.0)
    assert Watch({"A": rolling, "OPS": vehicle(300.0)}).look().incurred == []
    assert Watch({"A": rolling, "OPS": vehicle(1_700.0)}).look().incurred == [("A", "OPS")]


def test_who_crosses_while_nobody_uses_the_runway_does_no_wrong() -> None:
    watch = Watch({"OPS": vehicle(800.0), "A": airliner(0.0, "lined_up")}).look()
    assert watch.incurred == []


def test_a_departure_ahead_of_an_arrival_counts_from_the_threshold_on() -> None:
    leaving = airliner(900.0, "takeoff_roll", speed_kt=110.0)
    assert Watch({"A": arrival(8.0), "D": leaving}).look().incurred == []
    over = airliner(30.0, "flare", speed_kt=135.0, height_m=8.0, on_ground=False)
    assert ("A", "D") in Watch({"A": over, "D": leaving}).look().incurred


def test_head_on_the_other_is_in_the_way_at_once() -> None:
    leaving = airliner(200.0, "takeoff_roll", speed_kt=60.0)
    landing = arrival(20.0, runway="19")
    assert Watch({"A": landing, "D": leaving}).look().incurred == [("A", "D")]


def test_on_a_crossing_runway_who_rolls_through_the_intersection_is_in_the_way() -> None:
    crossing = airliner(1_505.0, "rollout", speed_kt=80.0)
    leaving = airliner(300.0, "takeoff_roll", runway="33", speed_kt=70.0)
    assert ("D", "A") in Watch({"A": crossing, "D": leaving}).look().incurred


def climbing(along_m: float, height_m: float, phase: str = "climb_out", **kw: Any) -> Performing:
    """An airliner in flight along a runway that its crew is bound for no more."""
    plane = airliner(along_m, phase, speed_kt=150.0, height_m=height_m, on_ground=False, **kw)
    plane.bound_runway = None
    return plane


CROSSING_M = {"01": 1_504.0, "33": 783.0}
"""Distance past the threshold at which runways 01 and 33 cross."""


@pytest.mark.parametrize("phase", ["climb_out", "go_around", "en_route"])
def test_who_flies_low_over_a_crossing_runway_is_in_the_way_of_who_rolls_there(phase: str) -> None:
    landed = airliner(1_400.0, "rollout", speed_kt=90.0)
    over = climbing(CROSSING_M["33"], 36.0, phase, runway="33")
    watch = Watch({"A": landed, "D": over}).look()
    assert ("A", "D") in watch.incurred
    landed.body.along_m = CROSSING_M["01"]
    assert set(watch.look().categories) == {"A"}


@pytest.mark.parametrize(
    ("landed_m", "departed_m", "height_m"), [(1_600.0, 780.0, 36.0), (1_400.0, 1_000.0, 36.0),
                                             (1_400.0, 780.0, 180.0)],
    ids=["the landing is past", "the departure is past", "high above"],
)  # fmt: skip
def test_who_has_passed_the_crossing_or_is_high_above_is_not_in_the_way(
    landed_m: float, departed_m: float, height_m: float
) -> None:
    """FAA Order JO 7110.65, 3-10-4, and 500 ft above what stands on the runway."""
    landed = airliner(landed_m, "rollout", speed_kt=60.0)
    departed = climbing(departed_m, height_m, runway="33")
    assert ("A", "D") not in Watch({"A": landed, "D": departed}).look().incurred


@pytest.mark.parametrize("phase", ["takeoff_roll", "climb_out"])
def test_an_arrival_may_be_short_of_its_threshold_while_another_crosses(phase: str) -> None:
    crosses = airliner(CROSSING_M["33"], phase, runway="33", speed_kt=130.0)
    crosses.body.on_ground = phase != "climb_out"
    crosses.body.height_m = 0.0 if crosses.body.on_ground else 20.0
    assert Watch({"A": arrival(5.0), "D": crosses}).look().incurred == []


@pytest.mark.parametrize(("ahead_m", "incurred"), [(900.0, [("A", "D")]), (930.0, [])])
def test_behind_who_is_airborne_3000_ft_ahead_the_next_may_land_or_take_off(
    ahead_m: float, incurred: list[tuple[str, str]]
) -> None:
    """The least minimum of FAA Order JO 7110.65, 3-9-6 and 3-10-3."""
    leaving = climbing(100.0 + ahead_m, 60.0)
    for phase in ("takeoff_roll", "rollout"):
        rolling = airliner(100.0, phase, speed_kt=60.0)
        assert Watch({"A": rolling, "D": leaving}).look().incurred == incurred


@pytest.mark.parametrize(
    ("phase", "height_m", "category"),
    [("climb_out", 40.0, "B"), ("go_around", 20.0, "A"), ("rejected_takeoff", 0.0, "A")],
)
def test_what_enters_ahead_of_who_takes_off_or_goes_around_is_in_the_way(
    phase: str, height_m: float, category: str
) -> None:
    plane = climbing(900.0, height_m, phase)
    plane.body.on_ground = height_m == 0.0
    watch = Watch({"A": plane, "OPS": vehicle(1_300.0)}).look()
    assert watch.incurred == [("A", "OPS")]
    plane.body.along_m = 1_300.0
    assert watch.look().categories == [category]


def test_a_pass_of_two_that_have_climbed_away_is_followed_to_its_end() -> None:
    leaving, behind = climbing(900.0, 170.0), arrival(0.1)
    watch = Watch({"A": behind, "D": leaving}).look()
    behind.body.along_m, behind.body.height_m, behind.body.phase = 300.0, 60.0, "go_around"
    assert watch.look().incurred == [("A", "D")]
    leaving.body.along_m, leaving.body.height_m = 1_000.0, 190.0
    behind.body.along_m, behind.body.height_m = 900.0, 240.0
    assert watch.look().categories == ["B"]


def test_who_goes_around_is_no_arrival() -> None:
    arrivals: list[Any] = []
    plane = arrival(60.0)
    monitor = RunwayMonitor(
        kdca(),
        {"A": cast(Any, plane)},
        set(),
        set(),
        lambda _, truth: arrivals.append([one.actor for one in truth.arrivals]),
        lambda _: None,
    )
    monitor.tick(SECOND_NS)
    plane.body.phase, plane.bound_runway = "go_around", None
    plane.body.along_m, plane.body.height_m = 300.0, 60.0
    monitor.tick(2 * SECOND_NS)
    assert arrivals == [["A"], []]


def test_an_incursion_is_over_once_neither_uses_the_runway_whatever_they_do_later() -> None:
    rolling, car = airliner(1_200.0, "rollout", speed_kt=60.0), vehicle(1_700.0)
    watch = Watch({"A": rolling, "OPS": car}).look()
    (incursion,) = watch.monitor.incursions.values()
    rolling.body.phase, rolling.bound_runway = "taxi", None
    watch.look()
    apart = incursion.closest
    rolling.body.phase = "takeoff_roll"  # From another runway, past the car beside it.
    rolling.body.right_m = car.body.right_m = -400.0
    car.body.along_m = 1_230.0
    watch.look()
    assert incursion.over
    assert incursion.closest == apart
    assert watch.categories == ["C"]


def test_each_animal_on_each_runway_is_an_incursion_of_its_own() -> None:
    """The first one stands where two runways cross, the others on one runway alone."""
    deer = [Performing(Body(along_m), category="wildlife") for along_m in (609.0, 900.0, 1_000.0)]
    watch = Watch(dict(zip("XYZ", deer, strict=True))).look().look()
    found = sorted((each.runway, each.intruder) for each in watch.monitor.incursions.values())
    north, crossing = kdca().strip_of("01").name, kdca().strip_of("22").name
    assert found == sorted([(north, "X"), (north, "Y"), (north, "Z"), (crossing, "X")])
    assert set(watch.categories) == {"D"}


def test_wildlife_alone_is_of_category_d_and_so_is_who_was_misled() -> None:
    deer = Performing(Body(1_000.0), category="wildlife")
    assert Watch({"DEER": deer}).look().categories == ["D"]
    assert Watch({"OPS": vehicle(1_000.0)}).look().categories == []
    assert Watch({"OPS": vehicle(1_000.0)}, affected={"OPS"}).look().categories == ["D"]


def test_a_takeoff_without_clearance_is_an_incorrect_presence_by_itself() -> None:
    rolling = airliner(100.0, "takeoff_roll", speed_kt=30.0)
    assert Watch({"D": rolling}).look().categories == []
    assert Watch({"D": rolling}, affected={"D"}).look().categories == []
    assert Watch({"D": rolling}, affected={"D"}, uncleared={"D"}).look().categories == ["D"]


@pytest.mark.parametrize(("time_s", "user"), [(20.0, "A"), (40.0, None)])
def test_a_takeoff_without_clearance_meets_who_comes_on_a_crossing_runway(
    time_s: float, user: str | None
) -> None:
    """It is rejected before the crossing, and the arrival has not touched down."""
    rolling = airliner(100.0, "takeoff_roll", runway="33", speed_kt=30.0)
    watch = Watch({"A": arrival(time_s), "D": rolling}, uncleared={"D"}).look().look()
    assert watch.incurred == [(user, "D")]


def test_past_the_crossing_an_arrival_is_not_in_the_way_of_who_rolls_uncleared() -> None:
    landed = airliner(1_900.0, "rollout", speed_kt=60.0)
    rolling = airliner(100.0, "takeoff_roll", runway="33", speed_kt=30.0)
    watch = Watch({"A": landed, "D": rolling}, uncleared={"D"}).look()
    assert watch.incurred == [(None, "D")]


@pytest.mark.parametrize("phase", ["en_route", "taxi", "vacate"])
def test_who_is_bound_for_a_runway_uses_it_only_to_take_off_or_to_land(phase: str) -> None:
    moving = airliner(300.0, phase, speed_kt=20.0)
    assert Watch({"A": moving, "OPS": vehicle(800.0)}).look().incurred == []


def test_the_closest_distance_makes_the_category(subtests: pytest.Subtests) -> None:
    """A go-around over a vehicle: it comes from afar, passes above, and is gone."""
    for above_ft, category in [
        (60.0, "A"),
        (99.5, "A"),
        (100.5, "B"),
        (300.0, "B"),
        (499.5, "B"),
        (500.5, "C"),
        (700.0, "C"),
    ]:
        with subtests.test(str((above_ft, category))):
            plane, car = arrival(25.0), vehicle(800.0)
            watch = Watch({"A": plane, "OPS": car}).look()
            plane.body.phase = "go_around"
            for along_m in (0.0, 800.0, 2_000.0):
                plane.body.along_m = along_m
                plane.body.height_m = above_ft * FOOT + CAR.height_m
                watch.look()
            assert watch.categories == [category]


@pytest.mark.parametrize("first", ["alone", "over"])
def test_of_several_incursions_each_is_followed_by_itself(first: str) -> None:
    """One is followed on though an earlier one is in nobody's way, or is over."""
    plane, car, other = arrival(25.0), vehicle(800.0), vehicle(700.0)
    if first == "alone":
        other = Performing(Body(900.0, runway="15"), category="wildlife")
    watch = Watch({"X": other, "A": plane, "OPS": car}).look()
    if first == "over":
        other.body.ended = "left"
    plane.body.phase = "go_around"
    for along_m in (0.0, 800.0, 2_000.0):
        plane.body.along_m, plane.body.height_m = along_m, 60.0 * FOOT + CAR.height_m
        watch.look()
    found = {each.intruder: each.category for each in watch.monitor.incursions.values()}
    assert list(found) == ["X", "OPS"]
    assert found["OPS"] == "A"
    assert found["X"] == ("D" if first == "alone" else "C")


def test_a_collision_is_an_accident() -> None:
    watch = Watch({"A": arrival(5.0), "OPS": vehicle(300.0)}).look()
    watch.monitor.collided("OPS", "A")
    assert watch.categories == ["accident"]


def test_who_has_stopped_on_the_runway_is_still_come_near_to_by_the_other() -> None:
    """Head-on, the first user of the runway has stopped, and the second rolls on towards it."""
    landed = airliner(1_200.0, "rollout", runway="19", speed_kt=70.0)
    rolling = airliner(300.0, "takeoff_roll", speed_kt=40.0)
    watch = Watch({"A": landed, "D": rolling}).look()
    assert watch.incurred == [("A", "D")]
    landed.body.phase, landed.body.speed_kt = "standing", 0.0
    rolling.body.along_m = 700.0
    watch.look()
    (incursion,) = watch.monitor.incursions.values()
    end = kdca().runway("01")
    between = end.length_m - 1_200.0 - 700.0 - B737.dimensions.length_m
    assert incursion.closest.horizontal_m == pytest.approx(between, abs=1.0)


def test_who_comes_a_second_time_is_followed_again() -> None:
    plane, car = arrival(20.0), vehicle(800.0)
    watch = Watch({"A": plane, "OPS": car}).look()
    plane.body.phase = "en_route"
    watch.look()
    assert watch.categories == ["C"]
    plane.body.phase, plane.body.along_m, plane.body.height_m = "flare", 500.0, 20.0
    watch.look()
    plane.body.along_m = 800.0
    watch.look()
    assert watch.categories == ["A"]
    assert watch.incurred == [("A", "OPS")]


def test_the_same_runway_from_the_other_side_is_the_same_place() -> None:
    assert Watch({"A": arrival(20.0, "19"), "OPS": vehicle(800.0)}).look().incurred
    watch = Watch({"A": arrival(20.0), "OPS": vehicle(800.0)})
    assert watch.monitor.is_bound_for("A", "1")
    assert not watch.monitor.is_bound_for("A", "19")


def test_an_arrival_is_told_once_with_its_time() -> None:
    plane = arrival(60.0)
    told: list[RunwayTruth] = []
    monitor = RunwayMonitor(
        kdca(),
        {"A": cast(Any, plane)},
        set(),
        set(),
        lambda _, truth: told.append(truth),
        lambda _: None,
    )
    monitor.tick(SECOND_NS)
    plane.body.along_m /= 2.0
    monitor.tick(2 * SECOND_NS)
    plane.body.phase, plane.body.on_ground, plane.body.along_m = "rollout", True, 300.0
    monitor.tick(3 * SECOND_NS)
    first, last = told
    assert [(one.actor, one.runway) for one in first.arrivals] == [("A", "01")]
    assert first.arrivals[0].time_to_threshold_s == pytest.approx(60.0, abs=0.1)
    assert (last.occupants, last.arrivals) == (("A",), ())
