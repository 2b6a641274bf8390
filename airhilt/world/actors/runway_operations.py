"""Runway operations of a crew: its landing clearance, the landing, the way off, the go-around."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from airhilt.commands import (
    Command,
    HoldShortCommand,
    LandCommand,
    TurnAtCommand,
    VacateCommand,
)
from airhilt.geodesy.wgs84 import Place
from airhilt.units import FOOT, KNOT, NAUTICAL_MILE
from airhilt.world.actors.actor import Act, Unable
from airhilt.world.actors.final_approach import FinalApproach
from airhilt.world.actors.taxi_paths import (
    BRAKING_M_S2,
    EXIT_SPEED_M_S,
    FIRM_BRAKING_M_S2,
    TOUCHDOWN_M,
    exit_for,
    exits_named,
    path_short_of,
    stays_short_of,
)
from airhilt.world.actors.traffic import Traffic
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.following import TrackPhase
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.runway import RunwayEnd

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Exit

DECISION_HEIGHT_M = 200.0 * FOOT
"""Height in m at which a crew without a landing clearance goes around (category I minimum)."""
GO_AROUND_CLIMB_M = 3000.0 * FOOT
"""Height above the airport that a go-around climbs to by default, in m."""
LEAST_CLIMB_M = 500.0 * FOOT
"""Least climb of a go-around that begins above that, in m."""
TOO_HIGH_M = 150.0 * FOOT
"""Height over the threshold from which a landing is broken off, in m. The normal height is 50 ft
(ICAO Annex 10 volume I, 3.1.5.1.4)."""
LOW_APPROACH_M = 100.0 * FOOT
"""Height in m from which a low approach climbs away; assumed."""
SINKS_M = 60.0 * FOOT
"""Height in m that a go-around loses at most before it climbs; assumed."""
TAKEOFF_M_S2 = 1.5
"""Acceleration of a takeoff roll, in m/s2; assumed: less than that of each type that ships."""
GO_AGAIN_S = 3.0
"""Time between the touchdown and the takeoff thrust of a touch-and-go, in s; assumed."""
ROTATE_S = 3.0
"""Time from rotation speed until the wheels leave the runway, in s; assumed."""
APPROACHING = ("approach", "orbit", "glide", "flare")
"""Phases in which an approach is flown."""
CAPTURE_ANGLE_RAD = math.radians(40.0)
"""Greatest angle to the final approach course at which it is joined, in rad."""
CAPTURE_DISTANCE_M = 0.5 * NAUTICAL_MILE
"""Greatest distance from the extended centre line at which the final approach is joined, in m."""


class RunwayOperations:
    """Lands on the runway that one crew is bound for if it is cleared, and goes around if not.

    `Approaches` says which way it flies there. What cannot be carried out raises Unable, ValueError
    or ScenarioError.
    """

    def __init__(self, aircraft: Aircraft, site: ScenarioSite, traffic: Traffic) -> None:
        self._final: FinalApproach | None = None
        """Final approach of the runway that the crew is going to use."""
        self._aircraft = aircraft
        self._site = site
        self._traffic = traffic
        self._cleared: LandCommand | None = None
        """Landing clearance."""
        self._exit_path: Sequence[Place] = ()
        """Way off the runway after the landing."""
        self._next: Callable[[], bool] | None = None
        """Next step, tried several times a second until it returns True."""

    @property
    def bound_runway(self) -> str | None:
        """Runway that the crew is going to use, in the direction of use.

        None before it has one, and after it has left it.
        """
        return None if self._final is None else self._final.runway.ident

    @property
    def final(self) -> FinalApproach | None:
        """Final approach of that runway."""
        return self._final

    def bind(self, runway: str) -> RunwayEnd:
        """Set the runway that the crew is going to use; return it."""
        end = self._site.runway(runway)
        self._final = FinalApproach(self._site.airport, end)
        return end

    # --- commands -----------------------------------------------------------------------------

    def forget(self) -> None:
        """Take no further step of what was begun."""
        self._next = None

    def wait(self, step: Callable[[], bool]) -> None:
        """Try a step several times a second until it returns True."""
        self._next = step

    def begin_on_final(self, runway: str) -> None:
        """Fly the approach from where the aircraft is; it still needs a clearance to land."""
        self._aircraft.procedures.land(self.bind(runway))

    def begin_approach(
        self, runway: str, fly: Callable[[RunwayEnd, Sequence[Place]], None]
    ) -> None:
        """Fly the approach to a runway; a clearance to land there stays, one for another ends."""
        end = self.bind(runway)
        self._next = None
        if self._cleared is None or self._cleared.runway != end.ident:
            self._cleared, self._exit_path = None, ()
        fly(end, self._exit_path)

    def plan_clearance(self, command: LandCommand) -> Act:
        """Return what takes a landing clearance for the runway that is approached."""
        path, runway = self._path_off(command), self._site.runway(command.runway).ident

        def take() -> None:
            self.bind(runway)
            self._exit_path = path
            self._cleared = command.model_copy(update={"runway": runway})

        return take

    def intercept(self, runway: str) -> None:
        """Fly on as before, and join the final approach of a runway where the way leads to it."""
        self.bind(runway)
        self._next = self._land_once_on_final

    def plan_without_clearance(self) -> Act:
        """Return what goes on with the approach without the clearance to land."""
        if self._cleared is None:
            raise Unable("unable, not cleared to land")

        def withdraw() -> None:
            self._cleared = None

        return withdraw

    def plan_leaving(self, command: LandCommand) -> Act:
        """Return what takes a landing clearance on the way to its runway."""
        take = self.plan_clearance(command)

        def clear() -> None:
            take()
            self._aircraft.procedures.leave_at(self._exit_path)

        return clear

    def plan_landing(self, command: LandCommand) -> Act:
        """Return what takes a landing clearance, flies to the final approach, and joins it."""
        take = self.plan_clearance(command)
        via = [self._site.place(position) for position in command.via]
        threshold = self._site.runway(command.runway).threshold

        def land() -> None:
            take()
            if via:
                self._aircraft.en_route.fly_route([*via, threshold])
            self._next = self._land_once_on_final
            if not via:
                self.attend()

        return land

    def break_off(self, climb_to_m: float) -> None:
        """Go around, without a clearance to land any more."""
        self._aircraft.procedures.go_around(climb_to_m)
        self.leave()

    def leave(self) -> None:
        """Be bound for no runway any more."""
        self._cleared = self._next = self._final = None

    def attend(self) -> None:
        """Take the next step of an operation if it is due; a landing may become a go-around."""
        following, self._next = self._next, None
        if following is not None and not following() and self._next is None:
            self._next = following
        phase = self._aircraft.phase
        has_left = phase == "en_route" and self._next is None
        if phase in ("climb_out", "vacate") or has_left:
            self._final = self._cleared = None
        elif self._final is not None:
            self._attend_landing(self._final, phase)

    def _attend_landing(self, final: FinalApproach, phase: str) -> None:
        then = "full_stop" if self._cleared is None else self._cleared.then
        if phase in APPROACHING:
            self._go_around_uncleared(final)
            if then == "low_approach" and self._is_low_enough():
                self.go_around()
        if phase == "glide":
            self._go_around_if_too_high(final)
        elif phase == "rollout" and then == "touch_and_go":
            self._aircraft.procedures.take_off_again(self.usual_climb_m())
        elif phase == "rollout" and self._exit_path and self._traffic.is_on(self._exit_path):
            self._leave_elsewhere(final)
        elif phase == "standing" and then == "stop_and_go":
            self._cleared = None
            self._aircraft.procedures.take_off(final.runway, self.usual_climb_m())

    def _is_low_enough(self) -> bool:
        """Return whether a low approach climbs away now."""
        state = self._aircraft.state
        least_ft = None if self._cleared is None else self._cleared.not_below_ft
        if least_ft is not None and state.altitude_m < least_ft * FOOT + SINKS_M:
            return True
        return state.height_agl_m < LOW_APPROACH_M

    # --- the way off the runway -----------------------------------------------------------------

    def plan_off_runway(self, command: Command) -> Act | None:
        """Return what makes a landing aircraft leave its runway at a place, or stop on it.

        It is None if the aircraft has landed, or is not cleared to. `Unable` says why it cannot
        leave, or stop, there.
        """
        match command:
            case VacateCommand():
                return self._plan_exit(command)
            case TurnAtCommand(taxiway=name, side=side):
                return self._plan_exit(VacateCommand(action="vacate", exit=name, side=side))
            case HoldShortCommand(runway=str(runway)):
                return self._plan_to_stop_short(runway)
        return None

    def _plan_to_stop_short(self, runway: str) -> Act | None:
        if self._cleared is None or self._aircraft.on_ground:
            return None
        command = self._cleared.model_copy(update={"hold_short": runway})
        is_flown = self._aircraft.phase in APPROACHING
        return self.plan_leaving(command) if is_flown else self.plan_clearance(command)

    def _plan_exit(self, command: VacateCommand) -> Act | None:
        phase, final = self._aircraft.phase, self._final
        if final is None:
            return None
        if phase in ("approach", "orbit", "glide", "flare", "rollout"):
            begin = self._aircraft.procedures.leave_at
        elif self._next is not None and not self._aircraft.on_ground:
            begin = None
        else:
            return None
        path = self._exit(final, command).path
        short = None if self._cleared is None else self._cleared.hold_short
        if short is not None and not stays_short_of(self._site, final.runway, short, path):
            raise Unable(f"unable, holding short of runway {short}")

        def leave_there() -> None:
            self._exit_path = path
            if begin is not None:
                begin(path)

        return leave_there

    def _exit(self, final: FinalApproach, command: VacateCommand) -> Exit:
        """Return the exit that a command means for an aircraft that lands, or raise `Unable`."""
        made = self._exits_ahead(final, command)
        if made:
            return made[0]
        where = command.exit or f"{command.side or 'next'} exit".replace(
            "next exit", "the next exit"
        )
        exits = exits_named(self._site, final.runway, command.exit, command.side)
        past = all(each.along_m < self._along_m(final) for each in exits)
        raise Unable(f"unable, past {where}" if past else f"unable, too fast for {where}")

    def _leave_elsewhere(self, final: FinalApproach) -> None:
        """Leave the runway by the next exit at which nobody stands, or stop on it."""
        short = None if self._cleared is None else self._cleared.hold_short
        exits = self._site.airport.exits(final.runway.ident)
        name = next((e.taxiway for e in exits if e.path == tuple(self._exit_path)), "our exit")
        free = (
            each.path
            for each in self._exits_ahead(final, VacateCommand(action="vacate"))
            if not self._traffic.is_on(each.path)
            and (short is None or stays_short_of(self._site, final.runway, short, each.path))
        )
        self._exit_path = next(free, ())
        self._aircraft.procedures.leave_at(self._exit_path)
        then = "" if self._exit_path else ", stopping on the runway"
        raise Unable(f"unable {name}, traffic there{then}")

    def _exits_ahead(self, final: FinalApproach, command: VacateCommand) -> list[Exit]:
        """Return the exits that a command names which an aircraft that lands can still take."""
        aircraft = self._aircraft
        approach_m_s = aircraft.kind.speeds.approach_kt * KNOT
        on_it = aircraft.phase == "rollout"
        speed_m_s = aircraft.state.ground_speed_m_s if on_it else approach_m_s
        braking_m = max(speed_m_s**2 - EXIT_SPEED_M_S**2, 0.0) / (2.0 * FIRM_BRAKING_M_S2)
        first_m = self._along_m(final) + braking_m + speed_m_s
        exits = exits_named(self._site, final.runway, command.exit, command.side)
        return [each for each in exits if each.along_m >= first_m]

    def _along_m(self, final: FinalApproach) -> float:
        """Return how far along the runway a landing aircraft is, or will touch down."""
        on_it = self._aircraft.phase == "rollout"
        return -final.before_m(self._aircraft.state.place) if on_it else TOUCHDOWN_M

    # --- advisories ---------------------------------------------------------------------------

    @property
    def is_arriving(self) -> bool:
        """True on an approach, and low on a recorded track."""
        aircraft = self._aircraft
        is_low = aircraft.state.height_agl_m < GO_AROUND_CLIMB_M
        return aircraft.phase in APPROACHING or (aircraft.phase == TrackPhase.name and is_low)

    def go_around(self) -> bool:
        """Break off the approach; return whether there was one."""
        if not self.is_arriving or self._aircraft.on_ground:
            return False
        self.break_off(self.usual_climb_m())
        return True

    def usual_climb_m(self) -> float:
        """Return the altitude that a go-around climbs to where none was told, in m."""
        usual_m = self._site.ground_m + GO_AROUND_CLIMB_M
        return max(usual_m, self._aircraft.state.altitude_m + LEAST_CLIMB_M)

    # --- steps --------------------------------------------------------------------------------

    def _path_off(self, command: LandCommand) -> Sequence[Place]:
        """Return the way off the runway after a landing, or raise `Unable`."""
        runway = self._site.runway(command.runway)
        speed_m_s = self._aircraft.kind.speeds.approach_kt * KNOT
        if command.then in ("touch_and_go", "stop_and_go"):
            self._require_runway_for(command, runway, speed_m_s)
        if command.hold_short is not None:
            nose_m = self._aircraft.dimensions.length_m / 2.0
            return path_short_of(self._site, runway, command.hold_short, speed_m_s, nose_m)
        if not command.vacate or command.then != "full_stop":
            return ()
        way_out = exit_for(self._site, runway, speed_m_s, command.exit)
        return way_out.path if way_out else ()

    def _require_runway_for(
        self, command: LandCommand, runway: RunwayEnd, speed_m_s: float
    ) -> None:
        """Raise `Unable` unless a runway is long enough to land and take off on."""
        stops = command.then == "stop_and_go"
        rolls_m = speed_m_s**2 / (2.0 * BRAKING_M_S2) if stops else GO_AGAIN_S * speed_m_s
        needed_m = TOUCHDOWN_M + rolls_m + self.takeoff_roll_m(0.0 if stops else speed_m_s)
        if needed_m > runway.length_m - runway.displaced_m:
            raise Unable(f"unable, runway {runway.ident} is too short for us")

    def takeoff_roll_m(self, from_m_s: float) -> float:
        """Return the runway in m that a takeoff needs from a speed."""
        rotate_m_s = self._aircraft.kind.speeds.rotate_kt * KNOT
        rolls_m = max(rotate_m_s**2 - from_m_s**2, 0.0) / (2.0 * TAKEOFF_M_S2)
        return rolls_m + ROTATE_S * rotate_m_s

    def _land_once_on_final(self) -> bool:
        final, state = self._final, self._aircraft.state
        here = self._aircraft.state.place
        if (
            final is None
            or final.before_m(here) <= 0.0
            or abs(final.angle_rad(state.track_rad)) > CAPTURE_ANGLE_RAD
            or abs(final.right_m(here)) > CAPTURE_DISTANCE_M
        ):
            return False
        self._aircraft.procedures.land(final.runway, self._exit_path)
        return True

    def _go_around_uncleared(self, final: FinalApproach) -> None:
        """Break off an approach at the minimum without a clearance to land."""
        is_cleared = self._cleared is not None and self._cleared.runway == final.runway.ident
        if is_cleared or self._aircraft.state.height_agl_m > DECISION_HEIGHT_M:
            return
        if self.go_around():
            raise Unable("unable, no clearance to land: going around")

    def _go_around_if_too_high(self, final: FinalApproach) -> None:
        """Break off an approach that has crossed the threshold too high."""
        too_high = self._aircraft.state.height_agl_m > TOO_HIGH_M
        if too_high and final.before_m(self._aircraft.state.place) < 0.0 and self.go_around():
            raise Unable("unable, too high over the threshold: going around")
