"""Commands to an aircraft that begin a procedure, from taxi and takeoff to landing."""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.geodesy.wgs84 import Place
from airhilt.units import KNOT
from airhilt.world.flight.control import FlightControl
from airhilt.world.flight.procedures.en_route import DriftDown, EmergencyDescent, EnRoute
from airhilt.world.flight.procedures.final import Final, require_side_step
from airhilt.world.flight.procedures.landing import Flare, Glide, Rollout
from airhilt.world.flight.procedures.takeoff import (
    GoAround,
    RejectedTakeoff,
    TakeoffRoll,
    require_lined_up,
)
from airhilt.world.flight.procedures.taxi import Stand, Standing, Taxi, Way
from airhilt.world.flight.taxi_path import TaxiPath
from airhilt.world.surface.runway import RunwayEnd

FASTEST_TAXI_M_S = 20.0
"""Ground speed up to which a taxi or a takeoff may begin, in m/s."""
BELOW_ALL_TERRAIN_M = -1000.0
"""Altitude that a drift-down without a clearance descends to, in m; it levels long before."""


class ProcedureCommands:
    """Begins and ends the procedures of one aircraft.

    Each raises ValueError if the aircraft is not in the air, or on the ground, as the procedure
    needs it, or not where or how it can begin; the text says what was expected.
    """

    def __init__(self, control: FlightControl) -> None:
        self._control = control

    # --- on the ground ----------------------------------------------------------------------

    def taxi(
        self, path: Sequence[Place], speed_m_s: float | None = None, *, then: Stand = "standing"
    ) -> None:
        """Taxi along a path from here, at the type's taxi speed by default, and stand at its end.

        ``then`` is the name of standing there: ``lined_up`` on a runway.
        """
        control = self._control
        control.require_on_ground("taxi", FASTEST_TAXI_M_S)
        if not path:
            raise ValueError("the path is empty; expected a place to taxi to")
        ground, state = control.systems.kind.ground, control.state
        speed = ground.taxi_speed_kt * KNOT if speed_m_s is None else speed_m_s
        here = (state.latitude_rad, state.longitude_rad)
        track = TaxiPath([here, *path], speed, ground.look_ahead_m)
        called: Way = "line_up" if then == "lined_up" else "taxi"
        control.phase = Taxi(control.systems, track, called, then)

    @property
    def is_taxiing(self) -> bool:
        """True while there is something left of the path of a taxi, on the way or held."""
        return isinstance(self._control.phase, Taxi)

    def hold_position(self) -> None:
        """Stop on the way, and stay until `resume_taxi`; where it stands already, it stays."""
        phase = self._control.phase
        if isinstance(phase, Standing):
            return
        if not isinstance(phase, Taxi):
            raise ValueError(f"hold_position in phase {phase.name}; expected taxi")
        phase.hold()

    def resume_taxi(self) -> None:
        """Go on after `hold_position`."""
        phase = self._control.phase
        if not isinstance(phase, Taxi):
            raise ValueError(f"resume_taxi in phase {phase.name}; expected a taxi that was held")
        phase.resume()

    # --- takeoff ----------------------------------------------------------------------------

    def take_off(self, runway: RunwayEnd, climb_to_m: float) -> None:
        """Take off on the runway where the aircraft is, climb on its course, and level off."""
        control = self._control
        control.require_on_ground("take_off", FASTEST_TAXI_M_S)
        line = Final(runway, control.systems.kind)
        require_lined_up(control.state, line)
        control.require_climb(climb_to_m)
        control.guidance = control.climb_on(line, climb_to_m)
        control.phase = TakeoffRoll(control.systems, line, control.guidance)

    def reject_takeoff(self) -> None:
        """Stop on the runway."""
        phase = self._control.phase
        if not isinstance(phase, TakeoffRoll):
            raise ValueError(f"reject_takeoff in phase {phase.name}; expected takeoff_roll")
        self._control.phase = RejectedTakeoff(self._control.systems, phase.line)

    # --- approach and landing ---------------------------------------------------------------

    def land(self, runway: RunwayEnd, exit_path: Sequence[Place] = ()) -> None:
        """Join the final approach of a runway, land on it, and leave it.

        Below the glide path the present altitude is held until the path is met. The exit path leads
        from the runway's centre line to where the aircraft stands at the end; without one it stops
        on the runway.
        """
        self._control.require_airborne("land")
        final = Final(runway, self._control.systems.kind)
        final.require_reachable(self._control.state)
        self._approach(final, exit_path)

    def leave_at(self, exit_path: Sequence[Place]) -> None:
        """Leave the runway of the landing by another exit path than before."""
        phase = self._control.phase
        if not isinstance(phase, Glide | Flare | Rollout):
            raise ValueError(f"leave_at in phase {phase.name}; expected glide, flare or rollout")
        phase.leave_at(exit_path)

    def side_step(self, runway: RunwayEnd, exit_path: Sequence[Place] = ()) -> None:
        """Leave the approach that is flown for that of another runway, with its exit path."""
        phase = self._control.phase
        if not isinstance(phase, Glide):
            raise ValueError(f"side_step in phase {phase.name}; expected glide")
        final = Final(runway, self._control.systems.kind)
        require_side_step(self._control.state, final)
        self._approach(final, exit_path)

    def go_around(self, climb_to_m: float) -> None:
        """Break off the approach: climb on the runway's course to an altitude, and level off."""
        control = self._control
        if not isinstance(control.phase, Glide | Flare) or control.on_ground:
            raise ValueError(f"go_around in phase {control.phase.name}; expected glide or flare")
        control.require_climb(climb_to_m)
        control.guidance = control.climb_on(control.phase.final, climb_to_m)
        control.phase = GoAround(control.systems, control.guidance)

    def _approach(self, final: Final, exit_path: Sequence[Place]) -> None:
        """Fly the final approach, from the present altitude."""
        control = self._control
        systems, modes = control.systems, control.modes
        control.phase = Glide(systems, final, exit_path, control.state.altitude_m)
        control.guidance = EnRoute(
            systems,
            final,
            modes.altitude_at_usual_rate(final.runway.elevation_m),
            modes.airspeed(systems.kind.speeds.approach_kt * KNOT),
        )

    # --- emergencies ------------------------------------------------------------------------

    def drift_down(self) -> None:
        """Descend to where the remaining engines keep the altitude at drift-down speed.

        The track or the route goes on. A turn commanded meanwhile is flown; the aircraft does not
        go below an altitude commanded meanwhile.
        """
        control = self._control
        control.require_airborne("drift_down")
        en_route = control.commanded()
        control.systems.airframe.clean_up()
        en_route.vertical = control.modes.steepest_descent(BELOW_ALL_TERRAIN_M)
        drift_down_kt = control.systems.kind.speeds.drift_down_kt
        en_route.speed = control.modes.airspeed(drift_down_kt * KNOT)
        control.phase = DriftDown(control.systems, en_route)

    def emergency_descent(self, altitude_m: float) -> None:
        """Descend as fast as the type safely can, and level off at an altitude."""
        control = self._control
        control.require_airborne("emergency_descent")
        if altitude_m >= control.state.altitude_m:
            raise ValueError(
                f"altitude_m is {altitude_m:.0f}; expected less than the altitude now, "
                f"{control.state.altitude_m:.0f}"
            )
        en_route = control.commanded()
        control.systems.airframe.clean_up()
        en_route.vertical = control.modes.steepest_descent(altitude_m)
        control.phase = EmergencyDescent(control.systems, en_route)
