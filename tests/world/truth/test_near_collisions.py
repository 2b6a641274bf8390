"""Passes that are too near at an airport are never called avoided, whatever the two are doing."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any, cast

from hypothesis import given
from hypothesis import strategies as st

from airhilt.geodesy.relative_motion import Minima
from airhilt.metrics.outcome import Outcome
from airhilt.shapes.sizes import Dimensions
from airhilt.units import FOOT, SECOND_NS
from airhilt.world.flight import AircraftType, load_aircraft_type
from airhilt.world.mover import SurfaceState
from airhilt.world.site import FixedSite
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.layout import Layout
from airhilt.world.truth.conflicts import ConflictMonitor
from airhilt.world.truth.gaps import gap
from airhilt.world.truth.runways import RunwayMonitor
from breadth import examples

B737 = load_aircraft_type("737")
ON_THE_RUNWAY = ("takeoff_roll", "rejected_takeoff", "rollout")
IN_FLIGHT = ("rotate", "climb_out", "glide", "flare", "go_around")
TICKS_PER_S = 20
LASTS_S = 10


@cache
def kdca() -> Layout:
    return Layout(load_airport("KDCA"))


def crossing() -> tuple[float, float]:
    """Return where runways 01 and 33 cross, in local metres."""
    names = {kdca().strip_of("01").name, kdca().strip_of("33").name}
    return next(point for *pair, point in kdca().intersections if set(pair) == names)


def course_deg(runway: str) -> float:
    return math.degrees(kdca().runway(runway).course_rad)


@dataclass
class Passing:
    """Something that moves straight on, and is at the crossing, or beside it, after a time."""

    at_s: float
    course_deg: float
    speed_m_s: float
    phase: str
    runway: str | None = None
    height_m: float = 0.0
    rate_m_s: float = 0.0
    aside_m: float = 0.0
    kind: AircraftType | None = B737
    ended: str | None = None

    @property
    def on_ground(self) -> bool:
        return self.phase not in IN_FLIGHT

    @property
    def dimensions(self) -> Any:
        return (
            Dimensions(length_m=5.0, span_m=2.0, height_m=2.0)
            if self.kind is None
            else self.kind.dimensions
        )

    def move_to(self, t_s: float) -> None:
        """Be where it is at a time, in s."""
        course, past_s = math.radians(self.course_deg), t_s - self.at_s
        sin, cos = math.sin(course), math.cos(course)
        rate = 0.0 if self.on_ground else self.rate_m_s
        height = max(self.height_m + rate * past_s, 0.0)
        east, north = crossing()
        along = self.speed_m_s * past_s
        self.state = SurfaceState(
            *kdca().local_frame.to_place(
                east + along * sin + self.aside_m * cos, north + along * cos - self.aside_m * sin
            ),
            altitude_m=height,
            height_agl_m=height,
            velocity_north_m_s=self.speed_m_s * cos,
            velocity_east_m_s=self.speed_m_s * sin,
            velocity_down_m_s=-rate,
            heading_rad=course % math.tau,
        )

    @property
    def actor(self) -> Any:
        @dataclass
        class Performing:
            body: Passing
            bound_runway: str | None
            category: str

        return Performing(self, self.runway, "vehicle" if self.kind is None else "aircraft")


class Pass:
    """The pass of two, watched as a run watches it."""

    def __init__(self, first: Passing, second: Passing) -> None:
        bodies: dict[str, Any] = {"A": first, "B": second}
        runways = RunwayMonitor(
            kdca(),
            {name: body.actor for name, body in bodies.items()},
            set(),
            set(),
            lambda *_: None,
            lambda _: None,
        )
        zone = FixedSite(*kdca().local_frame.to_place(0.0, 0.0))
        flown = {name for name, body in bodies.items() if body.kind is not None}
        monitor = ConflictMonitor(
            {name: bodies[name] for name in flown},
            {name: body for name, body in bodies.items() if name not in flown},
            Minima(5 * 1852.0, 900 * FOOT),
            0.0,
            zone,
            1.0 / TICKS_PER_S,
            frozenset(),
            frozenset(),
            lambda phase, pair, *_: runways.collided(*pair) if phase == "collision" else None,
        )
        self.outcome = Outcome(monitor, runways, ("A", "B"))
        self.nearest_m, self.touches = math.inf, False
        for tick in range(LASTS_S * TICKS_PER_S):
            now_ns = tick * SECOND_NS // TICKS_PER_S
            for body in (first, second):
                body.move_to(tick / TICKS_PER_S)
            monitor.tick(now_ns)
            if tick % 4 == 0:
                runways.tick(now_ns)
            if monitor.motion(("A", "B")).distance_m < 300.0:
                between = gap(cast(Any, first), cast(Any, second))
                self.touches |= between.touches
                self.nearest_m = min(self.nearest_m, between.slant_m)

    def must_be_seen_if_near(self) -> None:
        assert self.outcome.happened("collision") == self.touches
        is_avoided = self.outcome.avoided(was_warned=True)
        if self.nearest_m < 100 * FOOT:
            assert is_avoided is False
        elif self.nearest_m > 500 * FOOT:
            assert is_avoided is True


@st.composite
def using(draw: Any, *runways: str) -> Passing:
    """An airliner that takes off, lands, or goes around, a few seconds from the crossing.

    In flight it may turn off the runway.
    """
    runway = draw(st.sampled_from(runways))
    phase = draw(st.sampled_from(ON_THE_RUNWAY + IN_FLIGHT))
    turned_deg = draw(st.floats(-40.0, 40.0)) if phase in IN_FLIGHT else 0.0
    return Passing(
        at_s=draw(st.floats(4.0, 7.0)),
        course_deg=course_deg(runway) + turned_deg,
        speed_m_s=draw(st.floats(15.0, 90.0)),
        phase=phase,
        runway=None if phase in ("climb_out", "go_around") else runway,
        height_m=draw(st.floats(2.0, 160.0)) if phase in IN_FLIGHT else 0.0,
        rate_m_s=draw(st.floats(-5.0, 15.0)),
        aside_m=draw(st.floats(-8.0, 8.0)),
    )


@st.composite
def in_the_way(draw: Any) -> Passing:
    """A vehicle or an airliner that crosses a runway on the ground."""
    kind = draw(st.sampled_from([None, B737]))
    return Passing(
        at_s=draw(st.floats(4.0, 7.0)),
        course_deg=course_deg("01") + draw(st.floats(30.0, 150.0)),
        speed_m_s=draw(st.floats(0.0, 15.0)),
        phase="driving" if kind is None else "taxi",
        kind=kind,
    )


@examples(100)
@given(using("01", "19"), using("15", "33"))
def test_two_on_crossing_runways_are_seen_in_every_phase(first: Passing, second: Passing) -> None:
    Pass(first, second).must_be_seen_if_near()


@examples(100)
@given(using("01"), using("01", "19"))
def test_two_on_one_runway_are_seen_in_every_phase(first: Passing, second: Passing) -> None:
    Pass(first, second).must_be_seen_if_near()


@examples(100)
@given(using("01", "19"), in_the_way())
def test_who_crosses_under_a_user_of_the_runway_is_seen(first: Passing, second: Passing) -> None:
    Pass(first, second).must_be_seen_if_near()


@examples(100)
@given(
    using("01", "19", "15", "33"),
    using("01", "19", "15", "33"),
    st.floats(-5.0, 5.0),
    st.floats(0, 1),
)
def test_two_that_are_moved_through_each_other_collide(
    first: Passing, second: Passing, deep_m: float, late: float
) -> None:
    second.at_s, second.aside_m = first.at_s + late * 0.05, first.aside_m
    second.phase, second.runway = first.phase, first.runway
    second.height_m = max(first.height_m + deep_m, 0.0) if first.height_m else 0.0
    passed = Pass(first, second)
    assert passed.outcome.happened("collision")
    assert passed.outcome.avoided(was_warned=True) is False
