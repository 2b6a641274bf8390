"""Says when, and why, a flight is over: JSBSim itself flies on through the ground and NaN."""

from __future__ import annotations

import math

from airhilt.flight.aircraft_type import AircraftType
from airhilt.flight.state import AircraftState
from airhilt.units import DEGREE, FOOT_PER_MINUTE, KNOT

GROUND_CONTACT = "ground_contact"
STATE_NOT_FINITE = "state_not_finite"
ENVELOPE_EXCEEDED = "envelope_exceeded"
BANK_LIMIT = 75.0 * DEGREE
PITCH_LIMIT = 45.0 * DEGREE
OVERSPEED_FACTOR = 1.15
"""Above the maximum speed; design dive speed is 1.25 of cruise speed at most (CS-25.335)."""
OVERSPEED_MACH = 0.07
"""Above the maximum Mach number (the same paragraph's least margin)."""
STALL_FACTOR = 0.65
"""Of the slowest speed at which the type flies: well below its stall speed."""
SINK_FACTOR = 3.0
"""Of the type's greatest descent rate."""


class Guard:
    """Watches the state of one aircraft of a type."""

    def __init__(self, kind: AircraftType) -> None:
        speeds = kind.speeds
        self._slowest = STALL_FACTOR * min(speeds.minimum_clean_kt, speeds.approach_kt) * KNOT
        self._fastest = OVERSPEED_FACTOR * speeds.maximum_kt * KNOT
        self._highest_mach = speeds.maximum_mach + OVERSPEED_MACH
        self._greatest_sink = SINK_FACTOR * speeds.maximum_descent_rate_fpm * FOOT_PER_MINUTE

    def check(self, state: AircraftState) -> str | None:
        """Return the named cause for which the flight ends in this state, or None."""
        # Infinity and NaN survive every sum.
        if not math.isfinite(sum(state)):
            return STATE_NOT_FINITE
        if state.height_agl_m <= 0.0:
            return GROUND_CONTACT
        airspeed = state.calibrated_airspeed_m_s
        if (
            -BANK_LIMIT < state.roll_rad < BANK_LIMIT
            and -PITCH_LIMIT < state.pitch_rad < PITCH_LIMIT
            and self._slowest < airspeed < self._fastest
            and state.mach < self._highest_mach
            and state.velocity_down_m_s < self._greatest_sink
        ):
            return None
        return f"{ENVELOPE_EXCEEDED}: {self._excess(state)}"

    def _excess(self, state: AircraftState) -> str:
        airspeed = state.calibrated_airspeed_m_s
        if abs(state.roll_rad) >= BANK_LIMIT:
            return f"bank {math.degrees(state.roll_rad):.0f} deg"
        if abs(state.pitch_rad) >= PITCH_LIMIT:
            return f"pitch {math.degrees(state.pitch_rad):.0f} deg"
        if airspeed <= self._slowest:
            return f"stall at {airspeed / KNOT:.0f} kt"
        if airspeed >= self._fastest:
            return f"airspeed {airspeed / KNOT:.0f} kt"
        if state.mach >= self._highest_mach:
            return f"Mach {state.mach:.2f}"
        return f"sink rate {state.velocity_down_m_s / FOOT_PER_MINUTE:.0f} fpm"
