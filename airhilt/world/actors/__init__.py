"""Who acts in a scenario: crews in aircraft, drivers in vehicles, wildlife."""

from airhilt.world.actors.actor import Actor, Reaction, Unable
from airhilt.world.actors.building import Flight, build_actors
from airhilt.world.actors.crew import Crew

__all__ = ["Actor", "Crew", "Flight", "Reaction", "Unable", "build_actors"]
