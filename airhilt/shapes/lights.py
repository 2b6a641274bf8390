"""Points of light on aircraft and vehicles, in their own axes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from airhilt.shapes.aircraft.proportions import Proportions
from airhilt.shapes.aircraft.spec import AircraftShape
from airhilt.shapes.mesh import Colour, srgb
from airhilt.shapes.sizes import Size

WHITE = srgb(255, 244, 224)
GREEN = srgb(40, 255, 120)
RED = srgb(255, 40, 30)
BLUE = srgb(60, 90, 255)
AMBER = srgb(255, 170, 40)

NAVIGATION_CD = 40.0
"""Intensity of position lights ahead, in cd (14 CFR 25.1389)."""
BEACON_CD = 400.0
"""Least intensity of anticollision lights, in cd (14 CFR 25.1401(f))."""
STROBE_CD = 2000.0
"""Intensity of the strobes, in cd."""
LANDING_CD = 300_000.0
"""Intensity of all landing lights together, in cd."""
LANDING_BEAM = 60.0
"""Sharpness of a landing light's beam: half of the light lies within some 9 degrees."""
BEACON_HZ = 0.9
"""Frequency of the beacon of an aircraft, in Hz."""
STROBE_HZ = 1.0
"""Frequency of the strobes, in Hz: 14 CFR 25.1401(c) asks for 40 to 100 flashes a minute."""
FLASH_SHARE = 0.12
"""Share of a period in which a flashing light of an aircraft is on."""
ROOF_BEACON_HZ = 1.3
"""Frequency of the beacon on a vehicle, in Hz."""


class Light(NamedTuple):
    """A point of light.

    ``beam`` points where it shines most; None: it shines all round.
    """

    place_m: tuple[float, float, float]
    colour: Colour
    candela: float
    beam: tuple[float, float, float] | None = None
    beam_sharpness: float = LANDING_BEAM


def no_lights(_t_s: float, _lit: bool) -> Iterator[Light]:
    """Yield nothing: the lights of a body that has none."""
    return iter(())


def aircraft_lights(aircraft: AircraftShape, t_s: float, landing: bool) -> Iterator[Light]:
    """Yield the lights of an aircraft that are on at an instant."""
    half, at, tip_up = Proportions.of(aircraft).wing_tip
    length = aircraft.dimensions.length_m
    yield Light((-half, at, tip_up), RED, NAVIGATION_CD, (-0.7, 0.7, 0.0), 0.8)
    yield Light((half, at, tip_up), GREEN, NAVIGATION_CD, (0.7, 0.7, 0.0), 0.8)
    yield Light((0.0, -0.5 * length, 0.5), WHITE, NAVIGATION_CD, (0.0, -1.0, 0.0), 0.8)
    if (t_s * BEACON_HZ) % 1.0 < FLASH_SHARE:
        top = 0.6 * aircraft.mesh.fuselage_diameter_m + 0.3
        yield Light((0.0, 0.0, top), RED, BEACON_CD)
        yield Light((0.0, 0.0, -top), RED, BEACON_CD)
    if (t_s * STROBE_HZ + 0.5) % 1.0 < FLASH_SHARE:
        for side in (-1.0, 1.0):
            yield Light((side * half, at - 0.5, tip_up), WHITE, STROBE_CD)
    if landing:
        root = 0.14 * half if aircraft.category in ("jet", "heavy_jet") else 0.5 * half
        for side in (-1.0, 1.0):
            beam = (0.0, 0.998, -0.06)
            yield Light((side * root, 0.12 * length, -0.3), WHITE, LANDING_CD / 2.0, beam)


def vehicle_lights(size: Size, t_s: float) -> Iterator[Light]:
    """Yield the flashing beacon and the headlights of a vehicle that are on at an instant."""
    if (t_s * ROOF_BEACON_HZ) % 1.0 < 0.35:
        yield Light((0.0, 0.1 * size.length_m, size.height_m + 0.1), AMBER, 120.0)
    for side in (-0.35, 0.35):
        place = (side * min(size.span_m, 2.5), size.length_m / 2.0, 0.8)
        yield Light(place, WHITE, 8000.0, (0.0, 1.0, -0.03), 20.0)
