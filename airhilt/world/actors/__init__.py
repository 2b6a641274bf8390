"""Who acts in a scenario: crews in aircraft, drivers in vehicles, wildlife."""

from airhilt.world.actors.actor import Performer, Reaction, Unable
from airhilt.world.actors.building import Flight, build_cast
from airhilt.world.actors.crew import Crew

__all__ = ["Crew", "Flight", "Performer", "Reaction", "Unable", "build_cast"]
