"""Where the bodies before cameras are at an instant.

A process that draws is told, and does without the world that this module brings in.
"""

from __future__ import annotations

from collections.abc import Iterable

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.units import SECOND_NS
from airhilt.world.actors.actor import Actor
from airhilt.world.flight import Aircraft
from airhilt.world.mover import ABSENT, carried_on

LANDING_LIGHTS_BELOW_M = 3048.0
"""Height, in m, below which landing lights are on: 10,000 ft, FAA AIM 4-3-23."""
LANDING_LIGHTS_ABOVE_M_S = 15.0
"""Ground speed, in m/s, above which landing lights are on: an aircraft that taxies has them off."""


def states_of(
    actors: Iterable[Actor], local_frame: LocalFrame, ground_m: float, now_ns: int, ticked_ns: int
) -> list[BodyState]:
    """Return where everybody is, in the axes of the scene; those that have ended stay there.

    The scene is flat: heights are altitudes less that of the ground, wherever that is. Between
    two actors at one height this leaves out the fall of the Earth, 0.04 degrees in 10 km.

    Parameters
    ----------
    ticked_ns
        Time of the control tick that their states are of: they have moved straight on since, and
        have the attitudes that they had then.
    """
    elapsed_s = (now_ns - ticked_ns) / SECOND_NS
    found = []
    for actor in actors:
        if actor.body.ended in ABSENT:
            continue
        body, callsign, shape = actor.body, actor.spec.callsign, actor.mesh(now_ns / SECOND_NS)
        state = carried_on(body.state, elapsed_s if body.ended is None else 0.0)
        east, north = local_frame.to_local((state.latitude_rad, state.longitude_rad))
        pitch = roll = 0.0
        heading, lit = state.heading_rad, True
        if isinstance(body, Aircraft):
            heading, pitch, roll = (
                body.state.heading_rad,
                body.state.pitch_rad,
                body.state.roll_rad,
            )
            lit = has_landing_lights_on(body.state.height_agl_m, state.ground_speed_m_s)
        up = state.altitude_m - ground_m
        found.append(BodyState(callsign, east, north, up, heading, pitch, roll, shape, lit))
    return found


def has_landing_lights_on(height_agl_m: float, ground_speed_m_s: float) -> bool:
    """Return whether an aircraft has its landing lights on."""
    return height_agl_m < LANDING_LIGHTS_BELOW_M and ground_speed_m_s > LANDING_LIGHTS_ABOVE_M_S
