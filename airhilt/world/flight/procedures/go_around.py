"""The go-around: full thrust, the descent stopped, then a climb on the runway's course."""

from __future__ import annotations

from airhilt.units import FOOT, FOOT_PER_MINUTE, KNOT
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.en_route import EnRoute
from airhilt.world.flight.state import AircraftState

CLEAN_UP_HEIGHT_M = 400.0 * FOOT
"""Least height of turns, acceleration and flap retraction, in m (14 CFR 25.111(c)(4))."""
LEVER_PER_OVERSPEED_S_M = 0.05
"""Reduction of the lever per excess of airspeed, in s/m, where the steepest climb leaves thrust."""
STOPPED_M_S = 300.0 * FOOT_PER_MINUTE
"""Climb rate from which the descent counts as stopped, in m/s."""
STOP_M_S2 = 1.5
"""Upward acceleration that stops the descent, in m/s2."""


class GoAround(FlightPhase):
    """Goes around, cleans up, and levels off into what follows."""

    name = "go_around"
    commandable = True

    def __init__(self, systems: AircraftSystems, then: EnRoute) -> None:
        super().__init__(systems)
        self._then = then
        self._airspeed = systems.kind.speeds.climb_safety_kt * KNOT
        self._stopped = False
        self._clean = False

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        autopilot, airframe = self._systems.autopilot, self._systems.airframe
        turn_rate = self._then.lateral.turn_rate(state)
        if not self._stopped:
            autopilot.flare(state, turn_rate, STOPPED_M_S, STOP_M_S2, 1.0, None)
            if state.vertical_rate_m_s >= STOPPED_M_S:
                self._stopped = True
                airframe.set_gear(0.0)
            return self
        if self._then.vertical.captures(state):
            self._clean_up()
            return self._then.fly(state)
        if not self._clean and state.height_agl_m > CLEAN_UP_HEIGHT_M:
            self._clean_up()
        overspeed = max(state.calibrated_airspeed_m_s - self._airspeed, 0.0)
        lever = 1.0 - LEVER_PER_OVERSPEED_S_M * overspeed
        autopilot.fly_on_pitch(state, turn_rate, self._airspeed, lever)
        return self

    def _clean_up(self) -> None:
        """Retract the flaps and accelerate."""
        self._systems.airframe.set_flaps(0.0)
        self._airspeed = self._then.speed.target_m_s
        self._clean = True
