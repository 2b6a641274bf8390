"""True states of actors as messages, and separation minima."""

from __future__ import annotations

from airhilt.geodesy.relative_motion import Minima
from airhilt.messages import ActorTruth
from airhilt.scenario.models import Separation, WildlifeSpec
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, bearing_degrees
from airhilt.world.actors import Actor
from airhilt.world.flight import Aircraft
from airhilt.world.site import FixedSite, ScenarioSite


def truth_of(actor: Actor, now_ns: int) -> ActorTruth:
    """Return the true state of an actor."""
    body, spec = actor.body, actor.spec
    state = body.state
    flown: dict[str, float] = {}
    if isinstance(body, Aircraft):
        flown = {
            "roll_deg": body.state.roll_rad / DEGREE,
            "pitch_deg": body.state.pitch_rad / DEGREE,
            "true_airspeed_m_s": body.state.true_airspeed_m_s,
            "calibrated_airspeed_m_s": body.state.calibrated_airspeed_m_s,
            "target_altitude_m": body.target_altitude_m,
        }
    return ActorTruth(
        t_ns=now_ns,
        actor=spec.callsign,
        category=actor.category,
        icao24=None if isinstance(spec, WildlifeSpec) else spec.icao24,
        phase=body.phase,
        on_ground=body.on_ground,
        latitude_deg=state.latitude_rad / DEGREE,
        longitude_deg=state.longitude_rad / DEGREE,
        altitude_m=state.altitude_m,
        height_agl_m=state.height_agl_m,
        velocity_north_m_s=state.velocity_north_m_s,
        velocity_east_m_s=state.velocity_east_m_s,
        velocity_down_m_s=state.velocity_down_m_s,
        heading_deg=bearing_degrees(state.heading_rad),
        **flown,
    )


def minima_of(separation: Separation) -> Minima:
    """Return the separation minima with their tolerance."""
    return Minima(
        separation.horizontal_nm * NAUTICAL_MILE,
        (separation.vertical_ft - separation.level_tolerance_ft) * FOOT,
    )


def zone_of(site: ScenarioSite) -> FixedSite | None:
    """Return the centre of the tower's zone, if there is an airport."""
    if site.layout is None:
        return None
    centre = site.layout.local_frame.to_place(0.0, 0.0)
    return FixedSite(*centre, altitude_m=site.ground_m)
