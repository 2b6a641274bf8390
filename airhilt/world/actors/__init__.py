"""Actors of a scenario: crews in aircraft, drivers in vehicles, wildlife."""

from airhilt.world.actors.actor import Actor, Reaction, Unable
from airhilt.world.actors.crew import Crew
from airhilt.world.actors.factory import build_actors
from airhilt.world.actors.flight import Flight

__all__ = ["Actor", "Crew", "Flight", "Reaction", "Unable", "build_actors"]
