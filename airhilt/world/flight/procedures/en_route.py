"""En route: the autopilot holds track, altitude and airspeed; and the descents that end there."""

from __future__ import annotations

from airhilt.units import DEGREE, FOOT_PER_MINUTE, KNOT
from airhilt.world.flight.guidance import Airspeed, Altitude, AltitudeClearance, LateralMode
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.state import AircraftState

AIRSPEED_MARGIN = 10.0 * KNOT
"""Margin below the greatest speed, in m/s."""
MACH_MARGIN = 0.02
"""Margin below the greatest Mach number."""
STEEPEST_DESCENT = 9.0 * DEGREE
"""Steepest descent while the airspeed builds up, in rad."""
LEVEL_M_S = 100.0 * FOOT_PER_MINUTE
"""Rate of descent below which the aircraft levels, in m/s."""
SPOOL_DOWN_S = 20.0
"""Time in which the failed engine may still give thrust, in s."""


class EnRoute(FlightPhase):
    """Holds one mode in each direction; a command replaces one of them."""

    name = "en_route"
    commandable = True

    def __init__(
        self, systems: AircraftSystems, lateral: LateralMode, vertical: Altitude, speed: Airspeed
    ) -> None:
        super().__init__(systems)
        self.lateral = lateral
        self.vertical = vertical
        self.speed = speed

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        self._systems.autopilot.fly(
            state,
            self.lateral.turn_rate(state),
            self.vertical.vertical_rate(state),
            self.speed.airspeed(state),
        )
        return self


class EmergencyDescent(FlightPhase):
    """Descends as fast as the aircraft safely can, and levels off into what follows."""

    name = "emergency_descent"
    commandable = True

    def __init__(self, systems: AircraftSystems, then: EnRoute) -> None:
        super().__init__(systems)
        self._then = then
        speeds = systems.kind.speeds
        self._speed = Airspeed(
            speeds.maximum_kt * KNOT - AIRSPEED_MARGIN, speeds.maximum_mach - MACH_MARGIN
        )
        systems.airframe.set_speed_brakes(1.0)

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        if self._then.vertical.captures(state):
            self._systems.airframe.set_speed_brakes(0.0)
            return self._then.fly(state)
        self._systems.autopilot.fly_on_pitch(
            state,
            self._then.lateral.turn_rate(state),
            self._speed.airspeed(state),
            0.0,
            steepest_descent=STEEPEST_DESCENT,
        )
        return self


class DriftDown(FlightPhase):
    """Holds the drift-down speed on pitch at the greatest thrust, never climbing, then levels.

    It levels where the engines keep the altitude, or at a commanded altitude above that, into what
    follows.
    """

    name = "drift_down"
    commandable = True

    def __init__(self, systems: AircraftSystems, then: EnRoute) -> None:
        super().__init__(systems)
        self._then = then
        self._flown_s = 0.0

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        systems, then = self._systems, self._then
        airspeed = then.speed.airspeed(state)
        self._flown_s += systems.tick_s
        if self._flown_s > SPOOL_DOWN_S and self._kept(state):
            gain = systems.kind.gains.guidance.altitude_per_s
            then.vertical = Altitude(AltitudeClearance(state.altitude_m, LEVEL_M_S), gain)
            return then.fly(state)
        if then.vertical.captures(state):
            return then.fly(state)
        systems.autopilot.fly_on_pitch(
            state, then.lateral.turn_rate(state), airspeed, 1.0, steepest_climb=0.0
        )
        return self

    def _kept(self, state: AircraftState) -> bool:
        """Return whether the engines at full thrust keep this altitude, or nearly so."""
        autopilot = self._systems.autopilot
        potential_rate = autopilot.potential_climb * state.true_airspeed_m_s
        return autopilot.lever >= 1.0 and potential_rate > -LEVEL_M_S
