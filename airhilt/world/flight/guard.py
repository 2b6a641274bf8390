"""Checks whether a flight has ended, and why. JSBSim itself flies on through ground and NaN."""

from __future__ import annotations

import math

from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.state import AircraftState

GROUND_CONTACT = "ground_contact"
STATE_NOT_FINITE = "state_not_finite"
ENVELOPE_EXCEEDED = "envelope_exceeded"
BANK_LIMIT = 75.0 * DEGREE
"""Greatest bank of a flight, in rad."""
PITCH_LIMIT = 45.0 * DEGREE
"""Greatest pitch of a flight, up or down, in rad."""
OVERSPEED_FACTOR = 1.15
"""Fastest flight, as a part of the maximum speed. The design dive speed is at most 1.25 times the
cruise speed (CS-25.335)."""
OVERSPEED_MACH = 0.07
"""Margin above the maximum Mach number (least margin of CS-25.335)."""
STALL_FACTOR = 0.65
"""Slowest flight, as a part of the type's slowest speed: well below the stall speed."""
HARDEST_TOUCHDOWN_M_S = 12.0 * FOOT
"""Greatest rate of descent that landing gear withstands, in m/s (14 CFR 25.723(b))."""
LOW_M = 5.0
"""Height up to which an aircraft that may touch the ground need not keep flying speed, in m."""
GEAR_TRAVEL_M = 1.0
"""Greatest travel of the wheels' struts beyond standing, in m."""
SINK_FACTOR = 3.0
"""Greatest sink rate, as a multiple of the type's greatest descent rate."""


class FlightGuard:
    """Watches the state of one aircraft of a type."""

    def __init__(self, kind: AircraftType) -> None:
        speeds = kind.speeds
        self._slowest = STALL_FACTOR * min(speeds.minimum_clean_kt, speeds.approach_kt) * KNOT
        self._fastest = OVERSPEED_FACTOR * speeds.maximum_kt * KNOT
        self._highest_mach = speeds.maximum_mach + OVERSPEED_MACH
        self._tail_contact = kind.ground.tail_contact_deg * DEGREE
        self._wing_contact = kind.ground.wing_contact_deg * DEGREE
        self._greatest_sink = SINK_FACTOR * speeds.maximum_descent_rate_fpm * FOOT_PER_MINUTE

    def check(
        self, state: AircraftState, *, may_touch: bool = False, on_ground: bool = False
    ) -> str | None:
        """Return the named cause for which the flight ends in this state, or None.

        ``may_touch`` is true if wheels may touch the ground, ``on_ground`` if one carries weight.
        """
        # Infinity and NaN survive every sum.
        if not math.isfinite(sum(state)):
            return STATE_NOT_FINITE
        if may_touch and (on_ground or state.height_agl_m < LOW_M):
            return self._check_touching(state, on_ground)
        if on_ground or state.height_agl_m <= 0.0:
            return GROUND_CONTACT
        excess = self._excess(state)
        return None if excess is None else f"{ENVELOPE_EXCEEDED}: {excess}"

    def _check_touching(self, state: AircraftState, on_ground: bool) -> str | None:
        """Return whether more than the wheels touches the ground, or they do so too hard."""
        if state.height_agl_m <= -GEAR_TRAVEL_M:
            return GROUND_CONTACT
        if on_ground and (
            state.velocity_down_m_s >= HARDEST_TOUCHDOWN_M_S
            or abs(state.roll_rad) >= self._wing_contact
            or abs(state.pitch_rad) >= self._tail_contact
        ):
            return GROUND_CONTACT
        return None

    def _excess(self, state: AircraftState) -> str | None:
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
        if state.velocity_down_m_s >= self._greatest_sink:
            return f"sink rate {state.velocity_down_m_s / FOOT_PER_MINUTE:.0f} fpm"
        return None
