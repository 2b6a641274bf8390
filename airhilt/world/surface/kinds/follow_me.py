"""A follow-me car."""

from airhilt.shapes import vehicles
from airhilt.shapes.sizes import Dimensions
from airhilt.world.surface.vehicle import VehicleKind

KIND = VehicleKind(
    name="follow_me",
    description="follow-me car with a light bar",
    source=(
        "Length, width and turning radius (centre line) of design vehicle P: AASHTO, A Policy on "
        "Geometric Design of Highways and Streets, 2004, exhibits 2-1 and 2-2. Height, speeds and "
        "accelerations are estimates."
    ),
    dimensions=Dimensions(length_m=5.8, span_m=2.1, height_m=1.9),
    mesh=vehicles.follow_me,
    label="truck",
    emitter_category="C2",
    cruise_m_s=11.0,
    maximum_m_s=33.0,
    acceleration_m_s2=2.0,
    braking_m_s2=4.0,
    lateral_m_s2=2.5,
    turning_radius_m=6.4,
)
