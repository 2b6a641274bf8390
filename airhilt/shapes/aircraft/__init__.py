"""Aircraft, lofted from the numbers of their ``aircraft/*.json``.

The origin is the reference point of the flight model: half the length behind the nose, and
``wheel_height_offset_m`` above the ground when the aircraft stands on its wheels.
"""

from __future__ import annotations

from airhilt.shapes.aircraft.engines import engine
from airhilt.shapes.aircraft.fuselage import cabin, fuselage, upper_deck
from airhilt.shapes.aircraft.gear import gear
from airhilt.shapes.aircraft.proportions import Proportions
from airhilt.shapes.aircraft.spec import AircraftShape
from airhilt.shapes.aircraft.surfaces import fin, strut, tailplane, wing
from airhilt.shapes.material import Material
from airhilt.shapes.mesh import Mesh, join


def aircraft_meshes(
    aircraft: AircraftShape, *, coarse: bool = False, livery: int = 0
) -> dict[str, Mesh]:
    """Return the meshes of a type, ``clean`` and with its ``gear`` down.

    Coarse ones are for pictures in which it is small. Liveries are counted from 0, again and again.
    """
    p = Proportions.of(aircraft, coarse, livery)
    right = [wing(p), tailplane(p)]
    parts = [fuselage(p), fin(p), *right, *(part.mirrored() for part in right)]
    parts += [engine(p, *place) for place in p.mesh.engines_m]
    if p.is_heavy:
        parts.append(upper_deck(p))
    if not p.is_jet:
        parts.append(cabin(p))
    if p.is_high_wing:
        parts += [strut(p), strut(p).mirrored()]
    meshes = {"clean": join(parts), "gear": join([*parts, *gear(p)])}
    return {name: mesh.made_of(Material.SKIN) for name, mesh in meshes.items()}
