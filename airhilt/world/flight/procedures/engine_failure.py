"""Drift-down after an engine failure, to where the remaining engines keep the altitude."""

from __future__ import annotations

from airhilt.units import FOOT_PER_MINUTE
from airhilt.world.flight.guidance import Altitude, AltitudeClearance
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.en_route import EnRoute
from airhilt.world.flight.state import AircraftState

LEVEL_M_S = 100.0 * FOOT_PER_MINUTE
"""Rate of descent below which the aircraft levels, in m/s."""
SPOOL_DOWN_S = 20.0
"""Time in which the failed engine may still give thrust, in s."""


class DriftDown:
    """Holds the drift-down speed on pitch at the greatest thrust, never climbing, then levels.

    It levels where the engines keep the altitude, or at a commanded altitude above that.

    Parameters
    ----------
    systems
        Airframe, autopilot and ground law.
    then
        En route on the track, at the airspeed and down to the altitude that follow.
    """

    name = "drift_down"
    commandable = True
    may_touch = False

    def __init__(self, systems: AircraftSystems, then: EnRoute) -> None:
        self._systems = systems
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
