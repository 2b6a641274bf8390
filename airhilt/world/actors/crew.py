"""Crew of an aircraft: it carries out commands, and reacts to advisories after a delay."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType
from typing import Literal

from airhilt.commands import (
    AltitudeCommand,
    BehindCommand,
    Command,
    ContinueCommand,
    CrossCommand,
    DirectCommand,
    DriftDownCommand,
    EmergencyDescentCommand,
    FollowCommand,
    GoAroundCommand,
    HoldAtCommand,
    HoldPositionCommand,
    HoldShortCommand,
    LineUpCommand,
    ResumeRouteCommand,
    RouteCommand,
    TakeOffCommand,
    TaxiCommand,
    TaxiToCommand,
    TrackCommand,
    TurnAtCommand,
    TurnCommand,
    VacateCommand,
)
from airhilt.geodesy.wgs84 import Place
from airhilt.messages import (
    Advisory,
    CancelTakeoff,
    Climb,
    EmergencyState,
    EmitterCategory,
    GoAround,
    HoldPosition,
    MaintainLevel,
    Recommendation,
    Turn,
)
from airhilt.scenario.models import RESPONSE_MODELS, AircraftSpec, Channel, Channels, OnTrack
from airhilt.surveillance.radar import discrete_code
from airhilt.surveillance.transponders import EMERGENCY_CODES, GENERAL_EMERGENCY
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE
from airhilt.world.actors.actor import (
    Act,
    Actor,
    Reaction,
    Unable,
    do_nothing,
    refusal_by,
    saying_unable,
)
from airhilt.world.actors.air_phases import EMERGENCIES, TO_A_RUNWAY, refusal_in_phase
from airhilt.world.actors.approaches import Approaches
from airhilt.world.actors.behind import BehindTraffic
from airhilt.world.actors.departure import Departure
from airhilt.world.actors.en_route_operations import EnRouteOperations
from airhilt.world.actors.envelope import Envelope
from airhilt.world.actors.ground_bodies import TaxiingAircraft
from airhilt.world.actors.ground_operations import GroundOperations
from airhilt.world.actors.reactions import FOLLOWED_FROM, ReactionModel, Response
from airhilt.world.actors.runway_operations import RunwayOperations
from airhilt.world.actors.traffic import Traffic
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.following import GEAR_DOWN_BELOW_M
from airhilt.world.flight.procedures.en_route import EmergencyDescent
from airhilt.world.site import ScenarioSite

ENDS_DEPARTURE = (
    TaxiCommand,
    TaxiToCommand,
    HoldPositionCommand,
    HoldShortCommand,
    FollowCommand,
    VacateCommand,
    TurnAtCommand,
)
"""Commands after which an aircraft lines up or takes off only when it is told again."""
ON_TO_A_RUNWAY = (TakeOffCommand, LineUpCommand, ContinueCommand, CrossCommand)
"""Commands by which an aircraft goes on to a runway, or takes off from it."""
ENDS_CROSSING = (AltitudeCommand, *EMERGENCIES, *TO_A_RUNWAY, GoAroundCommand)
"""Commands after which an aircraft goes on to no other level beyond a fix."""
FLOWN = (
    AltitudeCommand,
    TrackCommand,
    TurnCommand,
    RouteCommand,
    ResumeRouteCommand,
    DriftDownCommand,
    EmergencyDescentCommand,
)
"""Commands that the crew carries out by itself in the air."""
EMITTER_CATEGORIES: dict[str, EmitterCategory] = {
    "jet": "A3",
    "heavy_jet": "A5",
    "piston_single": "A1",
    "piston_twin": "A1",
}


def mesh_at(height_agl_m: float) -> str:
    """Return the name of the mesh that an aircraft shows at a height above the ground, in m."""
    return "gear" if height_agl_m < GEAR_DOWN_BELOW_M else "clean"


class Crew:
    """Actor in an aircraft: carries out commands, unless it follows an advisory.

    A command that comes while an advisory is followed is deferred until the conflict is over.
    `RunwayOperations` carries out commands about approaches and landings, `Departure` those about
    takeoffs, `GroundOperations` those about taxiways. Reaction times and compliance are drawn from
    a seed (`airhilt.world.actors.reactions.response_seed`). ``actors`` are all actors of the
    scenario by callsign, itself among them.
    """

    category: Literal["aircraft"] = "aircraft"

    def __init__(
        self,
        spec: AircraftSpec,
        aircraft: Aircraft,
        site: ScenarioSite,
        seed: int,
        actors: Mapping[str, Actor] = MappingProxyType({}),
        responses: Channels = RESPONSE_MODELS["icao"].crews,
    ) -> None:
        self.spec = spec
        self.body = aircraft
        traffic = Traffic(spec.callsign, actors)
        self.runway_operations = RunwayOperations(aircraft, site, traffic)
        self._ground = GroundOperations(TaxiingAircraft(aircraft), site, traffic)
        self._departure = Departure(aircraft, site, self._ground, self.runway_operations)
        self._behind = BehindTraffic(traffic)
        self._approaches = Approaches(aircraft, site, self.runway_operations)
        self._en_route = EnRouteOperations(aircraft, site)
        self._reactions = ReactionModel(spec.callsign, responses, spec.pilot, seed)
        self._site = site
        self._envelope = Envelope(aircraft, site.ground_m)
        self._return_lateral: Callable[[], None] = (
            aircraft.en_route.resume_route
            if isinstance(spec.initial, OnTrack)
            else partial(aircraft.en_route.hold_track, aircraft.state.track_rad)
        )
        self._altitude_before_m = aircraft.target_altitude_m
        self._followed: dict[str, int] = {}
        self._responding: set[str] = set()
        """Ids of the advisories that it follows, or is about to."""
        self._holding: set[str] = set()
        """Ids of the advisories because of which it keeps off a runway."""
        self._over: set[str] = set()
        self._deferred: list[Command] = []
        self._has_turned = False
        self._is_in_distress = False
        self._has_route = False

    @property
    def bound_runway(self) -> str | None:
        """Runway that the crew is going to use."""
        return self.runway_operations.bound_runway

    @property
    def emitter_category(self) -> EmitterCategory:
        """ADS-B emitter category that its transponder sends."""
        return EMITTER_CATEGORIES[self.body.kind.category]

    @property
    def squawk(self) -> str | None:
        """Mode A code that its transponder sends now; None without one."""
        if not self.spec.transponder.equipped:
            return None
        if self._is_in_distress:
            return GENERAL_EMERGENCY
        return self.spec.transponder.squawk or discrete_code(self.spec.icao24)

    @property
    def emergency(self) -> EmergencyState:
        """ADS-B emergency or priority status that its transponder sends now."""
        declared = self.spec.transponder.emergency
        return declared or EMERGENCY_CODES.get(self.squawk or "", "none")

    def mesh(self, t_s: float) -> str:  # noqa: ARG002
        """Return the name of the mesh of its aircraft: with the gear down near the ground."""
        return mesh_at(self.body.state.height_agl_m)

    def follows(self, recommendation: Recommendation) -> bool:  # noqa: ARG002
        """Return True: a crew follows every kind of recommendation."""
        return True

    def fly_route(self, waypoints: list[Place]) -> None:
        """Fly a route; it is the one to go back to after an advisory."""
        self.body.en_route.fly_route(waypoints)
        self._return_lateral = self.body.en_route.resume_route
        self._has_route = True

    def refusal(self, command: Command) -> str | None:
        """Return why the crew cannot carry out a command now; None if it can."""
        return refusal_by(self._plan, command)

    def command(self, command: Command) -> None:
        """Carry out a command, now or after the advisory that is followed, or raise `Unable`."""
        if self._followed:
            self._deferred.append(command)
        else:
            self._carry_out(command)

    def attend(self) -> None:
        """Take the next step of an operation if it is due, or raise `Unable`."""
        with saying_unable():
            if (command := self._behind.due()) is not None:
                self._carry_out(command)
            self._en_route.attend()
            self._ground.attend()
            self._departure.attend()
            self.runway_operations.attend()

    def _carry_out(self, command: Command) -> None:
        with saying_unable():
            act = self._plan(command)
            if isinstance(command, ENDS_CROSSING):
                self._en_route.forget()
            act()

    def _plan(self, command: Command) -> Act:
        """Return what carries out a command.

        A crew that holds because of a warning does not go on to a runway by a clearance that it
        took before, nor by another one, until the warning is over. `Unable`, ValueError or
        ScenarioError says why a command cannot be carried out.
        """
        if self._holding and isinstance(command, ON_TO_A_RUNWAY):
            raise Unable("unable, holding because of a warning")
        if (why := refusal_in_phase(self.body, command)) is not None:
            raise Unable(why)
        if (why := self._envelope.unflyable(command)) is not None:
            raise Unable(f"unable {why}")
        if isinstance(command, BehindCommand):
            self._plan(command.command)
            return self._behind.plan(command)
        if isinstance(command, ContinueCommand) and not self.body.on_ground:
            return do_nothing
        act = self._departure.plan(command) or self.runway_operations.plan_off_runway(command)
        if act is not None:
            return act
        act = self._ground.plan(command)
        if act is not None:
            return partial(self._move_on_ground, act, command)
        act = self._approaches.plan(command)
        if act is not None:
            return act
        act = self._en_route.plan(command)
        if act is not None:
            return partial(self._do_en_route, act, command)
        if not isinstance(command, FLOWN):
            raise Unable(f"unable to {command.action.replace('_', ' ')}")
        return partial(self._fly, command)

    def _do_en_route(self, act: Act, command: Command) -> None:
        act()
        if isinstance(command, DirectCommand):
            self._leave_approach(self.body.en_route.resume_route)
            self._has_route = True
        elif isinstance(command, HoldAtCommand):
            self._leave_approach(partial(self._carry_out, command))

    def _leave_approach(self, return_lateral: Callable[[], None]) -> None:
        """Take no further step to a runway, and remember the way to go back to after advisories."""
        self.runway_operations.forget()
        self._return_lateral = return_lateral

    def _move_on_ground(self, act: Act, command: Command) -> None:
        act()
        if isinstance(command, ENDS_DEPARTURE):
            self._departure.forget()
            self._behind.forget()
            self.runway_operations.forget()

    def _fly(self, command: Command) -> None:
        aircraft = self.body
        match command:
            case AltitudeCommand(altitude_ft=altitude, vertical_rate_fpm=rate):
                aircraft.en_route.hold_altitude(
                    altitude * FOOT, None if rate is None else rate * FOOT_PER_MINUTE
                )
            case TrackCommand(track_deg=track):
                aircraft.en_route.hold_track(track * DEGREE)
                self._leave_approach(partial(aircraft.en_route.hold_track, track * DEGREE))
            case TurnCommand(degrees=degrees):
                track = aircraft.state.track_rad + degrees * DEGREE
                aircraft.en_route.turn_by(degrees * DEGREE)
                self._leave_approach(partial(aircraft.en_route.hold_track, track))
            case RouteCommand(route=route):
                self.fly_route([self._site.place(position) for position in route])
                self.runway_operations.forget()
            case ResumeRouteCommand():
                aircraft.en_route.resume_route()
                self._return_lateral = aircraft.en_route.resume_route
            case DriftDownCommand():
                aircraft.procedures.drift_down()
                self._is_in_distress = True
            case EmergencyDescentCommand(altitude_ft=altitude):
                aircraft.procedures.emergency_descent(altitude * FOOT)
                self._is_in_distress = True

    # --- advisories -------------------------------------------------------------------------

    def hear(self, advisory: Advisory, channel: Channel = "assistant") -> Reaction | None:
        """Return the crew's reaction to an advisory; None if it asks for none."""
        recommendation = advisory.recommendation
        response = self._reactions.respond(
            channel,
            advisory.id,
            revision=advisory.revision,
            is_repeated=advisory.id in self._responding,
            is_vertical=isinstance(recommendation, Climb),
        )
        if not advisory.active:
            self._over.add(advisory.id)
            self._responding.discard(advisory.id)
            self._holding.discard(advisory.id)
            if advisory.id not in self._followed:
                return None
            return Reaction(response.delay_s, lambda: self._resume(advisory.id), "resumes")
        self._over.discard(advisory.id)
        if recommendation is None or advisory.severity.rank < FOLLOWED_FROM.rank:
            return None
        if not response.follows:
            return Reaction.none(recommendation.action)
        self._responding.add(advisory.id)
        return Reaction(
            response.delay_s,
            lambda: self._follow(advisory, recommendation, response),
            f"follows {recommendation.action}{response.manner}",
            tells=lambda: self._tells(recommendation),
        )

    def _tells(self, recommendation: Recommendation) -> str:
        """Return what the crew tells its unit that follows a recommendation now.

        ICAO Doc 4444, 12.3.4.18 and 12.3.4.11.
        """
        match recommendation:
            case GoAround():
                return "going around"
            case CancelTakeoff() if self.body.phase == "takeoff_roll":
                return "stopping"
        return ""

    def _follow(
        self, advisory: Advisory, recommendation: Recommendation, response: Response
    ) -> bool:
        if advisory.id in self._over or self._followed.get(advisory.id, -1) > advisory.revision:
            return False
        with saying_unable():
            match recommendation:
                case GoAround():
                    return self.runway_operations.go_around()
                case CancelTakeoff():
                    return self._hold(advisory, self._departure.cancel_takeoff())
                case HoldPosition():
                    return self._hold(advisory, self._hold_position())
                case Climb():
                    return self._avoid(advisory, self._flown(recommendation, response))
                case MaintainLevel() | Turn():
                    return self._avoid(advisory, recommendation)
        return False

    def _hold_position(self) -> bool:
        """Stop taxiing; return whether there was anything to stop."""
        if self.body.phase not in ("taxi", "line_up"):
            return False
        self._carry_out(HoldPositionCommand(action="hold_position"))
        return True

    def _hold(self, advisory: Advisory, has_stopped: bool) -> bool:
        """Note that the crew holds because of an advisory, and return whether it has stopped."""
        if has_stopped or self.body.phase in ("standing", "lined_up"):
            self._holding.add(advisory.id)
        return has_stopped

    def _flown(self, told: Climb, response: Response) -> Climb:
        """Return what the crew flies of a climb or descent; the wrong way ends above the ground."""
        flown = response.flown(told, self.body.state.altitude_m / FOOT)
        if response.is_opposite:
            lowest_ft = max(flown.altitude_ft, self._envelope.lowest_ft)
            return flown.model_copy(update={"altitude_ft": lowest_ft})
        return flown

    def _avoid(self, advisory: Advisory, recommendation: Climb | MaintainLevel | Turn) -> bool:
        if self._must_descend_below(recommendation):
            raise Unable("unable, emergency descent")
        if not isinstance(recommendation, Turn):
            why = self._envelope.too_low(recommendation.altitude_ft)
            if why is not None:
                raise Unable(f"unable {why}")
        if not self._followed:
            self._altitude_before_m = self.body.target_altitude_m
        match recommendation:
            case Climb(altitude_ft=altitude, vertical_rate_fpm=rate, turn_deg=degrees):
                self.body.en_route.hold_altitude(altitude * FOOT, rate * FOOT_PER_MINUTE)
                if degrees:
                    self._turn_by(degrees)
            case MaintainLevel(altitude_ft=altitude):
                self.body.en_route.hold_altitude(altitude * FOOT)
            case Turn(degrees=degrees):
                self._turn_by(degrees)
        self._followed[advisory.id] = advisory.revision
        return True

    def _turn_by(self, degrees: float) -> None:
        self.body.en_route.turn_by(degrees * DEGREE)
        self._has_turned = True

    def _must_descend_below(self, recommendation: Climb | MaintainLevel | Turn) -> bool:
        """Return whether a crew without cabin pressure descends below a recommended level."""
        return (
            not isinstance(recommendation, Turn)
            and self.body.phase == EmergencyDescent.name
            and recommendation.altitude_ft * FOOT > self.body.target_altitude_m
        )

    def _resume(self, advisory_id: str) -> bool:
        """Resume the flight before the advisory, unless another advisory is still followed."""
        if self._followed.pop(advisory_id, None) is None or self._followed:
            return False
        self.body.en_route.hold_altitude(self._altitude_before_m)
        if self._has_turned:
            self._has_turned = False
            self._return_lateral()
        deferred, self._deferred = self._deferred, []
        refused: list[Unable] = []
        for command in deferred:
            try:
                self._carry_out(command)
            except Unable as unable:
                refused.append(unable)
        if refused:
            raise refused[0]
        return True
