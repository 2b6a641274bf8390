"""One run that goes on step by step, with agents in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from airhilt.cosim.observer import Observer
from airhilt.cosim.setup import TICK_S
from airhilt.cosim.simulation import connected
from airhilt.envs.agents import aircraft_of, make_agents, named, options_for
from airhilt.envs.manoeuvres import MANOEUVRES, Manoeuvre
from airhilt.envs.perception import Perception
from airhilt.envs.rewards import Rewards
from airhilt.errors import AirhiltError
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.messages import ConflictTruth, Message
from airhilt.metrics.summary import Summary
from airhilt.options import Options, options_of
from airhilt.scenario import Scenario
from airhilt.sim.payload import Payload
from airhilt.units import DEGREE, SECOND_NS, seconds_to_ns
from airhilt.world.loading import load

Choices = Sequence[int] | NDArray[np.integer[Any]]
"""For each aircraft of an agent, in their order: 0 for none, else the number of a manoeuvre."""
LEFT = "its agents have left it"
"""Cause of the end of a run that is reset, or closed, before its end."""


@dataclass(frozen=True)
class Plan:
    """Settings that all episodes of an environment have in common.

    Attributes
    ----------
    names
        Names of the agents.
    callsigns
        Aircraft of the briefing: the rows of the traffic, and whom manoeuvres are for.
    """

    scenario: Scenario
    names: tuple[str, ...]
    callsigns: tuple[str, ...]
    step_ns: int
    manoeuvres: tuple[Manoeuvre, ...]
    rewards: Rewards
    options: Options

    def aircraft(self, name: str) -> tuple[str, ...]:
        """Return the callsigns of the aircraft whose manoeuvres an agent chooses."""
        return (name,) if name in self.callsigns else self.callsigns


def plan_of(
    scenario: Scenario | str | Path,
    agents: Sequence[str] | None,
    *,
    step_s: float,
    manoeuvres: Sequence[Manoeuvre] | None,
    rewards: Rewards | None,
    options: Mapping[str, Any],
) -> Plan:
    """Return the plan of episodes; without agents, of the pilots of all aircraft of the briefing.

    Without other options their runs have no cameras, no speech and no report, fixed latencies, and
    no assistant but the agent.

    Raises
    ------
    AirhiltError
        Something that was given is wrong.
    """
    if step_s < TICK_S:
        raise AirhiltError(f"step_s {step_s!r}: expected at least {TICK_S}, a tick of the aircraft")
    loaded = scenario if isinstance(scenario, Scenario) else load(scenario)
    names = named(aircraft_of(loaded) if agents is None else agents, loaded)
    given = {
        "cameras": False,
        "speech": False,
        "report": False,
        "latency": "fixed",
        "pace": "virtual",
        **options_for(names, loaded),
        **options,
    }
    return Plan(
        loaded,
        names,
        aircraft_of(loaded),
        seconds_to_ns(step_s),
        tuple(MANOEUVRES if manoeuvres is None else manoeuvres),
        rewards or Rewards(),
        options_of(given),
    )


@dataclass(frozen=True)
class Stepped:
    """Outcome of a step, by agent where agents differ."""

    observations: dict[str, dict[str, Any]]
    rewards: dict[str, float]
    terminated: bool
    truncated: bool
    infos: dict[str, dict[str, Any]]

    @property
    def is_over(self) -> bool:
        """True if the run has ended."""
        return self.terminated or self.truncated


class Episode:
    """A run that stands still between two steps.

    Parameters
    ----------
    out
        Its run folder.
    """

    def __init__(self, plan: Plan, seed: int, out: Path, observer: Observer) -> None:
        options = plan.options.model_copy(update={"seed": seed, "out": out})
        self._plan = plan
        self._stack = ExitStack()
        self._simulation = self._stack.enter_context(connected(plan.scenario, options, observer))
        setup = self._simulation.setup
        centre = setup.site.centre
        frame = LocalFrame((centre.lat_deg * DEGREE, centre.lon_deg * DEGREE), setup.site.ground_m)
        self._perceptions = {
            name: Perception(plan.callsigns, frame, has_instruments=name in plan.callsigns)
            for name in plan.names
        }
        self._agents = make_agents(plan.names, setup, self._perceptions)
        self._conflicts: list[ConflictTruth] = []
        self._steps = 0
        self._ends_ns = seconds_to_ns(setup.scenario.duration_s)
        self.is_over = False
        """True once the run has ended."""
        self.summary: Summary | None = None
        """Summary of the run once it has ended, if nothing failed."""
        self._simulation.router.listeners.append(self._hear)
        self._simulation.router.observers.append(self._note)

    def begin(self) -> Stepped:
        """Let the run begin, and the agents observe its first instant."""
        for agent in self._agents.values():
            for key, message in agent.begin():
                self._simulation.post(key, message)
        return self._advanced(dict.fromkeys(self._agents, 0))

    def step(self, choices: Mapping[str, Choices]) -> Stepped:
        """Let agents choose a manoeuvre for each of their aircraft, and the run go on by a step.

        Parameters
        ----------
        choices
            Choices of each agent, by its name.
        """
        chosen = dict.fromkeys(self._agents, 0)
        for name, numbers in choices.items():
            agent = self._agents[name]
            for callsign, number in zip(agent.aircraft, numbers, strict=True):
                if number:
                    for key, message in agent.choose(callsign, self._plan.manoeuvres[number - 1]):
                        chosen[name] += 1
                        self._simulation.post(key, message)
        self._steps += 1
        return self._advanced(chosen)

    def _advanced(self, chosen: Mapping[str, int]) -> Stepped:
        """Go on to the end of the step, and return what came of it."""
        now_ns = self._steps * self._plan.step_ns
        goes_on = self._simulation.advance(now_ns)
        if not goes_on:
            self._finish()
        conflicts, self._conflicts = tuple(self._conflicts), []
        observations, infos = {}, {}
        for name, perception in self._perceptions.items():
            messages = perception.messages()
            observations[name] = perception.observation(now_ns, messages)
            infos[name] = {"t_s": now_ns / SECOND_NS, "messages": messages, "conflicts": conflicts}
            if self.summary is not None:
                infos[name]["summary"] = self.summary
        is_at_end = not goes_on and now_ns >= self._ends_ns
        return Stepped(
            observations,
            {name: self._plan.rewards.of(conflicts, number) for name, number in chosen.items()},
            terminated=not goes_on and not is_at_end,
            truncated=is_at_end,
            infos=infos,
        )

    def close(self) -> None:
        """End the run, if it goes on."""
        if not self.is_over:
            self._finish(LEFT)

    def _finish(self, cause: str = "") -> None:
        self.is_over = True
        with self._stack:
            self.summary = self._simulation.finish(cause).summary

    def _hear(self, key: str, message: Message, payload: Payload) -> None:  # noqa: ARG002
        """Let the agents perceive what they could know of."""
        for name, agent in self._agents.items():
            if agent.perceives(key, message):
                self._perceptions[name].take(key, message)

    def _note(self, key: str, message: Message, payload: Payload) -> None:  # noqa: ARG002
        """Note what becomes true, for the rewards."""
        if isinstance(message, ConflictTruth):
            self._conflicts.append(message)
