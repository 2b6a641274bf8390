"""Flight: JSBSim aircraft under guidance.

Two names matter: `load_aircraft_type` reads one of the ``aircraft/*.json``, `Aircraft` flies it.
"""

from airhilt.flight.aircraft import Aircraft
from airhilt.flight.aircraft_type import AircraftType, load_aircraft_type
from airhilt.flight.guidance import AltitudeClearance
from airhilt.flight.model import ModelError
from airhilt.flight.state import AircraftState, Atmosphere, InitialCondition

__all__ = [
    "Aircraft",
    "AircraftState",
    "AircraftType",
    "AltitudeClearance",
    "Atmosphere",
    "InitialCondition",
    "ModelError",
    "load_aircraft_type",
]
