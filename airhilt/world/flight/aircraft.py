"""One aircraft: an airframe, the phases that fly it, and the guard that watches it."""

from __future__ import annotations

from collections import deque

from airhilt.shapes.aircraft.spec import AircraftDimensions
from airhilt.world.flight.aircraft_type import AircraftType, Rates
from airhilt.world.flight.airframe import Airframe
from airhilt.world.flight.control import FlightControl
from airhilt.world.flight.following import TrackControl, TrackFollower
from airhilt.world.flight.ground import GroundLaw
from airhilt.world.flight.guard import FlightGuard
from airhilt.world.flight.phases import AircraftSystems
from airhilt.world.flight.procedure_commands import ProcedureCommands
from airhilt.world.flight.procedures.taxi import Standing
from airhilt.world.flight.starting import Start
from airhilt.world.flight.state import AircraftState, Atmosphere, InitialCondition, OnGround
from airhilt.world.flight.track import TrackPoint
from airhilt.world.mover import NOT_BEGUN, TRACK_ENDED

NEAR_GROUND = Rates()
"""Rates of a flight that may touch the ground."""
ROW_TICKS = 4
"""Ticks that a flight which never lands is flown in one go, so that its data stay in the cache of
the processor."""


class Aircraft:
    """One JSBSim aircraft under guidance, or on a recorded track until a command takes it off.

    It begins standing on the ground, or in steady flight on its track, holding its altitude and its
    airspeed (or, with an initial vertical rate, climbing to its ceiling or descending to the ground
    at that rate, until it gets an altitude). The air is there from the first instant. On a recorded
    track it is in the world from the first point to the last; JSBSim begins when it leaves it.

    Parameters
    ----------
    seed
        Seed of its turbulence. The same seed and commands give the same flight, bit by bit.
    terrain_elevation_m
        Elevation of the flat ground below it, above WGS84.
    load
        Mass above that of the type's model, as a part of its empty mass.
    tick_s
        Time between two calls of `advance`, in s, divided into steps of the flight dynamics.
    may_land
        False for an aircraft that begins in the air and is never told to land. It flies at the
        rates of its type, `ROW_TICKS` in one go: a command acts up to that much later.

    Attributes
    ----------
    state : AircraftState
        True state after the last `advance`.
    en_route : FlightControl
        Commands for track, route, altitude and airspeed.
    procedures : ProcedureCommands
        Commands that begin a taxi, a takeoff, an approach or an emergency procedure.
    ended : str or None
        Why the flight has ended: ``ground_contact``, ``state_not_finite``, or
        ``envelope_exceeded:`` and what it exceeded. The state stays the last one before that. Of an
        aircraft on a recorded track also `NOT_BEGUN` and `TRACK_ENDED`.

    Raises
    ------
    ValueError
        The initial condition is outside the type's envelope.
    ModelError
        JSBSim does not have the model, or cannot fly it there.
    """

    def __init__(
        self,
        kind: AircraftType,
        initial: InitialCondition | OnGround | tuple[TrackPoint, ...],
        *,
        seed: int,
        atmosphere: Atmosphere,
        terrain_elevation_m: float = 0.0,
        load: float = 0.0,
        tick_s: float = 0.05,
        may_land: bool = True,
    ) -> None:
        self.kind = kind
        self.ended: str | None = None
        self._seed, self._load, self._tick_s = seed, load, tick_s
        self._terrain_elevation_m = terrain_elevation_m
        self._may_land = may_land
        self._flown: deque[tuple[AircraftState, str | None]] = deque()
        self._guard = FlightGuard(kind)
        self._failing: list[int] = []
        self._follower: TrackFollower | None = None
        self._airframe: Airframe | TrackFollower
        if isinstance(initial, tuple):
            self._follower = self._airframe = follower = TrackFollower(
                kind, initial, atmosphere, terrain_elevation_m, tick_s
            )
            self.en_route: FlightControl = TrackControl(
                kind, follower, self._leave_track, terrain_elevation_m
            )
            self.ended = None if follower.has_begun else NOT_BEGUN
        else:
            systems = self._begin(initial, atmosphere)
            self.en_route = FlightControl(systems, initial, terrain_elevation_m)
        self.state = self.en_route.state
        self.procedures = ProcedureCommands(self.en_route)

    def _begin(
        self, initial: InitialCondition | OnGround, atmosphere: Atmosphere
    ) -> AircraftSystems:
        """Begin the flight dynamics; return the systems with which the phases fly."""
        kind, tick_s = self.kind, self._tick_s
        near_ground = self._may_land or isinstance(initial, OnGround)
        rates = NEAR_GROUND if near_ground else kind.rates
        self._row = 1 if near_ground else ROW_TICKS
        substeps = round(tick_s * rates.steps_hz)
        ticks = round(1.0 / (tick_s * rates.law_hz))
        self._substeps, self._ticks = range(substeps), range(ticks)
        self._airframe = airframe = Airframe(
            kind,
            step_s=tick_s / substeps,
            seed=self._seed,
            terrain_elevation_m=self._terrain_elevation_m,
            load=self._load,
        )
        period_s = ticks * tick_s
        start = Start(airframe, kind, period_s, ticks * substeps)
        autopilot = start.begin(initial, atmosphere, self._terrain_elevation_m)
        return AircraftSystems(
            kind, airframe, autopilot, GroundLaw(airframe, kind, period_s), period_s
        )

    def _leave_track(
        self, initial: InitialCondition | OnGround, atmosphere: Atmosphere
    ) -> AircraftSystems:
        systems = self._begin(initial, atmosphere)
        self._follower = None
        return systems

    @property
    def phase(self) -> str:
        """Phase of flight, such as ``en_route``, ``glide`` or ``go_around``."""
        return self.en_route.phase.name

    @property
    def on_ground(self) -> bool:
        """True if a main wheel carries weight."""
        return self._airframe.on_ground()

    @property
    def main_wheel_height_m(self) -> float:
        """Height of the main wheels, not loaded, above the ground, in m."""
        return self._airframe.main_wheel_height_m(self.state)

    @property
    def gear(self) -> float:
        """Position of the landing gear: 0 is up, 1 is down."""
        return self._airframe.gear()

    @property
    def flaps(self) -> float:
        """Position of the flaps: 0 is up, 1 is fully extended."""
        return self._airframe.flaps()

    @property
    def fuel_kg(self) -> float | None:
        """Mass of the fuel in its tanks, in kg; None on a recorded track."""
        return self._airframe.fuel_kg()

    @property
    def dimensions(self) -> AircraftDimensions:
        """Size of the aircraft."""
        return self.kind.dimensions

    @property
    def target_altitude_m(self) -> float:
        """Altitude that is flown to, or held, in m."""
        if self._follower is not None:
            return self._follower.level_m
        return self.en_route.guidance.vertical.clearance.altitude_m

    @property
    def target_vertical_rate_m_s(self) -> float:
        """Vertical rate commanded now, in m/s, positive up; 0 at the target altitude."""
        if self._follower is not None:
            return self.state.vertical_rate_m_s
        return self.en_route.guidance.vertical.vertical_rate(self.state)

    @property
    def target_speed_m_s(self) -> float:
        """Calibrated airspeed that is flown to, or held as far as the Mach limit allows, in m/s."""
        if self._follower is not None:
            return self.state.calibrated_airspeed_m_s
        return self.en_route.guidance.speed.target_m_s

    def advance(self) -> None:
        """Move on by one tick; do nothing once the flight has ended."""
        if self._follower is not None:
            self._follow(self._follower)
            return
        if self.ended is not None:
            return
        if not self._flown:
            self._fly_row()
        self.state, self.ended = self._flown.popleft()

    def _follow(self, follower: TrackFollower) -> None:
        """Move on along the recorded track."""
        if self.ended is not None and self.ended != NOT_BEGUN:
            return
        follower.advance()
        self.state = self.en_route.state = follower.state
        if follower.has_ended:
            self.ended = TRACK_ENDED
        elif follower.has_begun:
            self.ended = None

    def _fly_row(self) -> None:
        """Fly a row of ticks, or until the flight ends."""
        flown = self._flown
        self._fly()
        while len(flown) < self._row and flown[-1][1] is None:
            self._fly()

    def _fly(self) -> None:
        """Set the controls, and fly the ticks until they are set again."""
        control = self.en_route
        airframe, state = control.systems.airframe, control.state
        control.phase = phase = control.phase.fly(state)
        if isinstance(phase, Standing) and phase.at_rest:
            if state.ground_speed_m_s > 0.0:
                control.state = state._replace(
                    velocity_north_m_s=0.0, velocity_east_m_s=0.0, velocity_down_m_s=0.0
                )
            self._flown.append((control.state, None))
            return
        if phase.may_touch:
            airframe.set_wind_for_ground_speed(state.ground_speed_m_s)
        step = airframe.step
        for _ in self._ticks:
            for _ in self._substeps:
                step()
            while self._failing:
                airframe.cut_engine(self._failing.pop())
            state = airframe.state()
            ended = self._guard.check(
                state, may_touch=phase.may_touch, on_ground=airframe.on_ground()
            )
            if ended is not None:
                self._flown.append((control.state, ended))
                return
            control.state = state
            self._flown.append((state, None))

    def fail_engine(self, engine: int) -> None:
        """Stop an engine, counted from 0, for good; the present phase goes on.

        It stops at the end of the next tick flown: JSBSim undoes what is set before the first. A
        recorded track is left for it, on the ground when it next stands. A ValueError says that
        there is no such engine.
        """
        if not self.on_ground:
            self.en_route.leave_track()
        if isinstance(self._airframe, Airframe):
            self._airframe.require_engine(engine)
        self._failing.append(engine)
