"""Reports: what somebody says of itself when it is asked to."""

from __future__ import annotations

import math
import re
from typing import NamedTuple

from airhilt.geodesy.wgs84 import Place, distance_and_azimuth
from airhilt.phraseology.numbers import Style, speak_digits, speak_group, speak_thousands
from airhilt.phraseology.say import speak_altitude, speak_heading, speak_runway, speak_speed
from airhilt.phraseology.spoken_actions import speak_place
from airhilt.phraseology.spoken_forms import is_registration
from airhilt.phraseology.spoken_values import speak_mach, speak_taxiway
from airhilt.units import FOOT, KNOT, NAUTICAL_MILE, POUND
from airhilt.world.actors.actor import Actor
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.site import ScenarioSite

COMPASS = (
    "north", "northeast", "east", "southeast", "south", "southwest", "west", "northwest",
)  # fmt: skip
"""Points of the compass, from north clockwise."""
LONGEST_DESIGNATOR = 3
"""Number of signs of the longest designator of a taxiway; a longer one is a name, such as ramp."""
IN_SIGHT_M = 10.0 * NAUTICAL_MILE
"""Distance within which a crew has the field in sight: an assumption."""


class Field(NamedTuple):
    """The field that reports are about."""

    site: ScenarioSite
    place: Place
    variation_deg: float
    """Magnetic variation, in degrees, positive east."""


def report_of(actor: Actor, asked: str, field: Field, style: Style) -> str | None:
    """Return what an actor says when it is asked for something; None if it does not know."""
    state, runway = actor.body.state, actor.bound_runway
    match asked.split():
        case [*_, "altitude" | "level" | "height"]:
            return speak_altitude(round(state.altitude_m / FOOT, -2), style)
        case [*_, "heading" | "track"]:
            degrees = math.degrees(state.track_rad) - field.variation_deg
            return f"heading {speak_heading(degrees % 360.0, style)}"
        case [*_, "speed" | "airspeed"]:
            return speak_speed(round(_speed_m_s(actor) / KNOT), style)
        case [*_, "position" | "location"]:
            return _position_on_ground(actor, field, style) or _position(actor, field)
        case ["intentions"] if runway is not None:
            return f"{'to' if actor.body.on_ground else 'landing'} {speak_runway(runway, style)}"
        case [*_, "type"]:
            return _type(actor, style)
        case ["registration"] if is_registration(actor.spec.callsign):
            return "registration as callsign"
        case ["mach", *_] if isinstance(actor.body, Aircraft):
            return speak_mach(round(actor.body.state.mach, 2), style)
        case ["fuel" | "remaining", *_] if isinstance(actor.body, Aircraft):
            fuel_kg = actor.body.fuel_kg
            return None if fuel_kg is None else f"fuel remaining {_pounds(fuel_kg, style)}"
        case ["field" | "airport" | "aerodrome" | "runway" as seen, "in", "sight"]:
            return f"{seen} in sight" if _distance(actor, field)[0] < IN_SIGHT_M else None
        case ["traffic", "in", "sight"]:
            return "traffic not in sight"
        case ["ready"]:
            return "ready"
    return None


def _distance(actor: Actor, field: Field) -> tuple[float, float]:
    state = actor.body.state
    return distance_and_azimuth(field.place, (state.latitude_rad, state.longitude_rad))


def _position(actor: Actor, field: Field) -> str:
    distance_m, bearing_rad = _distance(actor, field)
    miles = round(distance_m / NAUTICAL_MILE)
    way = COMPASS[round(bearing_rad / (math.pi / 4.0)) % 8]
    return f"{miles} miles {way} of the field" if miles else "at the field"


def _position_on_ground(actor: Actor, field: Field, style: Style) -> str | None:
    """Return the runway, the stand or the taxiway on which somebody is; None elsewhere."""
    layout, here = field.site.layout, actor.body.state.place
    if layout is None or not actor.body.on_ground:
        return None
    if runway := layout.runway_at(here):
        return f"on {speak_runway(runway, style)}"
    if stand := layout.stand_at(here):
        named = [word.upper() if word[-1:].isdigit() else word for word in stand.split("_")]
        return f"at {speak_place(' '.join(named), style)}"
    taxiway = layout.taxiway_at(here)
    if taxiway is None:
        return None
    is_lettered = len(taxiway) <= LONGEST_DESIGNATOR
    words = f"taxiway {speak_taxiway(taxiway, style)}" if is_lettered else f"the {taxiway}"
    return f"on {words}"


def _type(actor: Actor, style: Style) -> str:
    """Return the maker and the model of an aircraft, or the kind of a vehicle."""
    if not isinstance(actor.body, Aircraft):
        return actor.category
    model = re.match(r"([A-Za-z]+) ([0-9]+)", actor.body.kind.description)
    if model is None:
        return " ".join(actor.body.kind.icao_designator)
    return f"{model[1]} {speak_group(int(model[2]), style)}"


def _pounds(mass_kg: float, style: Style) -> str:
    pounds = round(mass_kg / POUND)
    if pounds < 1000:
        return f"{speak_digits(str(pounds), style)} pounds"
    return f"{speak_thousands(pounds, style)} pounds"


def _speed_m_s(actor: Actor) -> float:
    """Return the airspeed of an aircraft in the air, or the speed of others over the ground."""
    body = actor.body
    if isinstance(body, Aircraft) and not body.on_ground:
        return body.state.calibrated_airspeed_m_s
    return body.state.ground_speed_m_s
