"""A white-tailed deer."""

from airhilt.shapes import animals
from airhilt.shapes.sizes import Dimensions
from airhilt.world.surface.animal import AnimalKind

KIND = AnimalKind(
    name="deer",
    description="white-tailed deer, Odocoileus virginianus",
    source=(
        "The most hazardous species to aircraft: FAA AC 150/5200-33C, table 1. 30 mph running: "
        "National Geographic, animal reference. Accelerations, walking and the flight from danger "
        "are estimates; that deer judge fast vehicles badly: B. F. Blackwell, T. W. Seamans and "
        "T. L. DeVault, PLoS ONE 9 (2014) e109988. "
        "Radar cross section: that of a person, which weighs as much (M. Skolnik, Introduction "
        "to Radar Systems, 3rd edition, table 2.2)."
    ),
    label="deer",
    dimensions=Dimensions(length_m=1.8, span_m=0.5, height_m=1.4),
    mesh=animals.deer,
    walk_m_s=1.4,
    run_m_s=13.4,
    acceleration_m_s2=4.0,
    lateral_m_s2=5.0,
    wander_rad=0.25,
    reaction_s=1.0,
    flees_for_m=150.0,
    radar_cross_section_m2=1.0,
)
