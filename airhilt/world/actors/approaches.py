"""Approaches of a crew: which way it flies to a runway, and from where it cannot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from airhilt.commands import (
    ApproachCommand,
    CancelLandingCommand,
    CircuitLeg,
    Command,
    ExtendCommand,
    GoAroundCommand,
    JoinCommand,
    LandCommand,
    ReturnToFieldCommand,
    ShortApproachCommand,
    Side,
    SideStepCommand,
)
from airhilt.geodesy.wgs84 import Place, distance_m
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE
from airhilt.world.actors.actor import Act, Unable, do_nothing
from airhilt.world.actors.circuit import (
    SETTLE_S,
    STABLE_CIRCLING_FT,
    STABLE_FT,
    Circuit,
    circuit_height_m,
    gate_m,
    joined,
    last_radius_m,
    radius_now_m,
    to_threshold,
)
from airhilt.world.actors.final_approach import FinalApproach
from airhilt.world.actors.runway_operations import (
    APPROACHING,
    CAPTURE_ANGLE_RAD,
    CAPTURE_DISTANCE_M,
    RunwayOperations,
)
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.curves import Curve, Piece, Pose, length_m, turning_rad
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.runway import RunwayEnd

CIRCLING_FT = ((91.0, 350.0), (121.0, 450.0), (141.0, 450.0))
"""Least heights of a circling approach, in ft, below approach speeds in kt (FAA Order 8260.3, table
of circling minimums); `FASTEST_CIRCLING_FT` from the last speed on."""
FASTEST_CIRCLING_FT = 550.0
LONG_FINAL_M = 5.0 * NAUTICAL_MILE
"""Distance from the threshold at which a straight-in approach joins the final course, where the
aircraft is not nearer, in m; assumed: about that of a final approach fix."""
LONGEST_FINAL_M = 12.0 * NAUTICAL_MILE
"""Greatest distance from the threshold at which the final course is joined to lose height, in m;
assumed."""
GATE_STEP_M = 0.5 * NAUTICAL_MILE
"""Step in which the final is lengthened until the descent is not too steep, in m."""
STEEPEST_RAD = 3.8 * DEGREE
"""Greatest mean angle of descent on the way to a runway, in rad; assumed: the correction to the
glide path on top of its 3 degrees."""
SHARPEST_RAD = 300.0 * DEGREE
"""Greatest sum of the turns from one approach to another runway, in rad: to the opposite direction
it takes about 240 degrees, a loop more than 360; assumed."""
GREATEST_SIDE_STEP_RAD = 90.0 * DEGREE
"""Greatest angle between two runways from one of which a crew side-steps to the other; assumed. The
manuals have parallel runways alone (FAA Aeronautical Information Manual, 5-4-19)."""
LEVEL_M = 200.0 * FOOT
"""Distance in m from a level within which it is flown (AIM 4-5-2)."""
NEAR_M = 20.0 * NAUTICAL_MILE
"""Distance from the runway within which the way to it is planned, in m; before, the aircraft flies
straight to it."""
ARRIVAL_HEIGHT_M = 3000.0 * FOOT
"""Height above the airport that it descends to on that way, in m; assumed."""
LAST_TURN_FT = 400.0
"""Height in ft below which no turn begins (14 CFR 25.111(c)(4), for takeoffs)."""
GO_AGAIN_PART = 0.8
"""Least speed after touchdown to go around from, as a part of the rotation speed; assumed: the
brakes and reversers are not yet at work."""


class JoinedCircuit:
    """A circuit, the curve on which it is flown, and a pose on each leg from where it is joined."""

    def __init__(self, circuit: Circuit, curve: Curve, poses: Mapping[CircuitLeg, Pose]) -> None:
        self.circuit = circuit
        self._curve = curve
        self._poses = poses

    @property
    def leg(self) -> CircuitLeg | None:
        """Leg on which the last pose was passed; None before the first."""
        passed = [leg for leg, pose in self._poses.items() if self._curve.has_passed(pose)]
        return passed[-1] if passed else None

    def poses_before(self, leg: CircuitLeg) -> list[Pose]:
        """Return the poses ahead up to that on a leg; none if it has been passed."""
        if leg not in self._poses or self._curve.has_passed(self._poses[leg]):
            return []
        upto = list(self._poses)[: list(self._poses).index(leg) + 1]
        return [self._poses[each] for each in upto if not self._curve.has_passed(self._poses[each])]


class Approaches:
    """Carries out the commands of one crew about the way to a runway.

    `plan` says what a command will do, or raises `Unable`; nothing changes before it is done.
    """

    def __init__(self, aircraft: Aircraft, site: ScenarioSite, runways: RunwayOperations) -> None:
        self._aircraft = aircraft
        self._site = site
        self._runways = runways
        self._joined: JoinedCircuit | None = None
        """Circuit that is flown, or one of whose legs is extended."""
        self._used: str | None = None
        """Runway that was used last."""

    def plan(self, command: Command) -> Act | None:
        """Return what carries out a command; None for one that is not about an approach."""
        self._used = self._runways.bound_runway or self._used
        match command:
            case ApproachCommand(runway=runway, kind=kind, level_ft=level_ft):
                return self._plan_approach(self._site.runway(runway), kind, level_ft)
            case SideStepCommand(runway=runway):
                return self._plan_side_step(self._site.runway(runway))
            case LandCommand():
                return self._plan_landing(command)
            case CancelLandingCommand():
                return self._runways.plan_without_clearance()
            case JoinCommand():
                return self._plan_join(command)
            case ExtendCommand(leg=leg):
                return self._plan_extension(leg)
            case ShortApproachCommand():
                return self._plan_short_approach()
            case ReturnToFieldCommand():
                return self._plan_return()
            case GoAroundCommand(climb_to_ft=altitude_ft):
                return self._plan_go_around(altitude_ft * FOOT)
        return None

    # --- to land ------------------------------------------------------------------------------

    def _plan_landing(self, command: LandCommand) -> Act:
        runways, end = self._runways, self._site.runway(command.runway)
        if command.via:
            return runways.plan_landing(command)
        is_bound = runways.bound_runway in (None, end.ident)
        if self._phase in ("approach", "orbit", "flare") and is_bound:
            return runways.plan_leaving(command)
        if self._phase in ("glide", "flare") and is_bound:
            return runways.plan_landing(command)
        if self._phase not in APPROACHING and self._leads_to(end):
            return runways.plan_landing(command)
        if self._is_extended and is_bound:
            return runways.plan_clearance(command)
        take, fly = runways.plan_clearance(command), self._plan_other(end, command.level_ft)

        def fly_and_land() -> None:
            take()
            fly()

        return fly_and_land

    def _leads_to(self, end: RunwayEnd) -> bool:
        """Return whether the track or the route that is flown leads to a final approach."""
        final, here, state = self._final(end), self._here, self._aircraft.state
        if final.before_m(here) <= 0.0:
            return False
        route = self._aircraft.en_route.waypoints_ahead
        if route:
            return any(
                final.before_m(place) > -1.0 and abs(final.right_m(place)) < CAPTURE_DISTANCE_M
                for place in route
            )
        angle, right_m = final.angle_rad(state.track_rad), final.right_m(here)
        if abs(angle) > CAPTURE_ANGLE_RAD or abs(right_m) < CAPTURE_DISTANCE_M:
            return abs(angle) <= CAPTURE_ANGLE_RAD
        if right_m * angle >= 0.0:
            return False
        beyond_m = abs(right_m) / math.tan(abs(angle))
        return final.before_m(here) - beyond_m > self._gate_m(final, STABLE_FT)

    def _plan_side_step(self, end: RunwayEnd) -> Act:
        final = self._runways.final
        if final is not None and abs(final.angle_rad(end.course_rad)) > GREATEST_SIDE_STEP_RAD:
            raise Unable(f"unable, runway {end.ident} is no side step from {final.runway.ident}")
        return self._plan_other(end)

    def _plan_other(self, end: RunwayEnd, level_ft: float | None = None) -> Act:
        """Return what goes to another runway: a side-step if one is possible, or a turn."""
        if self._phase == "flare":
            raise Unable(f"unable, landing on runway {self._runways.bound_runway}")
        if self._phase == "glide":
            try:
                self._aircraft.procedures.require_side_step(end)
            except ValueError:
                return self._plan_approach(end, "circling")
            return partial(
                self._runways.begin_approach, end.ident, self._aircraft.procedures.side_step
            )
        return self._plan_approach(end, "visual", level_ft)

    def _plan_approach(self, end: RunwayEnd, kind: str, level_ft: float | None = None) -> Act:
        if self._phase == "flare":
            raise Unable(f"unable, landing on runway {self._runways.bound_runway}")
        if self._phase == "glide" and self._runways.bound_runway == end.ident:
            return do_nothing
        if kind == "straight_in" and level_ft is not None and self._intercepts(end, level_ft):
            return partial(self._runways.intercept, end.ident)
        if kind == "circling" and self._phase in APPROACHING:
            lowest_ft = self._circling_ft()
            if self._height_ft < lowest_ft:
                raise Unable(f"unable, too low to turn to runway {end.ident}")
            return self._plan_way(end, STABLE_CIRCLING_FT, SHARPEST_RAD)
        return self._plan_way(end, STABLE_FT, is_long=kind == "straight_in", level_ft=level_ft)

    def _intercepts(self, end: RunwayEnd, level_ft: float) -> bool:
        """Return whether the track leads to the final course where the glide path is above a level.

        The aircraft is at the level, or comes down to it on the way there.
        """
        if self._phase in APPROACHING or not self._leads_to(end):
            return False
        final, slope = self._final(end), math.tan(end.glide_path_rad)
        along_m, angle = final.before_m(self._here), final.angle_rad(self._aircraft.state.track_rad)
        if abs(final.right_m(self._here)) > CAPTURE_DISTANCE_M:
            along_m -= abs(final.right_m(self._here)) / math.tan(abs(angle))
        flown_m = final.before_m(self._here) - along_m
        level_m = level_ft * FOOT
        is_low = self._aircraft.state.altitude_m - level_m < slope * flown_m + LEVEL_M
        return is_low and level_m - end.elevation_m < slope * min(along_m, LONGEST_FINAL_M)

    # --- the way ------------------------------------------------------------------------------

    def _plan_way(
        self,
        end: RunwayEnd,
        stable_ft: float,
        sharpest_rad: float = math.inf,
        *,
        is_long: bool = False,
        level_ft: float | None = None,
    ) -> Act:
        """Return what flies the shortest way to the final approach of a runway.

        It is joined where the glide path is above a level in ft.
        """
        self._require_height()
        final, state, kind = self._final(end), self._aircraft.state, self._aircraft.kind
        if distance_m(self._here, end.threshold) > NEAR_M:
            return partial(self._go_there, final, level_ft)
        least_m = self._gate_m(final, stable_ft)
        if is_long:
            ahead_m = final.before_m(self._here) - radius_now_m(kind, state)
            least_m = max(least_m, min(LONG_FINAL_M, ahead_m))
        least_m = max(least_m, self._joined_m(end, level_ft))
        for longer_m in _longer_m(LONGEST_FINAL_M - least_m):
            gate = final.pose(least_m + longer_m)
            way = joined([self._pose, gate], radius_now_m(kind, state), last_radius_m(kind, state))
            if turning_rad(way) > sharpest_rad:
                continue
            curve = to_threshold(final, way, gate)
            if self._descends_well(end, curve):
                return self._flown(end, curve, level_ft=level_ft)
        if sharpest_rad < math.inf:
            raise Unable(f"unable, too close to turn to runway {end.ident}")
        raise Unable(f"unable, too high for runway {end.ident}")

    def _joined_m(self, end: RunwayEnd, level_ft: float | None) -> float:
        """Return how far before the threshold a final approach is joined at a level."""
        if level_ft is None:
            return 0.0
        glide_m = (level_ft * FOOT - end.elevation_m) / math.tan(end.glide_path_rad)
        if glide_m > LONGEST_FINAL_M:
            raise Unable(f"unable {level_ft:g} ft until final on runway {end.ident}")
        return glide_m + SETTLE_S * self._aircraft.kind.speeds.minimum_clean_kt * KNOT

    def _descends_well(self, end: RunwayEnd, curve: Sequence[Piece]) -> bool:
        height_m = self._aircraft.state.altitude_m - end.elevation_m
        return height_m < math.tan(STEEPEST_RAD) * length_m(curve)

    def _through(self, *poses: Pose) -> tuple[Piece, ...]:
        """Return the shortest curve from here through poses."""
        state, kind = self._aircraft.state, self._aircraft.kind
        return joined([self._pose, *poses], radius_now_m(kind, state), last_radius_m(kind, state))

    def _flown(
        self,
        end: RunwayEnd,
        pieces: Sequence[Piece],
        circuit: Circuit | None = None,
        poses: Mapping[CircuitLeg, Pose] | None = None,
        level_ft: float | None = None,
    ) -> Act:
        """Return what flies a curve to a runway, at a level, its circuit's height, or below that.

        The circuit is that of which the curve is a part, with its poses on the legs.
        """
        height_m = circuit_height_m(self._aircraft.kind)
        lowest_m = self._circling_ft() * FOOT
        level_m = max(min(self._height_ft * FOOT, height_m), lowest_m) + end.elevation_m
        level_m = level_m if level_ft is None else level_ft * FOOT
        curve = Curve(self._site.airport.local_frame, pieces)
        flown = None if circuit is None else JoinedCircuit(circuit, curve, poses or {})

        def fly(runway: RunwayEnd, exit_path: Sequence[Place]) -> None:
            self._aircraft.procedures.approach(
                runway, curve, level_m, exit_path, keeps_level=level_ft is not None
            )
            self._joined = flown

        return partial(self._runways.begin_approach, end.ident, fly)

    def _go_there(self, final: FinalApproach, level_ft: float | None) -> None:
        """Fly straight to a runway that is far away, and plan the way there once it is near."""
        end = final.runway
        self._runways.bind(end.ident)
        self._aircraft.en_route.fly_route([end.threshold])
        self._runways.wait(partial(self._approach_once_near, end, level_ft))

    def _approach_once_near(self, end: RunwayEnd, level_ft: float | None) -> bool:
        away_m = distance_m(self._here, end.threshold)
        lowest_m = end.elevation_m + ARRIVAL_HEIGHT_M if level_ft is None else level_ft * FOOT
        above_m = self._aircraft.state.altitude_m - lowest_m
        is_due = above_m > math.tan(end.glide_path_rad) * (away_m - NEAR_M)
        if is_due and self._aircraft.target_altitude_m > lowest_m:
            self._aircraft.en_route.hold_altitude(lowest_m)
        if away_m > NEAR_M:
            return False
        self._plan_way(end, STABLE_FT, level_ft=level_ft)()
        return True

    # --- the circuit --------------------------------------------------------------------------

    def _plan_join(self, command: JoinCommand) -> Act:
        self._require_height()
        end, state, kind = (
            self._site.runway(command.runway),
            self._aircraft.state,
            self._aircraft.kind,
        )
        if self._phase in ("glide", "flare") and command.leg == "final":
            return self._plan_approach(end, "visual")
        if self._phase == "flare":
            raise Unable(f"unable, landing on runway {self._runways.bound_runway}")
        final = self._final(end)
        if distance_m(self._here, end.threshold) > NEAR_M:
            return partial(self._go_there, final, command.level_ft)
        circuit = self._circuit(final, command.side)
        if command.leg == "base" and circuit.is_on("downwind", self._here, state.track_rad):
            circuit = Circuit(final, kind, circuit.side, state, STABLE_CIRCLING_FT)
        nearest = circuit.poses(command.leg, self._here, state.track_rad)
        gate = final.before_m(self._site.airport.local_frame.to_place(*nearest["final"][:2]))
        nearest = _farther(nearest, max(self._joined_m(end, command.level_ft) - gate, 0.0))
        # A straight-in approach goes straight in, or not at all.
        for longer_m in _longer_m(0.0 if command.leg == "final" else LONGEST_FINAL_M):
            poses = _farther(nearest, longer_m)
            curve = to_threshold(final, self._through(*poses.values()), poses["final"])
            if self._descends_well(end, curve):
                return self._flown(end, curve, circuit, poses, command.level_ft)
        raise Unable(f"unable, too high for the circuit of runway {end.ident}")

    def _circuit(self, final: FinalApproach, side: Side | None) -> Circuit:
        """Return the circuit to a side, or to that on which the aircraft flies already, or left."""
        state, kind, flown = self._aircraft.state, self._aircraft.kind, self._joined
        if side is None and flown is not None and flown.circuit.final.runway == final.runway:
            side = flown.circuit.side
        left, right = Circuit(final, kind, "left", state), Circuit(final, kind, "right", state)
        legs: tuple[CircuitLeg, ...] = ("crosswind", "downwind", "base")
        is_right = any(right.is_on(leg, self._here, state.track_rad) for leg in legs)
        return right if side == "right" or (side is None and is_right) else left

    def _plan_extension(self, leg: CircuitLeg) -> Act:
        joined_circuit = self._require_circuit()
        circuit, on = joined_circuit.circuit, self._on_leg(joined_circuit)
        left = joined_circuit.poses_before(leg)
        is_along = circuit.is_on(leg, self._here, self._aircraft.state.track_rad)
        if self._phase == "glide" or leg in ("base", "final") or (on == leg and not is_along):
            raise Unable(f"unable, turning {'final' if self._phase == 'glide' else 'base'}")
        if on != leg and not left and not is_along:
            raise Unable(f"unable, on {on}")
        way = () if on == leg or is_along else self._through(*left)
        end, kind = circuit.final.runway, self._aircraft.kind
        altitude_m = end.elevation_m + max(circuit_height_m(kind), self._circling_ft() * FOOT)

        def extend() -> None:
            if way:
                curve = Curve(self._site.airport.local_frame, way)
                self._aircraft.en_route.fly_curve(curve)
            else:
                self._aircraft.en_route.hold_track(circuit.course_rad(leg))
            self._aircraft.en_route.hold_altitude(altitude_m)
            self._runways.bind(end.ident)
            self._runways.wait(_never)

        return extend

    def _plan_short_approach(self) -> Act:
        """Return what turns in directly, or by a base leg that is nearer than usual."""
        circuit = self._require_circuit().circuit
        if self._phase == "glide":
            raise Unable("unable, on final")
        state, final = self._aircraft.state, circuit.final
        near = Circuit(final, self._aircraft.kind, circuit.side, state, STABLE_CIRCLING_FT)
        poses = near.poses("base", self._here, state.track_rad)
        gate = final.pose(self._gate_m(final, STABLE_CIRCLING_FT))
        ways = (
            to_threshold(final, self._through(gate), gate),
            to_threshold(final, self._through(*poses.values()), poses["final"]),
        )
        good = [way for way in ways if self._descends_well(final.runway, way)]
        if not good:
            raise Unable("unable, too high for a short approach")
        return self._flown(final.runway, min(good, key=length_m))

    @property
    def _is_extended(self) -> bool:
        is_bound = self._runways.bound_runway is not None
        return self._joined is not None and self._phase == "en_route" and is_bound

    def _on_leg(self, joined_circuit: JoinedCircuit) -> str:
        """Return the leg of a circuit that is flown, in words."""
        if self._phase == "glide":
            return "final"
        state, circuit = self._aircraft.state, joined_circuit.circuit
        if self._is_extended:
            legs: tuple[CircuitLeg, ...] = ("downwind", "crosswind", "upwind")
            on = (leg for leg in legs if circuit.is_on(leg, self._here, state.track_rad))
            return next(on, "our way to the circuit")
        return joined_circuit.leg or "our way to the circuit"

    def _require_circuit(self) -> JoinedCircuit:
        """Return the circuit that is flown, or raise `Unable`."""
        flown = self._joined
        is_flown = self._phase in APPROACHING or self._is_extended
        if flown is None or not is_flown:
            raise Unable("unable, not in the circuit")
        if flown.circuit.final.runway.ident != self._runways.bound_runway:
            raise Unable("unable, not in the circuit")
        return flown

    # --- back, and around ---------------------------------------------------------------------

    def _plan_return(self) -> Act:
        if self._phase in APPROACHING:
            return do_nothing
        if self._used is not None:
            return self._plan_approach(self._site.runway(self._used), "visual")
        airport = self._site.airport
        names = [end.ident for strip in airport.strips.values() for end in strip.ends]
        ends = [self._site.runway(name) for name in names]
        longest_m = max(end.length_m - end.displaced_m for end in ends)
        long = [end for end in ends if end.length_m - end.displaced_m > 0.9 * longest_m]
        kind, state = self._aircraft.kind, self._aircraft.state
        radii = radius_now_m(kind, state), last_radius_m(kind, state)
        nearest = min(
            long,
            key=lambda end: length_m(
                joined([self._pose, self._final(end).pose(LONG_FINAL_M)], *radii)
            ),
        )
        return self._plan_approach(nearest, "visual")

    def _plan_go_around(self, climb_to_m: float) -> Act:
        aircraft, runways = self._aircraft, self._runways
        if self._phase == "rollout":
            return self._plan_balked_landing(climb_to_m)
        is_above = climb_to_m > aircraft.state.altitude_m
        to_m = climb_to_m if is_above else runways.usual_climb_m()
        if runways.is_arriving:
            return partial(runways.break_off, to_m)
        if self._phase == "go_around" or runways.bound_runway is not None:

            def climb() -> None:
                aircraft.en_route.hold_altitude(to_m)
                runways.leave()

            return climb
        raise Unable("unable, not on an approach")

    def _plan_balked_landing(self, climb_to_m: float) -> Act:
        aircraft, final, speed_m_s = self._aircraft, self._runways.final, self._speed_m_s
        rotate_m_s = aircraft.kind.speeds.rotate_kt * KNOT
        if final is None or speed_m_s < GO_AGAIN_PART * rotate_m_s:
            raise Unable("unable, already on the runway")
        left_m = final.runway.length_m - final.runway.displaced_m + final.before_m(self._here)
        if self._runways.takeoff_roll_m(speed_m_s) > left_m:
            raise Unable("unable, not enough runway left")

        def climb() -> None:
            aircraft.procedures.take_off_again(max(climb_to_m, self._runways.usual_climb_m()))

        return climb

    # --- where it is --------------------------------------------------------------------------

    @property
    def _phase(self) -> str:
        return self._aircraft.phase

    @property
    def _here(self) -> Place:
        state = self._aircraft.state
        return state.latitude_rad, state.longitude_rad

    @property
    def _pose(self) -> Pose:
        east, north = self._site.airport.local_frame.to_local(self._here)
        return Pose(east, north, self._aircraft.state.track_rad)

    @property
    def _speed_m_s(self) -> float:
        return self._aircraft.state.calibrated_airspeed_m_s

    @property
    def _height_ft(self) -> float:
        return self._aircraft.state.height_agl_m / FOOT

    def _final(self, end: RunwayEnd) -> FinalApproach:
        return FinalApproach(self._site.airport, end)

    def _gate_m(self, final: FinalApproach, stable_ft: float) -> float:
        return gate_m(self._aircraft.kind, final, stable_ft)

    def _circling_ft(self) -> float:
        approach_kt = self._aircraft.kind.speeds.approach_kt
        return next((ft for kt, ft in CIRCLING_FT if approach_kt < kt), FASTEST_CIRCLING_FT)

    def _require_height(self) -> None:
        if self._height_ft < LAST_TURN_FT:
            raise Unable("unable, too low to turn")


def _longer_m(most_m: float) -> Iterator[float]:
    """Yield by how much a final approach is longer than the shortest, from 0 on."""
    steps = math.ceil(max(most_m, 0.0) / GATE_STEP_M)
    yield from (step * GATE_STEP_M for step in range(steps + 1))


def _farther(poses: Mapping[CircuitLeg, Pose], longer_m: float) -> dict[CircuitLeg, Pose]:
    """Return poses on the legs of a circuit with base and final so much farther out."""
    course_rad = poses["final"].course_rad
    east_m, north_m = longer_m * math.sin(course_rad), longer_m * math.cos(course_rad)
    return {
        leg: Pose(pose.east_m - east_m, pose.north_m - north_m, pose.course_rad)
        if leg in ("base", "final")
        else pose
        for leg, pose in poses.items()
    }


def _never() -> bool:
    """Wait until told otherwise."""
    return False
