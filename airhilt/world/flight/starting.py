"""Start of an aircraft: in steady flight, or standing on its wheels with idling engines."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from airhilt.units import FOOT, KNOT, wrap_angle
from airhilt.world.flight import standard_atmosphere
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.airframe import Airframe
from airhilt.world.flight.autopilot import Autopilot
from airhilt.world.flight.guidance import GuidanceModes
from airhilt.world.flight.model import ModelError
from airhilt.world.flight.state import Atmosphere, InitialCondition, OnGround

SETTLING_TIME_S = 40.0
"""Time in still air before the start, in s, of a model that JSBSim cannot trim."""
SETTLED_SPEED_M_S = 1.5 * KNOT
"""Greatest error of airspeed after the settling time, in m/s."""
STARTING_TIME_S = 5.0
"""Time in which the engines start before a start on the ground, in s."""
IDLING_TIME_S = 15.0
"""Time in which they then run down to idle and the struts settle, in s."""


@dataclass(frozen=True, slots=True)
class Start:
    """Brings an airframe that was just made to where it begins, by ticks of some substeps."""

    airframe: Airframe
    kind: AircraftType
    tick_s: float
    substeps: int

    def begin(
        self,
        initial: InitialCondition | OnGround,
        atmosphere: Atmosphere,
        terrain_elevation_m: float,
    ) -> Autopilot:
        """Put the airframe where it begins; return the autopilot that flies it from there.

        A ValueError says that this is outside the type's envelope, and a ModelError that JSBSim
        cannot fly the model there.
        """
        if isinstance(initial, OnGround):
            return self._on_ground(initial, atmosphere)
        self._require_inside_envelope(initial, terrain_elevation_m)
        heading = heading_to_track(initial, atmosphere)
        begin = self._trimmed if self.kind.start == "trim" else self._settled
        autopilot = begin(initial, heading)
        self.airframe.release(initial, atmosphere)
        if initial.bank_rad:
            autopilot.take_over(self.airframe.state())
        return autopilot

    def _on_ground(self, initial: OnGround, atmosphere: Atmosphere) -> Autopilot:
        """Begin on the wheels, with the engines running down to idle."""
        airframe = self.airframe
        airframe.start_on_ground(initial)
        airframe.set_brakes(1.0)
        if self.kind.start == "settle":
            airframe.crank()
        for seconds in (STARTING_TIME_S, IDLING_TIME_S):
            for _ in range(round(seconds / self.tick_s) * self.substeps):
                airframe.step()
            airframe.set_throttle(0.0)
        airframe.set_atmosphere(atmosphere)
        return Autopilot(airframe, self.kind, self.tick_s, airframe.state())

    def _trimmed(self, initial: InitialCondition, heading_rad: float) -> Autopilot:
        """Let JSBSim trim the airframe."""
        self.airframe.start(initial, heading_rad)
        self.airframe.trim()
        return Autopilot(self.airframe, self.kind, self.tick_s, self.airframe.state())

    def _settled(self, initial: InitialCondition, heading_rad: float) -> Autopilot:
        """Start the engines in flight, and fly to the initial altitude until all is steady."""
        airframe, modes = self.airframe, GuidanceModes(self.kind)
        rate, wanted = initial.vertical_rate_m_s, initial.calibrated_airspeed_m_s
        before = initial.altitude_m - rate * SETTLING_TIME_S
        airframe.start(replace(initial, altitude_m=before), heading_rad)
        airframe.crank()
        lateral = modes.track(heading_rad)
        vertical = modes.initial_altitude(replace(initial, vertical_rate_m_s=0.0), 0.0)
        state = airframe.state()
        autopilot = Autopilot(airframe, self.kind, self.tick_s, state)
        for _ in range(round(SETTLING_TIME_S / self.tick_s)):
            autopilot.fly(
                state,
                lateral.turn_rate(state),
                rate or vertical.vertical_rate(state),
                wanted,
            )
            for _ in range(self.substeps):
                airframe.step()
            state = airframe.state()
        error = abs(state.calibrated_airspeed_m_s - wanted)
        if not error < SETTLED_SPEED_M_S:
            raise ModelError(
                f"{self.kind.name} cannot fly steadily at {wanted / KNOT:.0f} kt at "
                f"{state.altitude_m / FOOT:.0f} ft: it came to "
                f"{state.calibrated_airspeed_m_s / KNOT:.0f} kt"
            )
        return autopilot

    def _require_inside_envelope(
        self, initial: InitialCondition, terrain_elevation_m: float
    ) -> None:
        kind = self.kind
        ceiling = kind.speeds.service_ceiling_ft * FOOT
        if not terrain_elevation_m < initial.altitude_m <= ceiling:
            raise ValueError(
                f"altitude_m is {initial.altitude_m:.0f}; expected between the terrain at "
                f"{terrain_elevation_m:.0f} m and the service ceiling of {kind.name} at "
                f"{ceiling:.0f} m"
            )
        slowest, fastest = GuidanceModes(kind).speed_limits_m_s(initial.altitude_m)
        if initial.on_approach:
            slowest = kind.speeds.approach_kt * KNOT
        if not slowest <= initial.calibrated_airspeed_m_s <= fastest:
            raise ValueError(
                f"calibrated_airspeed_m_s is {initial.calibrated_airspeed_m_s:.1f}; expected "
                f"{slowest:.1f} to {fastest:.1f} for {kind.name} at "
                f"{initial.altitude_m:.0f} m"
            )


def heading_to_track(initial: InitialCondition, atmosphere: Atmosphere) -> float:
    """Return the heading (rad, in [-pi, pi)) that makes good the initial track in the wind.

    A wind across that is stronger than the airspeed raises ValueError.
    """
    airspeed = standard_atmosphere.true_airspeed(
        initial.calibrated_airspeed_m_s, initial.altitude_m
    )
    across = atmosphere.wind_east_m_s * math.cos(
        initial.track_rad
    ) - atmosphere.wind_north_m_s * math.sin(initial.track_rad)
    level = math.sqrt(max(airspeed**2 - initial.vertical_rate_m_s**2, 0.0))
    if abs(across) >= level:
        raise ValueError(
            f"the wind across the track is {abs(across):.1f} m/s, the true airspeed "
            f"{airspeed:.1f} m/s; expected more airspeed than wind"
        )
    return wrap_angle(initial.track_rad - math.asin(across / level))
