"""The approach: along the localizer and down the glide path, configured, at approach speed.

The glide path meets the runway where the main wheels aim at, ``landing.aim_m`` of the aircraft
type beyond the threshold. Until it is met from below the altitude is held.
"""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.geodesy.wgs84 import Place
from airhilt.units import FOOT_PER_MINUTE, KNOT
from airhilt.world.flight.guidance import Altitude, AltitudeClearance
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.final import GREATEST_CORRECTION_M_S, Final
from airhilt.world.flight.procedures.landing import Flare
from airhilt.world.flight.state import AircraftState

CLOSE_HEIGHT_M = 60.0
"""Height in m below which the glide path is followed as closely as the flare: 200 ft, where a
category I approach needs the runway in sight (ICAO Annex 6 part I, 4.2.8.3)."""


class Glide:
    """Flies the localizer and the glide path down to the flare.

    Below the glide path it keeps its altitude until the path is met; at ``configure_m`` from the
    threshold it lowers the gear, sets the flaps and slows down to approach speed.

    Parameters
    ----------
    systems
        Airframe, autopilot and ground law.
    final
        Approach to fly.
    exit_path
        Way along which the runway is left after landing.
    altitude_m
        Altitude that is held until the glide path is met.
    """

    name = "glide"
    commandable = False
    may_touch = False

    def __init__(
        self,
        systems: AircraftSystems,
        final: Final,
        exit_path: Sequence[Place],
        altitude_m: float,
    ) -> None:
        self._systems = systems
        self.final = final
        self.exit_path = exit_path
        kind = systems.kind
        self._intercept = Altitude(
            AltitudeClearance(altitude_m, GREATEST_CORRECTION_M_S),
            kind.gains.guidance.altitude_per_s,
        )
        self._configure_m = kind.landing.configure_m
        self._configured = False
        self._airspeed = kind.speeds.minimum_clean_kt * KNOT
        self._captured = False

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        systems, final = self._systems, self.final
        flare = systems.kind.landing.flare
        if not self._configured and -final.along_m(state) < self._configure_m:
            self._configure()
        vertical_rate = final.vertical_rate(state)
        if not self._captured:
            level = self._intercept.vertical_rate(state)
            self._captured = vertical_rate <= level
            vertical_rate = min(vertical_rate, level)
        height = systems.airframe.main_wheel_height_m(state)
        sink_at_flare = height / flare.time_constant_s + flare.touchdown_rate_fpm * FOOT_PER_MINUTE
        if sink_at_flare < -final.glide_rate(state):
            return Flare(systems, final, self.exit_path, height).fly(state)
        systems.autopilot.fly(
            state,
            final.turn_rate(state),
            vertical_rate,
            self._airspeed,
            closely=height < CLOSE_HEIGHT_M,
        )
        return self

    def _configure(self) -> None:
        """Lower the gear, set the flaps, slow down."""
        kind, airframe = self._systems.kind, self._systems.airframe
        airframe.set_gear(1.0)
        airframe.set_flaps(kind.landing.flaps)
        self._airspeed = kind.speeds.approach_kt * KNOT
        self._configured = True
