"""A plough, sweeper and blower for runways."""

from airhilt.shapes import vehicles
from airhilt.shapes.sizes import Dimensions
from airhilt.world.surface.vehicle import VehicleKind

KIND = VehicleKind(
    name="snow_plough",
    description="truck with a plough and a towed sweeper and blower, at work",
    source=(
        "The plough is 7.2 m wide: Flughafen Berlin Brandenburg, press release of 4 November 2014. "
        "60 km/h at work: Øveraasen RS 400 at Paderborn-Lippstadt, Flug Revue. Length, height, "
        "accelerations and the turning radius are estimates."
    ),
    dimensions=Dimensions(length_m=21.0, span_m=7.2, height_m=3.6),
    mesh=vehicles.snow_plough,
    label="truck",
    emitter_category="C2",
    cruise_m_s=11.0,
    maximum_m_s=16.7,
    acceleration_m_s2=0.6,
    braking_m_s2=3.0,
    lateral_m_s2=1.5,
    turning_radius_m=14.0,
)
