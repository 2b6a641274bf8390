"""Who acts in a scenario: crews in aircraft, drivers in vehicles, wildlife."""

from airhilt.actors.cast import Flight, build_cast
from airhilt.actors.crew import Crew
from airhilt.actors.performer import Performer, Reaction, Unable

__all__ = ["Crew", "Flight", "Performer", "Reaction", "Unable", "build_cast"]
