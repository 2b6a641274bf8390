"""Stand-ins for the parts of an aircraft, and its state at a place, without flight dynamics."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from airhilt.geodesy.wgs84 import Place, earth_centred, vertical
from airhilt.world.flight.state import AircraftState


class StandIn:
    """An airframe, autopilot or ground law that answers what it is told to, and keeps what it gets.

    ``got`` has the arguments of the last call of each method, and ``named`` those by name.
    """

    wheelbase_m = 15.0
    level_angle_of_attack = 0.0

    def __init__(self, **answers: float) -> None:
        self.answers = answers
        self.got: dict[str, tuple[Any, ...]] = {}
        self.named: dict[str, dict[str, Any]] = {}

    def __getattr__(self, name: str) -> Callable[..., Any]:
        def call(*arguments: Any, **named: Any) -> float:
            self.got[name], self.named[name] = arguments, named
            return self.answers.get(name, 0.0)

        return call


def state_at(
    place: Place = (0.0, 0.0), *, altitude_m: float = 100.0, speed_m_s: float = 70.0,
    track_rad: float = 0.0, rate_m_s: float = 0.0, **changes: float,
) -> AircraftState:  # fmt: skip
    """Return the state of an aircraft that flies along its heading over ground at sea level."""
    x, y, z = (
        surface + altitude_m * up
        for surface, up in zip(earth_centred(place), vertical(place), strict=True)
    )
    return AircraftState(
        latitude_rad=place[0],
        longitude_rad=place[1],
        altitude_m=altitude_m,
        height_agl_m=altitude_m,
        velocity_north_m_s=speed_m_s * math.cos(track_rad),
        velocity_east_m_s=speed_m_s * math.sin(track_rad),
        velocity_down_m_s=-rate_m_s,
        roll_rad=0.0,
        pitch_rad=0.0,
        heading_rad=track_rad % math.tau,
        true_airspeed_m_s=math.hypot(speed_m_s, rate_m_s),
        calibrated_airspeed_m_s=speed_m_s,
        mach=speed_m_s / 340.0,
        ecef_x_m=x,
        ecef_y_m=y,
        ecef_z_m=z,
    )._replace(**changes)
