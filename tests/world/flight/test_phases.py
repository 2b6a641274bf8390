"""Phases of procedures by themselves: what they set, and which phase follows."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, cast

import pytest

from airhilt.geodesy.wgs84 import Place
from airhilt.units import DEGREE, KNOT
from airhilt.world.flight import load_aircraft_type
from airhilt.world.flight.modes import GuidanceModes
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.approach import Glide
from airhilt.world.flight.procedures.en_route import EnRoute
from airhilt.world.flight.procedures.final import Final
from airhilt.world.flight.procedures.landing import Rollout
from airhilt.world.flight.procedures.takeoff import ClimbOut, TakeoffRoll
from airhilt.world.flight.state import AircraftState
from flights import COURSE, along_runway, make_runway
from stand_ins import StandIn, state_at

B737 = load_aircraft_type("737")
FINAL = Final(make_runway("01"), B737)
TICK_S = 0.05
V2_KT = B737.speeds.climb_safety_kt


class Systems:
    """Stand-ins for all that the phases of a 737 set."""

    def __init__(self) -> None:
        self.airframe, self.autopilot, self.ground = StandIn(), StandIn(), StandIn()

    @property
    def all(self) -> AircraftSystems:
        airframe: Any = self.airframe
        autopilot: Any = self.autopilot
        ground: Any = self.ground
        return AircraftSystems(B737, airframe, autopilot, ground, TICK_S)

    def en_route(self) -> EnRoute:
        """Return the climb to 1,500 m on the runway's course."""
        modes = GuidanceModes(B737)
        return EnRoute(self.all, FINAL, modes.steepest_climb(1_500.0), modes.clean_climb_speed())


def along(distance_m: float, **state: float) -> AircraftState:
    return state_at(along_runway(distance_m), track_rad=COURSE * DEGREE, **state)


# --- takeoff --------------------------------------------------------------------------------


def test_takeoff_thrust_is_set_within_seconds_and_not_at_once() -> None:
    systems = Systems()
    phase: FlightPhase = TakeoffRoll(systems.all, FINAL, systems.en_route())
    levers: list[float] = []
    for _ in range(round(10.0 / TICK_S)):
        phase = phase.fly(along(60.0, speed_m_s=20.0))
        levers += systems.airframe.got["set_throttle"]
    assert max(levers[: round(1.0 / TICK_S)]) < 0.4
    assert levers[round(6.0 / TICK_S)] == 1.0
    assert levers == sorted(levers)


def climbed_out(airspeed_kt: float, altitude_m: float, rate_m_s: float = 8.0) -> Systems:
    """Return what a tick of the climb-out sets."""
    systems = Systems()
    state = along(3_000.0, speed_m_s=airspeed_kt * KNOT, altitude_m=altitude_m, rate_m_s=rate_m_s)
    phase = ClimbOut(systems.all, FINAL, systems.en_route()).fly(state)
    assert phase.name == "climb_out"
    return systems


def test_climbing_it_takes_the_gear_up() -> None:
    assert climbed_out(V2_KT, 50.0).airframe.got["set_gear"] == (0.0,)
    assert "set_gear" not in climbed_out(V2_KT, 50.0, rate_m_s=0.5).airframe.got


@pytest.mark.parametrize(
    ("above_v2_kt", "altitude_m", "retracts"),
    [(19.0, 200.0, False), (21.0, 200.0, True), (21.0, 100.0, False)],
)
def test_flaps_come_in_20_kt_above_v2_and_400_ft_above_the_ground(
    above_v2_kt: float, altitude_m: float, retracts: bool
) -> None:
    got = climbed_out(V2_KT + above_v2_kt, altitude_m).airframe.got
    assert got.get("set_flaps") == ((0.0,) if retracts else None)


# --- approach -------------------------------------------------------------------------------


def test_once_on_the_glide_path_who_sinks_below_it_is_led_back_up_to_it() -> None:
    """It is not kept at the altitude from which it came onto the path."""
    systems = Systems()
    systems.airframe.answers["main_wheel_height_m"] = 300.0
    path_m = -FINAL.above_glide_path_m(along(-6_000.0, altitude_m=0.0))
    glide = Glide(systems.all, FINAL, (), path_m)

    def rate_m_s(altitude_m: float) -> float:
        assert glide.fly(along(-6_000.0, altitude_m=altitude_m)) is glide
        return float(systems.autopilot.got["fly"][2])

    assert rate_m_s(path_m + 5.0) < -70.0 * math.tan(3.0 * DEGREE)
    # Three kilometres farther out, the same altitude is 157 m below the path.
    low = along(-9_000.0, altitude_m=path_m)
    glide.fly(low)
    assert systems.autopilot.got["fly"][2] == pytest.approx(FINAL.vertical_rate(low))
    assert FINAL.vertical_rate(low) > 0.0


# --- rollout --------------------------------------------------------------------------------


EXIT: list[Place] = [along_runway(900.0), along_runway(930.0, 30.0), along_runway(930.0, 150.0)]


@pytest.mark.parametrize(
    ("at_m", "speed_m_s", "name"),
    [(500.0, 3.0, "rollout"), (898.0, 3.0, "vacate"), (898.0, 20.0, "rollout")],
    ids=["early", "there", "too fast"],
)
def test_it_turns_into_the_exit_where_that_begins_and_if_slow_enough(
    at_m: float, speed_m_s: float, name: str
) -> None:
    rollout = Rollout(Systems().all, FINAL, EXIT)
    assert rollout.fly(along(at_m, speed_m_s=speed_m_s)).name == name


def test_rolling_out_it_takes_no_en_route_command(on_the_ground: Callable[..., Any]) -> None:
    aircraft = on_the_ground("737")
    control = aircraft._control
    control.phase = Rollout(control.systems, cast(Any, FINAL), ())
    with pytest.raises(ValueError, match="in phase rollout on the ground; expected in the air"):
        aircraft.en_route.hold_track(1.0)
