"""A tug with an airliner in tow."""

from __future__ import annotations

from airhilt.shapes import vehicles
from airhilt.shapes.mesh import Mesh
from airhilt.shapes.sizes import Dimensions, Size
from airhilt.world.flight.aircraft_type import load_aircraft_type
from airhilt.world.surface.vehicle import VehicleKind


def _mesh(size: Size) -> Mesh:
    return vehicles.tug_with_aircraft(size, load_aircraft_type("737"))


KIND = VehicleKind(
    name="tug_with_aircraft",
    description="tug with a towbar and a Boeing 737-800 behind it, as one rigid body",
    source=(
        "The aircraft is 39.5 m long, 35.8 m wide and 12.5 m high: Boeing D6-58325-6, 737 Airplane "
        "Characteristics for Airport Planning, section 2.2; a tug and its towbar add 10 m. 25 km/h "
        "is the limit for towing an A320 on a towbar by its maintenance manual, chapter 9. "
        "Accelerations and the turning radius are estimates."
    ),
    dimensions=Dimensions(length_m=49.5, span_m=35.8, height_m=12.5),
    mesh=_mesh,
    label="airplane",  # What is seen of it is the aircraft.
    emitter_category="C2",
    cruise_m_s=4.0,
    maximum_m_s=6.9,
    acceleration_m_s2=0.3,
    braking_m_s2=1.0,
    lateral_m_s2=0.5,
    turning_radius_m=20.0,
)
