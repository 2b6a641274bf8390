"""The environment of Gymnasium: one agent in a run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import gymnasium

from airhilt.cosim.observer import Observer
from airhilt.envs.agents import ASSISTANT
from airhilt.envs.episode import Choices, plan_of
from airhilt.envs.episodes import Episodes
from airhilt.envs.manoeuvres import Manoeuvre
from airhilt.envs.rewards import Rewards
from airhilt.envs.spaces import action_space, observation_space
from airhilt.scenario import Scenario

SEEDS = 2**31
"""Number of seeds from which that of a run is drawn where none is given."""


class RunEnv(gymnasium.Env[dict[str, Any], Any]):
    """A run with one agent.

    The observation has ``traffic`` (a row for each aircraft of ``callsigns``; its columns are
    `airhilt.envs.perception.TRAFFIC`), ``calls`` (words of the radio in the step), and for a pilot
    ``own`` (`airhilt.envs.perception.OWN`). An action has a number for each aircraft of
    ``aircraft``: 0, or the number of a manoeuvre from 1 on. The info has the time ``t_s``, the
    ``messages`` that the agent perceived, the ``conflicts`` that the rewards are made of, and after
    the last step the ``summary`` of the run.

    ``reset(seed=n)`` begins the run of seed n.

    Parameters
    ----------
    scenario
        A scenario, or what `airhilt.load` takes.
    agent
        ``assistant`` gives advisories to crews, ``tower`` or the name of a unit instructions by
        radio, and a callsign commands to its own aircraft.
    step_s
        Simulated time of a step, in s.
    manoeuvres
        Manoeuvres to choose from; None: one level up or down, 30 degrees left or right.
    rewards
        Weights of the rewards.
    out
        Folder in which the run folders of the episodes stay; None: they are deleted.
    observer
        Is told how the runs are doing.
    options
        Fields of `airhilt.Options` for the runs.

    Raises
    ------
    AirhiltError
        Something that was given is wrong.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012

    def __init__(
        self,
        scenario: Scenario | str | Path = "s02a_headon",
        agent: str = ASSISTANT,
        *,
        step_s: float = 0.25,
        manoeuvres: Sequence[Manoeuvre] | None = None,
        rewards: Rewards | None = None,
        out: str | Path | None = None,
        observer: Observer | None = None,
        **options: Any,
    ) -> None:
        plan = plan_of(
            scenario,
            (agent,),
            step_s=step_s,
            manoeuvres=manoeuvres,
            rewards=rewards,
            options=options,
        )
        (self._name,) = plan.names
        self._episodes = Episodes(plan, out, observer)
        self.callsigns = plan.callsigns
        self.aircraft = plan.aircraft(self._name)
        self.observation_space = observation_space(plan, self._name)
        self.action_space = action_space(plan, self._name)

    def reset(
        self,
        *,
        seed: int | None = None,
        options: dict[str, Any] | None = None,  # noqa: ARG002
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin the run of a seed, or of one that is drawn."""
        super().reset(seed=seed)
        drawn = int(self.np_random.integers(SEEDS)) if seed is None else seed
        stepped = self._episodes.reset(drawn)
        return stepped.observations[self._name], stepped.infos[self._name]

    def step(self, action: Choices) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Choose manoeuvres, and let the run go on by a step."""
        name = self._name
        stepped = self._episodes.running.step({name: action})
        return (
            stepped.observations[name],
            stepped.rewards[name],
            stepped.terminated,
            stepped.truncated,
            stepped.infos[name],
        )

    def close(self) -> None:
        """End the run."""
        self._episodes.close()
