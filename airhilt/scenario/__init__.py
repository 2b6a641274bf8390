"""The scenario file: its models, reading it, its failures and its seeded perturbation.

Nothing here knows the world. `airhilt.world.loading` loads a scenario and checks that the world can
hold it.
"""

from airhilt.scenario.models import Scenario

__all__ = ["Scenario"]
