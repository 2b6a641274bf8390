"""A Canada goose."""

from airhilt.shapes import animals
from airhilt.shapes.sizes import Dimensions
from airhilt.world.surface.animal import AnimalKind, Flight

KIND = AnimalKind(
    name="goose",
    description="Canada goose, Branta canadensis",
    source=(
        "Among the most hazardous birds: FAA AC 150/5200-33C, table 1. Length and wing span: "
        "Cornell Lab of Ornithology, All About Birds. 17.3 m/s is the airspeed of brent geese in "
        "autumn: M. Green and T. Alerstam, Journal of Avian Biology 31 (2000) 215-225. Geese climb "
        "less than 1 m/s for long (A. Hedenström and T. Alerstam, Journal of Experimental Biology "
        "164 (1992) 19-38). About 4 wing beats a second: C. J. Pennycuick, Journal of Experimental "
        "Biology 150 (1990) 171. 1.5 m/s for the short flights here, and all else, are estimates. "
        "Radar cross section: that of the standard avian target (0.025 square metres, 0.5 kg; "
        "FAA AC 150/5220-25), by the 2/3 power of the mass."
    ),
    label="bird",
    dimensions=Dimensions(length_m=1.0, span_m=0.4, height_m=0.9),
    mesh=animals.goose,
    walk_m_s=0.8,
    run_m_s=3.0,
    acceleration_m_s2=2.5,
    lateral_m_s2=3.0,
    wander_rad=0.15,
    reaction_s=1.0,
    flees_for_m=300.0,
    radar_cross_section_m2=0.1,
    flight=Flight(
        dimensions=Dimensions(length_m=1.0, span_m=1.6, height_m=0.5),
        mesh=animals.goose,
        wing_beats_hz=4.0,
        speed_m_s=17.3,
        acceleration_m_s2=3.0,
        lateral_m_s2=5.0,
        climb_m_s=1.5,
        descent_m_s=3.0,
        height_m=30.0,
    ),
)
