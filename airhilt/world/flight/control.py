"""The phase that flies an aircraft now, and the modes that en-route commands change."""

from __future__ import annotations

from airhilt.units import KNOT
from airhilt.world.flight.guidance import LateralMode
from airhilt.world.flight.modes import GuidanceModes
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.en_route import EnRoute
from airhilt.world.flight.procedures.taxi import Standing
from airhilt.world.flight.state import InitialCondition, OnGround


class FlightControl:
    """State of one aircraft under guidance, shared by its commands.

    Parameters
    ----------
    systems
        Airframe, autopilot and ground law.
    initial
        Place where the aircraft begins.
    terrain_elevation_m
        Elevation of the flat ground above WGS84.

    Attributes
    ----------
    systems : AircraftSystems
    modes : GuidanceModes
        Makes the modes of this type.
    state : AircraftState
        State after the last tick.
    phase : FlightPhase
        Phase that flies the next tick.
    en_route : EnRoute
        Modes that are flown now, or that the present procedure leads to.
    """

    def __init__(
        self,
        systems: AircraftSystems,
        initial: InitialCondition | OnGround,
        terrain_elevation_m: float,
    ) -> None:
        self.systems = systems
        self.modes = modes = GuidanceModes(systems.kind)
        self.state = systems.airframe.state()
        self.phase: FlightPhase
        if isinstance(initial, OnGround):
            self.en_route = self.climb_on(modes.track(initial.heading_rad), self.state.altitude_m)
            self.phase = Standing(systems, "lined_up" if initial.lined_up else "standing")
        else:
            self.phase = self.en_route = EnRoute(
                systems,
                modes.track(initial.track_rad),
                modes.initial_altitude(initial, terrain_elevation_m),
                modes.airspeed(initial.calibrated_airspeed_m_s),
            )

    @property
    def on_ground(self) -> bool:
        """True if a main wheel carries weight."""
        return self.systems.airframe.on_ground()

    def climb_on(self, lateral: LateralMode, altitude_m: float) -> EnRoute:
        """Return the modes of a climb to an altitude at the slowest clean airspeed."""
        modes = self.modes
        return EnRoute(
            self.systems, lateral, modes.steepest_climb(altitude_m), modes.clean_climb_speed()
        )

    def commanded(self) -> EnRoute:
        """Return the modes that a command changes; end a procedure that they do not lead out of.

        Raises
        ------
        ValueError
            The aircraft is on the ground.
        """
        if not self.phase.commandable:
            self.require_airborne("an en-route command")
            modes, state = self.modes, self.state
            self.systems.airframe.clean_up()
            self.phase = self.en_route = EnRoute(
                self.systems,
                modes.track(state.track_rad),
                modes.altitude_at_usual_rate(state.altitude_m),
                modes.airspeed(self.systems.kind.speeds.minimum_clean_kt * KNOT),
            )
        return self.en_route

    def require_airborne(self, command: str) -> None:
        """Check that the aircraft is in the air.

        Raises
        ------
        ValueError
            It is on the ground.
        """
        if self.on_ground:
            raise ValueError(
                f"{command} in phase {self.phase.name} on the ground; expected in the air"
            )

    def require_on_ground(self, command: str, fastest_m_s: float) -> None:
        """Check that the aircraft is on the ground, and slow enough.

        Raises
        ------
        ValueError
            It is in the air, or faster.
        """
        if not self.on_ground:
            raise ValueError(
                f"{command} in phase {self.phase.name} in the air; expected on the ground"
            )
        speed = self.state.ground_speed_m_s
        if speed > fastest_m_s:
            raise ValueError(
                f"{command} at {speed / KNOT:.0f} kt; expected at most {fastest_m_s / KNOT:.0f} kt"
            )

    def require_climb(self, climb_to_m: float) -> None:
        """Check that an altitude is above the aircraft.

        Raises
        ------
        ValueError
            It is not.
        """
        if climb_to_m <= self.state.altitude_m:
            raise ValueError(
                f"climb_to_m is {climb_to_m:.0f}; expected more than the altitude now, "
                f"{self.state.altitude_m:.0f}"
            )
