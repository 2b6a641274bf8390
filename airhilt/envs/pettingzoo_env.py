"""The environment of PettingZoo: several agents in one run, which choose at the same time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from gymnasium import spaces
from pettingzoo import ParallelEnv

from airhilt.cosim.observer import Observer
from airhilt.envs.episode import Choices, plan_of
from airhilt.envs.episodes import Episodes
from airhilt.envs.gymnasium_env import SEEDS
from airhilt.envs.manoeuvres import Manoeuvre
from airhilt.envs.rewards import Rewards
from airhilt.envs.spaces import action_space, observation_space
from airhilt.scenario import Scenario


class ParallelRunEnv(ParallelEnv[str, dict[str, Any], Any]):
    """A run with several agents; each observes, chooses and is told as the one of `RunEnv`.

    All share what becomes true, and each has the reward of its own manoeuvres.

    Parameters
    ----------
    agents
        Names as `RunEnv` takes one; None: the pilots of all aircraft of the briefing.
    scenario, step_s, manoeuvres, rewards, out, observer, options
        As of `RunEnv`.

    Raises
    ------
    AirhiltError
        Something that was given is wrong.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": [], "name": "airhilt_run_v0"}

    def __init__(
        self,
        scenario: Scenario | str | Path = "s02a_headon",
        agents: Sequence[str] | None = None,
        *,
        step_s: float = 0.25,
        manoeuvres: Sequence[Manoeuvre] | None = None,
        rewards: Rewards | None = None,
        out: str | Path | None = None,
        observer: Observer | None = None,
        **options: Any,
    ) -> None:
        self.render_mode = None
        plan = plan_of(
            scenario,
            agents,
            step_s=step_s,
            manoeuvres=manoeuvres,
            rewards=rewards,
            options=options,
        )
        self._episodes = Episodes(plan, out, observer)
        self._np_random = np.random.default_rng()
        self.callsigns = plan.callsigns
        self.possible_agents = list(plan.names)
        self.agents: list[str] = []
        self._observation_spaces = {name: observation_space(plan, name) for name in plan.names}
        self._action_spaces = {name: action_space(plan, name) for name in plan.names}

    def observation_space(self, agent: str) -> spaces.Dict:
        """Return the space of what an agent observes."""
        return self._observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.MultiDiscrete:
        """Return the space of what an agent chooses."""
        return self._action_spaces[agent]

    def reset(
        self,
        seed: int | None = None,
        options: dict[str, Any] | None = None,  # noqa: ARG002
    ) -> tuple[dict[str, dict[str, Any]], dict[str, dict[str, Any]]]:
        """Begin the run of a seed, or of one that is drawn."""
        if seed is not None:
            self._np_random = np.random.default_rng(seed)
        drawn = int(self._np_random.integers(SEEDS)) if seed is None else seed
        stepped = self._episodes.reset(drawn)
        self.agents = list(self.possible_agents)
        return stepped.observations, stepped.infos

    def step(
        self, actions: Mapping[str, Choices]
    ) -> tuple[
        dict[str, dict[str, Any]],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Let all agents choose manoeuvres, and let the run go on by a step."""
        if not self.agents:
            return {}, {}, {}, {}, {}
        stepped = self._episodes.running.step(actions)
        names = self.agents
        if stepped.is_over:
            self.agents = []
        return (
            stepped.observations,
            stepped.rewards,
            dict.fromkeys(names, stepped.terminated),
            dict.fromkeys(names, stepped.truncated),
            stepped.infos,
        )

    def close(self) -> None:
        """End the run."""
        self._episodes.close()
