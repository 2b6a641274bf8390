"""Actors of a scenario: crews in aircraft, drivers in vehicles, wildlife."""

from airhilt.world.actors.actor import Actor, Reaction, Unable
from airhilt.world.actors.crew import Crew
from airhilt.world.actors.factory import build_actors

__all__ = ["Actor", "Crew", "Reaction", "Unable", "build_actors"]
