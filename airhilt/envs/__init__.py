"""Environments of Gymnasium and PettingZoo for agents that learn: a run goes on step by step.

`RunEnv` has one agent and `ParallelRunEnv` several. An agent is the assistant, sits as a controller
at a unit, or flies an aircraft. It observes what it could know there, never the truth; its rewards
come from the truth.
"""

from __future__ import annotations

from airhilt.envs.manoeuvres import ClimbBy, Manoeuvre, TurnBy
from airhilt.envs.rewards import Rewards
from airhilt.errors import AirhiltError

try:
    from airhilt.envs.gymnasium_env import RunEnv
    from airhilt.envs.pettingzoo_env import ParallelRunEnv
except ModuleNotFoundError as error:
    raise AirhiltError(
        f"airhilt.envs needs {error.name}, which is not installed: pip install 'airhilt[rl]'"
    ) from error

__all__ = ["ClimbBy", "Manoeuvre", "ParallelRunEnv", "Rewards", "RunEnv", "TurnBy"]
