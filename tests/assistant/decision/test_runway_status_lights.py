"""The runway status lights: which are lit when, who is told, and what is done on red."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import pytest

from airfield import (
    APPROACH_M_S,
    BRIEFING,
    NORTH,
    SOUTHEAST,
    Mover,
    drives,
    lands,
    stands,
    takes_off,
)
from airhilt.assistant.decision.engines import decision_engine
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.messages import Advisory, SurfaceTrack
from airhilt.sim import Input
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE, SECOND_NS, bearing_degrees

THRESHOLD_S = 60.0
ONE_MILE_S = THRESHOLD_S - NAUTICAL_MILE / APPROACH_M_S
AIRPORT = "XFLD"


@dataclass
class SurfaceField:
    """Feeds exact tracks of some movers to the lights, once a second."""

    movers: list[Mover]
    told: list[tuple[float, Advisory]] = field(default_factory=list)
    configuration: dict[str, float] = field(default_factory=dict)

    def run(self, seconds: int) -> SurfaceField:
        engine = decision_engine("runway_status_lights", configuration=self.configuration)
        worker = DecisionWorker(engine, Template())
        worker.step(0, [Input("briefing", 0, BRIEFING.model_dump_json().encode())])
        for t_s in range(seconds):
            t_ns = t_s * SECOND_NS
            inputs = [
                Input(f"surface/{AIRPORT}", t_ns, self.track(number, mover, t_s))
                for number, mover in enumerate(self.movers, start=1)
            ]
            for output in worker.step(t_ns, inputs).outputs:
                self.told.append((t_s, Advisory.model_validate_json(output.payload)))
        return self

    @staticmethod
    def track(number: int, mover: Mover, t_s: float) -> bytes:
        state, grounded = mover.state(t_s), mover.is_on_ground(t_s)
        speed = math.hypot(state.velocity_north_m_s, state.velocity_east_m_s)
        named = mover.equipped
        track = SurfaceTrack(
            airport=AIRPORT, track=number, kind="combined" if named else "primary",
            t_track_ns=round(t_s * SECOND_NS), accuracy_m=7.5,
            latitude_deg=state.latitude_rad / DEGREE, longitude_deg=state.longitude_rad / DEGREE,
            altitude_ft=state.altitude_m / FOOT if named and not grounded else None,
            on_ground=grounded if named else None,
            ground_speed_kt=speed / KNOT,
            track_deg=bearing_degrees(state.heading_rad) if speed > 0.2 else None,
            icao24=mover.icao24 if named else None,
            callsign=mover.callsign or None if named else None,
        )  # fmt: skip
        return track.model_dump_json().encode()

    def red(self, recipient: str, severity: str | None = None) -> list[float]:
        """Return when somebody was told of red lights."""
        return [
            t_s
            for t_s, told in self.told
            if told.recipient == recipient
            and told.active
            and severity in (None, told.severity.value)
        ]

    def out(self, recipient: str) -> list[float]:
        """Return when somebody was told that lights are out."""
        return [t_s for t_s, told in self.told if told.recipient == recipient and not told.active]


def lit(*movers: Mover, seconds: int = 100) -> SurfaceField:
    return SurfaceField(list(movers)).run(seconds)


def comes_to_hold(at_s: float, along_m: float = 800.0) -> Mover:
    """A truck that drives up to a hold line, stands there, and has seen the runway ahead."""
    return Mover("OPS1", NORTH, drives(at_s, along_m=along_m, to_m=-90.0), category="C2")


def arrival(at_s: float = THRESHOLD_S) -> Mover:
    return Mover("AAL123", NORTH, lands(at_s))


# --- entrance lights ------------------------------------------------------------------------


def test_red_before_one_who_stands_is_an_advisory_and_against_it_a_warning() -> None:
    standing = lit(arrival(), comes_to_hold(0.0))
    assert not standing.red("OPS1", "WARNING")
    assert all(told.recommendation is None for _, told in standing.told)
    driving = lit(arrival(), Mover("OPS1", NORTH, drives(20.0), category="C2"))
    assert driving.red("OPS1", "WARNING")


def test_on_red_a_driver_stops_short_of_the_runway() -> None:
    truck = Mover("OPS1", NORTH, drives(20.0, from_m=-220.0), category="C2")
    told = next(t for _, t in lit(arrival(), truck).told if t.severity == "WARNING")
    assert told.recommendation is not None
    assert told.recommendation.action == "hold_position"
    assert told.message == ("OPS1 hold position, entrance lights red for runway 01, traffic AAL123")


def test_one_who_cannot_stop_short_of_the_runway_is_left_to_their_judgement() -> None:
    truck = Mover("OPS1", NORTH, drives(ONE_MILE_S - 24.0), category="C2")
    warnings = [t for _, t in lit(arrival(), truck).told if t.severity == "WARNING"]
    assert [told.recommendation for told in warnings] == [None]


def test_a_truck_without_a_transponder_is_told_by_the_name_that_no_track_has() -> None:
    truck = comes_to_hold(0.0)
    truck.equipped = False
    assert lit(arrival(), truck).red("OPS1")


def test_nobody_is_named_where_two_tracks_have_no_name() -> None:
    """A deer beside the truck: the name that no track has may be that of either."""
    truck, deer = comes_to_hold(0.0), comes_to_hold(0.0, along_m=900.0)
    truck.equipped = deer.equipped = False
    assert not lit(arrival(), truck, deer).red("OPS1")


def test_who_has_an_address_but_no_callsign_is_not_without_a_name() -> None:
    truck, other = comes_to_hold(0.0), Mover("DAL456", NORTH, stands(500.0, 300.0))
    truck.equipped = False
    other.callsign = ""
    assert lit(arrival(), truck, other).red("OPS1")


def test_the_numbers_of_the_lights_can_be_set() -> None:
    field = SurfaceField([arrival(), comes_to_hold(0.0)])
    field.configuration = {"arrival_m": 3000.0}
    assert field.run(100).red("OPS1")[0] == pytest.approx(
        THRESHOLD_S - 3000.0 / APPROACH_M_S, abs=1.5
    )


# --- take-off hold and intersection lights --------------------------------------------------


def test_a_crew_that_rolls_against_them_rejects_the_take_off() -> None:
    truck = Mover("OPS1", NORTH, stands(1500.0), category="C2")
    field = lit(Mover("AAL123", NORTH, takes_off(20.0)), truck, seconds=40)
    told = next(t for _, t in field.told if t.severity == "WARNING")
    assert told.recommendation is not None
    assert told.recommendation.action == "cancel_takeoff"
    assert field.red("AAL123", "WARNING")[0] <= 25.0


def test_intersection_lights_are_red_before_a_departure_while_somebody_lands_across() -> None:
    crossing = Mover("AAL123", SOUTHEAST, lands(THRESHOLD_S))
    field = lit(crossing, Mover("DAL456", NORTH, takes_off(500.0)))
    told = next(told for _, told in field.told)
    assert told.recipient == "DAL456"
    assert told.message == "DAL456 intersection lights red for runway 01, traffic AAL123"
    assert field.out("DAL456")
