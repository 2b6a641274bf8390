"""The preparation of a landing: gear, flaps and airspeed on the way to the runway."""

from __future__ import annotations

from airhilt.units import KNOT
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.phases import AircraftSystems

FLAPS_PART = 1.3
"""Greatest speed with the flaps set for the landing, as a part of the approach speed; assumed: 185
kt for a 737 (175 kt in its flight manual), 90 kt for a Cessna 172 (85 kt)."""
SLOWED_PART = 2.0 / 3.0
"""Part of the distance at which the landing is prepared from which the approach speed is flown;
assumed: 4 NM for an airliner, as in "160 knots until 4 miles"."""


def flaps_limit_m_s(kind: AircraftType) -> float:
    """Return the greatest airspeed with the flaps set for the landing."""
    return FLAPS_PART * kind.speeds.approach_kt * KNOT


class Preparation:
    """Lowers gear and flaps of one aircraft in time, and says which airspeed it flies until then.

    At ``configure_m`` from the threshold gear and flaps are lowered; approach speed is flown from
    there on, or later after a speed that was told. One below the slowest clean speed needs them
    earlier.

    Attributes
    ----------
    is_configured
        True if gear and flaps are lowered.
    is_slowed
        True from where nothing but approach speed is flown.
    """

    def __init__(self, systems: AircraftSystems) -> None:
        self._systems = systems
        self._told_m_s: float | None = None
        self.is_configured = False
        self.is_slowed = False

    def hold(self, calibrated_airspeed_m_s: float | None) -> None:
        """Fly an airspeed as long as the landing allows; None: the usual one."""
        self._told_m_s = calibrated_airspeed_m_s
        slowest_m_s = self._systems.kind.speeds.minimum_clean_kt * KNOT
        if calibrated_airspeed_m_s is not None and calibrated_airspeed_m_s < slowest_m_s:
            self._configure()

    def airspeed_m_s(self, to_go_m: float) -> float:
        """Return the airspeed at a distance from the threshold, and prepare what is due there."""
        kind = self._systems.kind
        if not self.is_configured and to_go_m < kind.landing.configure_m:
            self._configure()
        if to_go_m < SLOWED_PART * kind.landing.configure_m:
            self._told_m_s, self.is_slowed = None, True
        if self._told_m_s is not None:
            return self._told_m_s
        speeds = kind.speeds
        return (speeds.approach_kt if self.is_configured else speeds.minimum_clean_kt) * KNOT

    def _configure(self) -> None:
        kind, airframe = self._systems.kind, self._systems.airframe
        airframe.set_gear(1.0)
        airframe.set_flaps(kind.landing.flaps)
        self.is_configured = True
        if self._told_m_s is not None and self._told_m_s > flaps_limit_m_s(kind):
            self._told_m_s = None
