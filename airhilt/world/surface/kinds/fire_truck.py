"""An aircraft rescue and fire fighting vehicle."""

from airhilt.shapes import vehicles
from airhilt.shapes.sizes import Dimensions
from airhilt.world.surface.vehicle import VehicleKind

KIND = VehicleKind(
    name="fire_truck",
    description="airport fire truck, 8x8, on its way to an emergency",
    source=(
        "Size, 0 to 80 km/h in 25 s and 140 km/h: Rosenbauer Panther 8x8 (MAN 36.1000), "
        "as published. Braking (40 mph to 0 within 131 ft) and turning (wall to wall within "
        "three times the length): NFPA 414, as FAA AC 150/5220-10E asks for. The acceleration "
        "across and the speed driven are estimates."
    ),
    dimensions=Dimensions(length_m=11.78, span_m=3.09, height_m=3.4),
    mesh=vehicles.fire_truck,
    label="truck",
    emitter_category="C1",
    cruise_m_s=22.0,
    maximum_m_s=38.9,
    acceleration_m_s2=0.89,
    braking_m_s2=4.0,
    lateral_m_s2=2.0,
    turning_radius_m=16.0,
)
