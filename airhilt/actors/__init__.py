"""Who acts in a scenario: aircraft with their crews."""

from airhilt.actors.crew import Crew, Reaction
from airhilt.actors.fleet import Flight, build_fleet

__all__ = ["Crew", "Flight", "Reaction", "build_fleet"]
