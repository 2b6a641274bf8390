"""A coyote."""

from airhilt.shapes import animals
from airhilt.shapes.sizes import Dimensions
from airhilt.world.surface.animal import AnimalKind

KIND = AnimalKind(
    name="coyote",
    description="coyote, Canis latrans",
    source=(
        "Listed as hazardous to aircraft: FAA AC 150/5200-33C, table 1. 40 mph running: National "
        "Geographic, animal reference. 1.2 m long with its tail, 0.6 m high at the shoulder. "
        "Accelerations, walking and the flight from danger are estimates. "
        "Radar cross section: that of a person (1 square metre; M. Skolnik, Introduction to "
        "Radar Systems, 3rd edition, table 2.2), by the 2/3 power of the mass."
    ),
    label="coyote",
    dimensions=Dimensions(length_m=1.2, span_m=0.3, height_m=0.7),
    mesh=animals.coyote,
    walk_m_s=1.6,
    run_m_s=17.9,
    acceleration_m_s2=4.5,
    lateral_m_s2=6.0,
    wander_rad=0.3,
    reaction_s=0.7,
    flees_for_m=120.0,
    radar_cross_section_m2=0.3,
)
