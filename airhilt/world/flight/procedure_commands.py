"""Commands to an aircraft that begin a procedure, from taxi and takeoff to landing."""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.geodesy.wgs84 import Place
from airhilt.units import KNOT
from airhilt.world.flight.control import FlightControl
from airhilt.world.flight.curves import Curve
from airhilt.world.flight.following import TrackPhase
from airhilt.world.flight.guidance import LateralMode
from airhilt.world.flight.procedures.en_route import DriftDown, EmergencyDescent, EnRoute
from airhilt.world.flight.procedures.final import Final, require_side_step
from airhilt.world.flight.procedures.landing import Flare, Glide, Rollout
from airhilt.world.flight.procedures.preparation import Preparation
from airhilt.world.flight.procedures.takeoff import (
    GoAround,
    RejectedTakeoff,
    TakeoffRoll,
    require_lined_up,
)
from airhilt.world.flight.procedures.taxi import Stand, Standing, Taxi, Way
from airhilt.world.flight.procedures.visual import Approach, Orbit
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
        ground, state = control.kind.ground, control.state
        speed = ground.taxi_speed_kt * KNOT if speed_m_s is None else speed_m_s
        here = (state.latitude_rad, state.longitude_rad)
        control.leave_track()
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

    def take_off(
        self, runway: RunwayEnd, climb_to_m: float, track_rad: float | None = None
    ) -> None:
        """Take off on the runway where the aircraft is, climb on its course, and level off.

        With a track, turn to it once that is safe.
        """
        control = self._control
        control.require_on_ground("take_off", FASTEST_TAXI_M_S)
        line = Final(runway, control.kind)
        require_lined_up(control.state, line)
        control.require_climb(climb_to_m)
        control.leave_track()
        after = line if track_rad is None else control.modes.track(track_rad)
        control.guidance = control.climb_on(after, control.modes.steepest_climb(climb_to_m))
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
        final = Final(runway, self._control.kind)
        final.require_reachable(self._control.state)
        self._approach(final, exit_path)

    def leave_at(self, exit_path: Sequence[Place]) -> None:
        """Leave the runway of the landing by another exit path than before."""
        phase = self._control.phase
        if not isinstance(phase, Approach | Orbit | Glide | Flare | Rollout):
            raise ValueError(f"leave_at in phase {phase.name}; expected an approach or a rollout")
        phase.leave_at(exit_path)

    def approach(
        self,
        runway: RunwayEnd,
        curve: Curve,
        altitude_m: float,
        exit_path: Sequence[Place] = (),
        *,
        keeps_level: bool = False,
    ) -> None:
        """Fly a curve that ends at the threshold of a runway, and land there.

        The altitude is held until the glide path along the curve is below it, or with
        ``keeps_level`` until the last line of the curve.
        """
        control = self._control
        control.require_airborne("approach")
        control.leave_track()
        systems, modes = control.systems, control.modes
        final = Final(runway, systems.kind)
        path, level = modes.curve(curve), modes.altitude_at_usual_rate(altitude_m)
        preparation = self._preparation()
        if not preparation.is_configured:
            systems.airframe.clean_up()
        control.phase = Approach(
            systems, final, exit_path, path, level, preparation, keeps_level=keeps_level
        )
        control.guidance = EnRoute(
            systems, path, level, modes.airspeed(systems.kind.speeds.approach_kt * KNOT)
        )

    @property
    def preparation(self) -> Preparation | None:
        """Preparation of the landing that is approached; None without an approach."""
        phase = self._control.phase
        return phase.preparation if isinstance(phase, Approach | Orbit | Glide) else None

    def orbit(self, curve: Curve) -> None:
        """Fly a curve at the present altitude and airspeed, and go on with the approach."""
        control = self._control
        phase, state, modes = control.phase, control.state, control.modes
        if isinstance(phase, Orbit):
            phase = phase.then
        if not isinstance(phase, Glide | Approach):
            raise ValueError(f"orbit in phase {phase.name}; expected an approach")
        control.phase = Orbit(
            control.systems,
            modes.curve(curve),
            modes.altitude_at_usual_rate(state.altitude_m),
            modes.airspeed(state.calibrated_airspeed_m_s),
            phase,
        )

    def require_side_step(self, runway: RunwayEnd) -> None:
        """Raise ValueError unless `side_step` is possible."""
        phase = self._control.phase
        if not isinstance(phase, Glide):
            raise ValueError(f"side_step in phase {phase.name}; expected glide")
        require_side_step(self._control.state, Final(runway, self._control.kind))

    def side_step(self, runway: RunwayEnd, exit_path: Sequence[Place] = ()) -> None:
        """Leave the approach that is flown for that of another runway, with its exit path."""
        self.require_side_step(runway)
        self._approach(Final(runway, self._control.kind), exit_path)

    def go_around(self, climb_to_m: float) -> None:
        """Break off the approach: climb on the runway's course to an altitude, and level off.

        From a recorded track it climbs on its present track.
        """
        control = self._control
        phase = control.phase
        modes = control.modes
        lateral: LateralMode | None = None
        if isinstance(phase, TrackPhase):
            lateral = modes.track(control.state.track_rad)
        elif isinstance(phase, Approach | Orbit | Glide | Flare):
            lateral = phase.final
        if lateral is None or control.on_ground:
            raise ValueError(f"go_around in phase {phase.name}; expected glide or flare")
        control.require_climb(climb_to_m)
        control.leave_track()
        control.guidance = control.climb_on(lateral, modes.altitude_at_usual_rate(climb_to_m))
        control.phase = GoAround(
            control.systems, control.guidance, may_touch=isinstance(phase, Flare)
        )

    def take_off_again(self, climb_to_m: float) -> None:
        """Take off from the rollout after a landing, climb on the runway's course, and level off.

        Whether the runway is long enough is for the caller to know.
        """
        control = self._control
        phase = control.phase
        if not isinstance(phase, Rollout):
            raise ValueError(f"take_off_again in phase {phase.name}; expected rollout")
        control.require_climb(climb_to_m)
        airframe = control.systems.airframe
        airframe.set_speed_brakes(0.0)
        airframe.set_ground_spoilers(0.0)
        control.guidance = control.climb_on(phase.final, control.modes.steepest_climb(climb_to_m))
        control.phase = TakeoffRoll(control.systems, phase.final, control.guidance)

    def _approach(self, final: Final, exit_path: Sequence[Place]) -> None:
        """Fly the final approach, from the present altitude."""
        control = self._control
        control.leave_track()
        systems, modes = control.systems, control.modes
        altitude_m, preparation = control.state.altitude_m, self._preparation()
        control.phase = Glide(systems, final, exit_path, altitude_m, preparation)
        control.guidance = EnRoute(
            systems,
            final,
            modes.altitude_at_usual_rate(final.runway.elevation_m),
            modes.airspeed(systems.kind.speeds.approach_kt * KNOT),
        )

    def _preparation(self) -> Preparation:
        return self.preparation or Preparation(self._control.systems)

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
        drift_down_kt = control.kind.speeds.drift_down_kt
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
