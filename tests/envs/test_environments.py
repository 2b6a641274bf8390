"""Agents take part in runs step by step, and know what they could know where they are."""

from __future__ import annotations

from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import airhilt
from airhilt import AirhiltError, Scenario
from airhilt.cosim.replay import replay
from airhilt.record import RunFolder, read_log

pytest.importorskip("gymnasium")
pytest.importorskip("pettingzoo")

from gymnasium.utils.env_checker import check_env
from pettingzoo.test import parallel_api_test, parallel_seed_test

from airhilt.envs import ClimbBy, ParallelRunEnv, Rewards, RunEnv

AGENTS = ("assistant", "tower", "AAL123")
OPTIONS: dict[str, Any] = {"cameras": False, "speech": False, "report": False, "latency": "fixed"}


def shortened(encounter: Scenario, duration_s: float = 8.0) -> Scenario:
    return encounter.model_copy(update={"duration_s": duration_s})


def with_actor(scenario: Scenario, callsign: str, **changes: Any) -> Scenario:
    actors = tuple(
        actor.model_copy(update=changes) if actor.callsign == callsign else actor
        for actor in scenario.actors
    )
    return scenario.model_copy(update={"actors": actors})


def fly(env: RunEnv, actions: dict[int, list[int]], seed: int = 3) -> list[tuple[Any, ...]]:
    """Return what came of the steps of an episode with actions at some of them, else none."""
    env.reset(seed=seed)
    steps: list[tuple[Any, ...]] = []
    while not steps or not (steps[-1][2] or steps[-1][3]):
        steps.append(env.step(actions.get(len(steps), [0] * len(env.aircraft))))
    env.close()
    return steps


@pytest.mark.parametrize("agent", AGENTS)
def test_gymnasium_finds_nothing_wrong_with_the_environment(
    agent: str, encounter: Scenario
) -> None:
    with closing(RunEnv(shortened(encounter), agent)) as env:
        check_env(env, skip_render_check=True)


def test_pettingzoo_finds_nothing_wrong_with_the_environment(
    encounter: Scenario, capsys: pytest.CaptureFixture[str]
) -> None:
    scenario = shortened(encounter, 3.0)
    with ExitStack() as stack:

        def made() -> ParallelRunEnv:
            return stack.enter_context(closing(ParallelRunEnv(scenario, AGENTS)))

        parallel_api_test(made(), num_cycles=20)
        parallel_seed_test(made, num_cycles=10)
    assert "Passed" in capsys.readouterr().out


def test_a_run_in_steps_leaves_the_log_of_a_whole_run(encounter: Scenario, tmp_path: Path) -> None:
    scenario = shortened(encounter)
    fly(RunEnv(scenario, step_s=0.33, out=tmp_path), {})
    whole = airhilt.run(scenario, out=tmp_path / "whole", seed=3, assistant="external", **OPTIONS)
    stepped = RunFolder.open(tmp_path / "episode-0")
    assert stepped.log_path.read_bytes() == (whole.folder / "log.mcap").read_bytes()
    assert stepped.info().phase == "finished"


@pytest.mark.parametrize(
    ("agent", "action", "key"),
    [
        ("assistant", [2, 0], "advisory/AAL123"),
        ("tower", [2, 0], "seat/Washington_Center/do"),
        ("AAL123", [2], "command/AAL123"),
    ],
)
def test_an_aircraft_does_what_the_agent_chooses_and_the_run_replays(
    agent: str, action: list[int], key: str, encounter: Scenario, tmp_path: Path
) -> None:
    steps = fly(RunEnv(encounter, agent, step_s=5.0, out=tmp_path), {1: action})
    folder = tmp_path / "episode-0"
    assert key in {logged.key for logged in read_log(folder / "log.mcap")}
    observations = [observation["traffic"][0, 3] for observation, *_ in steps]
    assert observations[-1] < observations[1] - 30.0
    assert sum(reward for _, reward, *_ in steps) == pytest.approx(-0.05)
    assert steps[-1][4]["summary"].duration_s == 30.0
    assert replay(folder).identical


def test_a_loss_of_separation_costs_what_the_rewards_say(encounter: Scenario) -> None:
    near = encounter.model_copy(update={"duration_s": 95.0})
    steps = fly(RunEnv(near, step_s=5.0, rewards=Rewards(loss_of_separation=-7.0)), {})
    lost = [info["t_s"] for _, reward, _, _, info in steps if reward == -7.0]
    assert len(lost) == 1
    assert 60.0 < lost[0] < 95.0


@pytest.mark.parametrize("agent", AGENTS)
def test_nobody_observes_an_aircraft_without_ads_b(agent: str, encounter: Scenario) -> None:
    spec = next(actor for actor in encounter.actors if actor.callsign == "DAL456")
    silent = spec.transponder.model_copy(update={"mode": "C"})
    scenario = with_actor(shortened(encounter), "DAL456", transponder=silent)
    observation = fly(RunEnv(scenario, agent), {})[-1][0]
    assert list(observation["traffic"][:, 0]) == [1.0, 0.0]


def test_a_pilot_without_a_receiver_observes_the_own_aircraft_alone(encounter: Scenario) -> None:
    scenario = with_actor(shortened(encounter), "AAL123", adsb_in=False)
    *_, last = fly(RunEnv(scenario, "AAL123"), {})
    assert list(last[0]["traffic"][:, 0]) == [1.0, 0.0]
    assert last[0]["own"][1] == pytest.approx(35_000 * 0.3048, abs=100.0)


def test_calls_are_observed_once_in_their_own_step(encounter: Scenario) -> None:
    steps = fly(RunEnv(shortened(encounter, 15.0)), {})
    calls = [observation["calls"] for observation, *_ in steps if observation["calls"]]
    assert calls == ["Washington Center, American one two three, flight level three five zero."]


def test_a_reset_in_the_middle_leaves_a_run_that_replays(
    encounter: Scenario, tmp_path: Path
) -> None:
    env = RunEnv(encounter, step_s=2.0, manoeuvres=(ClimbBy(2000.0),), out=tmp_path)
    for _ in range(2):
        env.reset(seed=1)
        for action in ([0, 0], [1, 0], [0, 0]):
            env.step(np.array(action))
    env.close()
    info = RunFolder.open(tmp_path / "episode-1").info()
    assert (info.phase, info.cause) == ("stopped", "its agents have left it")
    assert replay(tmp_path / "episode-0").identical


def test_what_cannot_be_is_refused_in_one_line(encounter: Scenario) -> None:
    with pytest.raises(AirhiltError, match="agent 'UAL9': 'encounter' has none of that name"):
        RunEnv(encounter, "UAL9")
    with pytest.raises(AirhiltError, match=r"step_s 0\.01: expected at least 0\.05"):
        RunEnv(encounter, step_s=0.01)
    with pytest.raises(AirhiltError, match="no episode goes on; expected reset"):
        RunEnv(encounter).step([0, 0])
