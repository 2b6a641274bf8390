"""What crews do about runways when told, at KDCA, and what they say when they cannot."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache
from typing import Any, cast

import pytest
from pydantic import TypeAdapter

from airhilt.commands import Command
from airhilt.geodesy.positions import RunwayPosition
from airhilt.messages import Advisory, CancelTakeoff, Evidence, GoAround, HoldPosition, Severity
from airhilt.scenario.models import AircraftSpec, Reactions
from airhilt.units import FOOT, KNOT
from airhilt.world.actors.actor import Unable
from airhilt.world.actors.crew import Crew
from airhilt.world.flight import load_aircraft_type
from airhilt.world.loading import load
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.runway import RunwayEnd

B737 = load_aircraft_type("737")
COMMAND = TypeAdapter(Command)


@cache
def kdca() -> ScenarioSite:
    return ScenarioSite.of(load("s01a_nominal"))


@dataclass
class Plane:
    """Takes down what it is told; the test says where it is and what it does."""

    phase: str = "standing"
    place: tuple[float, float] = (0.0, 0.0)
    height_m: float = 0.0
    speed_kt: float = 0.0
    heading_deg: float = 355.5
    told: list[tuple[Any, ...]] = field(default_factory=list)
    refuses: str = ""
    kind = B737
    ended = None
    is_taxiing = True

    @property
    def en_route(self) -> Plane:
        return self

    @property
    def procedures(self) -> Plane:
        return self

    @property
    def on_ground(self) -> bool:
        return self.height_m == 0.0

    @property
    def target_altitude_m(self) -> float:
        return 1_000.0

    @property
    def state(self) -> type[Any]:
        heading, speed = math.radians(self.heading_deg), self.speed_kt * KNOT

        class Now:
            latitude_rad, longitude_rad = place = self.place
            height_agl_m = self.height_m
            altitude_m = self.height_m
            track_rad = heading_rad = heading
            ground_speed_m_s = true_airspeed_m_s = speed
            calibrated_airspeed_m_s = speed

        return Now

    def _tell(self, name: str, *arguments: object) -> None:
        if self.refuses == name:
            raise ValueError(f"{name} in phase {self.phase}; expected something else")
        self.told.append((name, *arguments))

    def taxi(
        self, path: list[tuple[float, float]], speed_m_s: None = None, *, then: str = "standing"
    ) -> None:
        self._tell("taxi", tuple(path), then)
        self.phase = "line_up" if then == "lined_up" else "taxi"

    def take_off(self, runway: RunwayEnd, climb_to_m: float) -> None:
        self._tell("take_off", runway.ident, round(climb_to_m / FOOT))
        self.phase = "takeoff_roll"

    def land(self, runway: RunwayEnd, exit_path: tuple[Any, ...] = ()) -> None:
        self._tell("land", runway.ident, bool(exit_path))
        self.phase = "glide"

    @property
    def waypoints_ahead(self) -> tuple[Any, ...]:
        return ()

    left_route = waypoints_ahead

    def require_side_step(self, runway: RunwayEnd) -> None:
        raise ValueError(f"side_step to runway {runway.ident}; expected a parallel one")

    def approach(
        self,
        runway: RunwayEnd,
        curve: object,
        altitude_m: float,
        exit_path: object,
        **_: object,
    ) -> None:
        self._tell("approach", runway.ident)
        self.phase = "approach"

    def leave_at(self, path: tuple[Any, ...]) -> None:
        self._tell("leave_at", path)

    def go_around(self, climb_to_m: float) -> None:
        self._tell("go_around", round(climb_to_m / FOOT))
        self.phase = "go_around"

    def reject_takeoff(self) -> None:
        self._tell("reject_takeoff")
        self.phase = "rejected_takeoff"

    def hold_position(self) -> None:
        self._tell("hold_position")

    def resume_taxi(self) -> None:
        self._tell("resume_taxi")

    def fly_route(self, places: list[tuple[float, float]]) -> None:
        self._tell("fly_route", len(places))

    def resume_route(self) -> None:
        self._tell("resume_route")

    def hold_track(self, track_rad: float) -> None:
        self._tell("hold_track")

    @property
    def names(self) -> list[object]:
        return [name for name, *_ in self.told]


def crew_of(plane: Any) -> Crew:
    reactions = Reactions(reaction_sigma=0.0)
    return Crew(
        cast(Any, AircraftSpec).model_construct(callsign="AAL1", initial=None, pilot=reactions),
        plane,
        kdca(),
        1,
    )


def tell(crew: Crew, action: str, **arguments: Any) -> None:
    crew.command(COMMAND.validate_python({"action": action, **arguments}))


def at_hold(phase: str = "standing") -> tuple[Plane, Crew]:
    plane = Plane(phase, kdca().airport.hold("01", "A").place)
    return plane, crew_of(plane)


def on_final(distance_m: float, height_m: float = 300.0, **kw: Any) -> Plane:
    place = kdca().place(RunwayPosition(type="runway", runway="01", along_m=-distance_m))
    return Plane("glide", place, height_m, 140.0, **kw)


def approaching(plane: Plane) -> tuple[Plane, Crew]:
    """Return an aircraft that flies the approach to runway 01, and its crew."""
    crew = crew_of(plane)
    crew.runway_operations.begin_on_final("01")
    return plane, crew


def advisory(recommendation: object) -> Advisory:
    return Advisory(
        id="r-1", revision=0, recipient="AAL1", recipients=("AAL1",), kind="runway_conflict",
        severity=Severity.WARNING, traffic=("AAL1", "OPS1"), message="",
        recommendation=recommendation, evidence=Evidence(sources=("adsb",)), t_ready_ns=0,
    )  # fmt: skip


# --- departures -----------------------------------------------------------------------------


def test_from_a_hold_it_lines_up_along_the_way_in() -> None:
    plane, crew = at_hold()
    tell(crew, "line_up", runway="01")
    assert crew.runway_operations.bound_runway == "01"
    ((name, path, then),) = plane.told
    assert (name, then) == ("taxi", "lined_up")
    assert len(path) > 10


def test_cleared_for_takeoff_at_a_hold_it_lines_up_first_and_rolls_then() -> None:
    plane, crew = at_hold()
    tell(crew, "take_off", runway="01", climb_to_ft=4000)
    crew.attend()
    assert plane.names == ["taxi"]
    plane.phase = "lined_up"
    crew.attend()
    crew.attend()
    assert plane.told[1:] == [("take_off", "01", 4000)]


def test_a_takeoff_is_cancelled_before_it_rolls() -> None:
    plane, crew = at_hold()
    tell(crew, "take_off", runway="01")
    tell(crew, "cancel_takeoff")
    plane.phase = "lined_up"
    crew.attend()
    assert "take_off" not in plane.names
    assert plane.names[-1] == "hold_position"


@pytest.mark.parametrize(("speed_kt", "rejects"), [(100.0, True), (133.0, False)])
def test_rolling_it_rejects_below_decision_speed_only(speed_kt: float, rejects: bool) -> None:
    plane = Plane("takeoff_roll", speed_kt=speed_kt)
    assert crew_of(plane).hear(advisory(CancelTakeoff(runway="01"))).act() is rejects
    assert ("reject_takeoff" in plane.names) is rejects


def test_once_it_climbs_out_it_is_bound_for_no_runway() -> None:
    plane, crew = at_hold()
    tell(crew, "line_up", runway="01")
    plane.phase = "climb_out"
    crew.attend()
    assert crew.runway_operations.bound_runway is None


# --- arrivals -------------------------------------------------------------------------------


def test_without_a_landing_clearance_it_goes_around_at_200_ft() -> None:
    plane, crew = approaching(on_final(2_000.0))
    crew.attend()
    assert plane.names == ["land"]
    plane.height_m = 190 * FOOT
    with pytest.raises(Unable, match="no clearance to land: going around"):
        crew.attend()
    assert plane.names == ["land", "go_around"]
    crew.attend()
    assert crew.runway_operations.bound_runway is None


def test_with_one_it_goes_on() -> None:
    plane, crew = approaching(on_final(2_000.0))
    tell(crew, "land", runway="01")
    plane.height_m = 100 * FOOT
    crew.attend()
    assert plane.names == ["land", "land"]
    assert plane.told[1] == ("land", "01", True)


def test_over_a_circuit_it_lands_once_it_is_on_final() -> None:
    away = kdca().place(RunwayPosition(type="runway", runway="01", along_m=0.0, offset_m=-8000.0))
    plane = Plane("en_route", away, 500.0, 200.0, heading_deg=175.0)
    crew = crew_of(plane)
    via = [{"type": "runway", "runway": "01", "along_m": -13_000, "offset_m": 0}]
    tell(crew, "land", runway="01", via=via, vacate=False)
    crew.attend()
    assert plane.told == [("fly_route", 2)]
    final = on_final(10_000.0)
    plane.place, plane.heading_deg = final.place, 350.0
    crew.attend()
    assert plane.told[1:] == [("land", "01", False)]


def test_over_the_threshold_and_far_too_high_it_goes_around() -> None:
    plane, crew = approaching(on_final(4_000.0))
    tell(crew, "land", runway="01")
    plane.place = on_final(-100.0).place
    with pytest.raises(Unable, match="too high over the threshold: going around"):
        crew.attend()
    assert plane.names[-1] == "go_around"


def test_an_advised_go_around_is_flown_and_on_the_ground_it_is_not() -> None:
    flying, landed = on_final(2_000.0), Plane("rollout")
    assert crew_of(flying).hear(advisory(GoAround(runway="01"))).act()
    assert not crew_of(landed).hear(advisory(GoAround(runway="01"))).act()
    assert flying.names == ["go_around"]
    assert landed.names == []


def test_an_exit_that_does_not_exist_is_named_with_those_that_do() -> None:
    with pytest.raises(Unable, match="has no exit Z; there are: B_"):
        tell(crew_of(on_final(5_000.0)), "land", runway="01", exit="Z")


# --- taxiing --------------------------------------------------------------------------------


def test_taxiing_to_a_hold_its_nose_stops_short_of_the_line() -> None:
    plane = Plane(place=kdca().airport.node("gate_b12"))
    hold = {"type": "hold_short", "runway": "01", "taxiway": "E"}
    tell(crew_of(plane), "taxi", to=hold)
    (_, path, _) = plane.told[0]
    frame, line = kdca().airport.local_frame, kdca().airport.hold("01", "E").place
    short = math.dist(frame.to_local(path[-1]), frame.to_local(line))
    assert short == pytest.approx(B737.dimensions.length_m / 2 + 3.0, abs=0.1)


def test_it_holds_its_position_when_advised_and_when_told() -> None:
    plane = Plane("taxi")
    assert crew_of(plane).hear(advisory(HoldPosition(runway="01"))).act()
    tell(crew_of(plane), "hold_position")
    tell(crew_of(plane), "continue")
    assert plane.names == ["hold_position", "hold_position", "resume_taxi"]


def test_what_the_aircraft_cannot_do_is_said_and_does_not_end_the_run() -> None:
    plane = Plane("takeoff_roll", refuses="reject_takeoff")
    with pytest.raises(Unable, match="unable, reject_takeoff in phase takeoff_roll"):
        tell(crew_of(plane), "hold_position")


def test_who_is_told_to_stop_on_the_takeoff_roll_rejects_the_takeoff_or_says_it_is_too_fast() -> (
    None
):
    plane = Plane("takeoff_roll", speed_kt=60.0)
    tell(crew_of(plane), "hold_position")
    assert plane.names == ["reject_takeoff"]
    with pytest.raises(Unable, match="V one"):
        tell(crew_of(Plane("takeoff_roll", speed_kt=160.0)), "hold_position")


# --- what went wrong once, or nearly ----------------------------------------------------------


def test_who_is_unable_to_line_up_is_bound_for_no_runway() -> None:
    crew = crew_of(Plane(place=kdca().airport.node("gate_b12")))
    for action in ("line_up", "take_off"):
        with pytest.raises(Unable):
            tell(crew, action, runway="01")
    assert crew.runway_operations.bound_runway is None


def test_told_on_the_way_to_a_hold_it_lines_up_once_it_stands_there() -> None:
    plane, crew = at_hold("taxi")
    tell(crew, "take_off", runway="01", climb_to_ft=4000)
    crew.attend()
    assert plane.told == []
    assert crew.runway_operations.bound_runway == "01"
    for phase in ("standing", "line_up", "lined_up"):
        plane.phase = phase
        crew.attend()
    assert plane.names == ["taxi", "take_off"]


def test_held_on_its_way_in_and_cleared_again_it_does_not_go_back_to_the_hold() -> None:
    plane, crew = at_hold()
    tell(crew, "take_off", runway="01")
    whole = plane.told[0][1]
    tell(crew, "cancel_takeoff")
    plane.phase, plane.place = "standing", whole[len(whole) // 2]
    plane.heading_deg = 30.0
    tell(crew, "take_off", runway="01")
    assert plane.names == ["taxi", "hold_position", "taxi"]
    again = plane.told[-1][1]
    assert again[-1] == whole[-1]
    assert set(again) < set(whole)
    assert whole[1] not in again


def test_a_cancelled_takeoff_is_not_taken_up_by_itself() -> None:
    plane = Plane("lined_up", kdca().airport.runway("01").start)
    crew = crew_of(plane)
    crew.runway_operations.bind("01")
    tell(crew, "cancel_takeoff")
    crew.attend()
    assert plane.told == []
    tell(crew, "take_off", runway="01")
    assert plane.names == ["take_off"]


def test_there_is_nothing_to_cancel_where_there_is_no_takeoff_to_reject(
    subtests: pytest.Subtests,
) -> None:
    for phase in ["climb_out", "rejected_takeoff", "rotate", "rollout"]:
        with subtests.test(phase):
            plane = Plane(phase)
            assert not crew_of(plane).hear(advisory(CancelTakeoff(runway="01"))).act()
            assert plane.told == []


def test_a_go_around_advised_as_the_wheels_touch_comes_too_late() -> None:
    plane = on_final(-300.0, height_m=0.0, refuses="go_around")
    plane.phase = "flare"
    assert not crew_of(plane).hear(advisory(GoAround(runway="01"))).act()


@pytest.mark.parametrize(("height_ft", "climb_to_ft"), [(300.0, 3_015), (4_500.0, 5_000)])
def test_a_go_around_climbs_from_wherever_it_begins(height_ft: float, climb_to_ft: int) -> None:
    plane = on_final(2_000.0, height_m=height_ft * FOOT)
    assert crew_of(plane).hear(advisory(GoAround(runway="01"))).act()
    assert plane.told == [("go_around", climb_to_ft)]


def test_after_a_go_around_it_needs_another_clearance_to_land() -> None:
    plane, crew = approaching(on_final(2_000.0))
    tell(crew, "land", runway="01")
    tell(crew, "go_around")
    assert crew.runway_operations.bound_runway is None
    plane.phase, plane.told = "glide", []
    crew.runway_operations.begin_on_final("01")
    plane.height_m = 190 * FOOT
    with pytest.raises(Unable):
        crew.attend()
    assert plane.names == ["land", "go_around"]


def test_cleared_to_land_on_another_runway_it_turns_there_or_refuses() -> None:
    plane, crew = approaching(on_final(5_000.0))
    tell(crew, "land", runway="33")
    assert plane.names == ["land", "approach"]
    assert crew.bound_runway == "33"
    plane, crew = approaching(on_final(2_000.0, 100.0))
    with pytest.raises(Unable, match="unable, too low to turn to runway 33"):
        tell(crew, "land", runway="33")
    assert plane.names == ["land"]
    assert crew.bound_runway == "01"


def test_on_the_ground_it_is_unable_to_land() -> None:
    with pytest.raises(Unable, match="on the ground"):
        tell(crew_of(Plane("lined_up")), "land", runway="01")


@pytest.mark.parametrize("command", [{"action": "track", "track_deg": 90}])
def test_who_leaves_an_approach_is_bound_for_no_runway(command: dict[str, Any]) -> None:
    plane, crew = approaching(on_final(5_000.0))
    tell(crew, **command)
    plane.phase = "en_route"
    crew.attend()
    assert crew.runway_operations.bound_runway is None
    plane.height_m = 150 * FOOT
    crew.attend()
    assert plane.names == ["land", "hold_track"]


@pytest.mark.parametrize(
    ("phase", "advice"),
    [("lined_up", CancelTakeoff(runway="01")), ("standing", HoldPosition(runway="01"))],
)
def test_a_clearance_that_was_taken_before_a_warning_is_not_acted_upon_until_it_is_over(
    phase: str, advice: Any
) -> None:
    crew = crew_of(Plane(phase, kdca().airport.hold("01", "A").place))
    crew.hear(advisory(advice)).act()
    with pytest.raises(Unable, match="holding because of a warning"):
        tell(crew, "take_off", runway="01")
    crew.hear(advisory(advice).model_copy(update={"active": False}))
    assert crew.refusal(COMMAND.validate_python({"action": "continue"})) is None


def test_an_advice_to_hold_position_does_not_make_who_flies_forget_to_land() -> None:
    away = kdca().place(RunwayPosition(type="runway", runway="01", along_m=0.0, offset_m=-8000.0))
    plane = Plane("en_route", away, 500.0, 200.0, heading_deg=175.0)
    crew = crew_of(plane)
    tell(crew, "land", runway="01", via=[{"type": "runway", "runway": "01", "along_m": -13_000}])
    assert not crew.hear(advisory(HoldPosition(runway="01"))).act()
    plane.place, plane.heading_deg = on_final(10_000.0).place, 355.0
    crew.attend()
    assert plane.names == ["fly_route", "land"]


def test_cleared_to_land_it_joins_the_final_approach_or_waits_until_it_can_or_turns_there(
    subtests: pytest.Subtests,
) -> None:
    for away_m, right_m, heading_deg, does in [
        (10_000.0, 0.0, 355.5, ["land"]),
        (10_000.0, 0.0, 33.0, ["land"]),
        (10_000.0, 0.0, 37.0, ["approach"]),
        (10_000.0, 900.0, 340.0, ["land"]),
        (10_000.0, 950.0, 340.0, []),
        (10_000.0, 0.0, 175.5, ["approach"]),
        (-100.0, 0.0, 355.5, ["approach"]),
    ]:
        with subtests.test(str((away_m, right_m, heading_deg))):
            place = kdca().place(
                RunwayPosition(type="runway", runway="01", along_m=-away_m, offset_m=right_m)
            )
            plane = Plane("en_route", place, 500.0, 150.0, heading_deg)
            crew = crew_of(plane)
            tell(crew, "land", runway="01")
            assert plane.names == does
            assert crew.runway_operations.bound_runway == "01"


# --- what is refused, in every phase ----------------------------------------------------------

ON_THE_GROUND = ("standing", "taxi", "line_up", "lined_up", "takeoff_roll", "rejected_takeoff",
                 "rollout", "vacate")  # fmt: skip
IN_THE_AIR = ("rotate", "climb_out", "en_route", "glide", "flare", "go_around")
GROUND_COMMANDS: tuple[dict[str, Any], ...] = (
    {"action": "taxi", "to": {"type": "node", "node": "gate_a2"}},
    {"action": "taxi_to", "runway": "33"},
    {"action": "taxi_to", "place": "gate a2"},
    {"action": "hold_position"},
    {"action": "hold_short", "runway": "33"},
    {"action": "hold_short", "taxiway": "E"},
    {"action": "cross", "runway": "01"},
    {"action": "cross"},
    {"action": "enter", "runway": "01"},
    {"action": "vacate", "exit": "E"},
    {"action": "backtrack", "runway": "01"},
    {"action": "give_way", "to": "cessna"},
    {"action": "push_back"},
    {"action": "line_up", "runway": "01"},
    {"action": "line_up", "runway": "33"},
    {"action": "take_off", "runway": "01"},
    {"action": "cancel_takeoff"},
    {"action": "behind", "whom": "landing cessna", "command": {"action": "cross"}},
)


@pytest.mark.parametrize("phase", [*ON_THE_GROUND, *IN_THE_AIR])
def test_a_command_is_refused_before_anything_changes_or_it_is_carried_out(
    phase: str, subtests: pytest.Subtests
) -> None:
    height_m = 0.0 if phase in ON_THE_GROUND else 100.0
    for given in GROUND_COMMANDS:
        with subtests.test(given["action"]):
            plane = Plane(phase, kdca().airport.hold("01", "A").place, height_m, 20.0)
            crew, command = crew_of(plane), COMMAND.validate_python(given)
            why = crew.refusal(command)
            assert plane.told == []
            if why is None:
                crew.command(command)
                continue
            assert why.startswith(("unable", "say again"))
            with pytest.raises(Unable) as refused:
                crew.command(command)
            assert str(refused.value) == why


@pytest.mark.parametrize("phase", IN_THE_AIR)
def test_in_the_air_nothing_is_done_that_belongs_on_the_ground(phase: str) -> None:
    plane = Plane(phase, kdca().airport.hold("01", "A").place, 100.0, 120.0)
    crew = crew_of(plane)
    for given in GROUND_COMMANDS:
        why = crew.refusal(COMMAND.validate_python(given))
        assert why is not None, given
        assert "airborne" in why or "rolling" in why or "not in sight" in why, (given, why)


def test_a_takeoff_is_stopped_at_once_below_the_decision_speed_and_refused_above_it() -> None:
    for action in ("cancel_takeoff", "hold_position"):
        slow, fast = Plane("takeoff_roll", speed_kt=60.0), Plane("takeoff_roll", speed_kt=133.0)
        tell(crew_of(slow), action)
        assert slow.names == ["reject_takeoff"]
        with pytest.raises(Unable, match="unable, above V one"):
            tell(crew_of(fast), action)
        assert fast.told == []


@pytest.mark.parametrize("action", ["line_up", "take_off"])
def test_on_a_runway_it_uses_no_other_one(action: str) -> None:
    plane, crew = at_hold()
    tell(crew, "line_up", runway="01")
    for phase in ("line_up", "lined_up"):
        plane.phase = phase
        with pytest.raises(Unable, match="unable, lined up on runway 01"):
            tell(crew, action, runway="19")
    assert crew.bound_runway == "01"


def test_it_does_not_line_up_beyond_a_runway_that_it_may_not_cross() -> None:
    plane = Plane(place=kdca().airport.node("K/gate_b12"), heading_deg=175.0)
    with pytest.raises(Unable, match="unable, runway 04 is on our way"):
        tell(crew_of(plane), "line_up", runway="01")
    assert plane.told == []


def test_it_taxies_to_the_holding_position_and_lines_up_there() -> None:
    plane = Plane(place=kdca().airport.node("J/B"), heading_deg=185.0)
    crew = crew_of(plane)
    tell(crew, "line_up", runway="01")
    (_, path, then), *more = plane.told
    assert (then, more) == ("standing", [])
    plane.phase, plane.place, plane.heading_deg = "standing", path[-1], 85.0
    for _ in range(3):
        crew.attend()
    assert plane.told[-1][2] == "lined_up"


# --- the way off the runway -------------------------------------------------------------------


def landing(phase: str, at_m: float, speed_kt: float, height_m: float = 0.0) -> tuple[Plane, Crew]:
    plane = on_final(-at_m, height_m)
    plane.phase, plane.speed_kt = phase, speed_kt
    crew = crew_of(plane)
    crew.runway_operations.bind("01")
    return plane, crew


def test_it_leaves_by_the_exit_that_it_is_told_on_final_and_while_it_rolls() -> None:
    for phase, at_m, speed_kt, height_m in [
        ("glide", -4_000.0, 135.0, 200.0),
        ("rollout", 700.0, 100.0, 0.0),
    ]:
        plane, crew = landing(phase, at_m, speed_kt, height_m)
        tell(crew, "vacate", exit="N")
        assert plane.told == [("leave_at", exit_path("N"))]


def exit_path(name: str) -> tuple[tuple[float, float], ...]:
    (way,) = (each for each in kdca().airport.exits("01") if each.taxiway == name)
    return way.path


@pytest.mark.parametrize(
    ("told", "why"),
    [
        ({"exit": "D"}, "unable, past D"),
        ({"exit": "E"}, "unable, too fast for E"),
        ({"exit": "G"}, "unable, runway 01 has no exit G"),
        ({"exit": "Q"}, "unable, no taxiway Q at KDCA"),
    ],
)
def test_an_exit_that_it_cannot_make_is_refused(told: dict[str, str], why: str) -> None:
    plane, crew = landing("rollout", 900.0, 100.0)
    with pytest.raises(Unable, match=why):
        tell(crew, "vacate", **told)
    assert plane.told == []


def test_an_exit_told_before_the_final_approach_is_used_after_it() -> None:
    away = kdca().place(RunwayPosition(type="runway", runway="01", along_m=0.0, offset_m=-8000.0))
    plane = Plane("en_route", away, 500.0, 200.0, heading_deg=175.0)
    crew = crew_of(plane)
    via = [{"type": "runway", "runway": "01", "along_m": -13_000}]
    tell(crew, "land", runway="01", via=via, vacate=False)
    tell(crew, "vacate", exit="N")
    plane.place, plane.heading_deg = on_final(10_000.0).place, 355.0
    crew.attend()
    assert plane.told[1:] == [("land", "01", True)]


def test_a_taxi_clearance_during_the_landing_roll_is_followed_after_the_runway_is_left() -> None:
    plane, crew = landing("rollout", 900.0, 60.0)
    tell(crew, "taxi_to", place="gate a2")
    crew.attend()
    assert plane.told == []
    plane.phase, plane.place = "standing", exit_path("N")[-1]
    crew.attend()
    assert plane.names == ["taxi"]
