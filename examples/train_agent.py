"""Train an assistant to keep two aircraft apart with few words, by the cross-entropy method.

    pip install 'airhilt[rl]'
    python examples/train_agent.py --generations 8 --out agent.json --figure curve.svg

Two airliners fly towards each other and would meet in 95 s. Every 10 s the agent tells each of
them to climb, to descend, or nothing. A loss of separation costs 1, and each advisory 0.05. What it
decides by is linear in three features of the ADS-B reports. It is compared on seeds that it was not
trained on with saying nothing, and with the reference assistant.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

import airhilt
from airhilt import Scenario
from airhilt.envs import ClimbBy, RunEnv
from airhilt.messages import Advisory

DISTANCE_NM = 12.0
"""Distance of each aircraft from the place where they would meet."""
STEP_S = 10.0
MANOEUVRES = (ClimbBy(1000.0), ClimbBy(-1000.0))
FEATURES = 3
CANDIDATES, ELITE = 10, 2
TRAINING_SEEDS, HELD_OUT_SEEDS = 100_000, 1000
"""First seeds of the runs for training and for the comparison."""
LEVEL_M = 304.8
Policy = NDArray[np.float64]
"""Weights by aircraft, manoeuvre and feature."""


def encounter() -> Scenario:
    """Return the scenario s02a_headon with less time to act."""
    scenario = airhilt.load("s02a_headon")
    actors = []
    for actor in scenario.actors:
        initial: Any = actor.initial
        position = initial.position.model_copy(update={"distance_nm": DISTANCE_NM})
        moved = initial.model_copy(update={"position": position})
        actors.append(actor.model_copy(update={"initial": moved}))
    return scenario.model_copy(update={"actors": tuple(actors)})


def features(traffic: NDArray[np.float32]) -> tuple[NDArray[np.float64], float]:
    """Return the features of an encounter, and the time to its closest approach in s.

    The features are 1, its urgency, and the part of a level by which the two will be too near.
    """
    known, place, velocity = traffic[:, 0], traffic[:, 1:4], traffic[:, 4:7]
    if not known.all():
        return np.array([1.0, -1.0, 0.0]), np.inf
    apart, closing = place[1] - place[0], velocity[1] - velocity[0]
    horizontal = closing[:2]
    to_go_s = float(-(apart[:2] @ horizontal) / max(float(horizontal @ horizontal), 1.0))
    vertical_m = abs(float(apart[2] + closing[2] * to_go_s))
    urgency = np.clip(1.0 - to_go_s / 100.0, -1.0, 1.0)
    return np.array([1.0, urgency, max(1.0 - vertical_m / LEVEL_M, 0.0)]), to_go_s


def choices(policy: Policy, seen: NDArray[np.float64]) -> list[int]:
    """Return for each aircraft the manoeuvre with the highest score; 0 if none is positive."""
    scores = policy @ seen
    return [int(row.argmax()) + 1 if row.max() > 0.0 else 0 for row in scores]


def fly(env: RunEnv, policy: Policy, seed: int) -> tuple[float, int, bool]:
    """Return the reward of an encounter, its advisories, and whether separation was lost."""
    observation, _ = env.reset(seed=seed)
    total, advisories, is_lost, is_over = 0.0, 0, False, False
    while not is_over:
        seen, to_go_s = features(observation["traffic"])
        if to_go_s < -5.0:
            break  # They have passed each other.
        action = choices(policy, seen)
        observation, reward, terminated, truncated, info = env.step(action)
        total += reward
        advisories += int(np.count_nonzero(action))
        is_lost = any(each.phase == "loss_of_separation" for each in info["conflicts"])
        is_over = is_lost or terminated or truncated
    return total, advisories, is_lost


def train(env: RunEnv, generations: int, out: Path) -> Policy:
    """Return the policy that the cross-entropy method finds; print each generation.

    The best policy of a generation is tried again in the next one.
    """
    draw = np.random.default_rng(0)
    shape = (len(env.aircraft), len(MANOEUVRES), FEATURES)
    mean, spread = np.zeros(shape), np.ones(shape)
    mean[:, :, 0] = -0.5
    champion = mean
    curve: list[dict[str, Any]] = []
    begun = time.process_time()
    for generation in range(generations):
        seed = TRAINING_SEEDS + generation
        policies = mean + spread * draw.standard_normal((CANDIDATES, *shape))
        policies[0] = champion
        rewards = np.array([fly(env, policy, seed)[0] for policy in policies])
        best = policies[np.argsort(-rewards, kind="stable")[:ELITE]]
        champion = best[0]
        mean = 0.3 * mean + 0.7 * best.mean(axis=0)
        spread = np.maximum(0.3 * spread + 0.7 * best.std(axis=0), 0.1)
        used_s = time.process_time() - begun
        curve.append({"cpu_s": round(used_s, 1), "rewards": [round(r, 2) for r in rewards]})
        print(f"{used_s:6.0f} s  mean {rewards.mean():6.2f}  best {rewards.max():6.2f}", flush=True)
        out.write_text(json.dumps({"policy": mean.tolist(), "curve": curve}))
    return mean


def reference(scenario: Scenario, seed: int) -> tuple[int, bool]:
    """Return the advisories of the reference assistant, and whether separation was lost."""
    with TemporaryDirectory() as folder:
        options: dict[str, Any] = {"cameras": False, "speech": False, "report": False}
        out = Path(folder) / "run"
        result = airhilt.run(scenario, seed=seed, latency="fixed", out=out, **options)
        told = {
            (advisory.recipient, advisory.recommendation)
            for logged in airhilt.open_run(result.folder).log()
            if logged.key.startswith("advisory/") and logged.key != "advisory/ATC"
            if (advisory := Advisory.model_validate_json(logged.data)).active
            and advisory.recommendation is not None
        }
    return len(told), result.summary.loss_of_separation


def compare(env: RunEnv, scenario: Scenario, policy: Policy, runs: int) -> None:
    """Print what became of runs that no policy was trained on."""
    seeds = range(HELD_OUT_SEEDS, HELD_OUT_SEEDS + runs)
    outcomes = {
        "says nothing": [fly(env, np.zeros_like(policy), seed)[1:] for seed in seeds],
        "reference": [reference(scenario, seed) for seed in seeds],
        "agent": [fly(env, policy, seed)[1:] for seed in seeds],
    }
    for name, rows in outcomes.items():
        advisories, lost = np.array(rows, float).T
        print(
            f"{name:13} separation lost {int(lost.sum())} of {runs}, "
            f"{advisories.mean():.1f} advisories a run"
        )


def draw_curve(curve: list[dict[str, Any]], figure: Path) -> None:
    """Draw the rewards of each generation over the CPU time."""
    import matplotlib as mpl

    mpl.use("svg")
    from matplotlib import pyplot as plt

    minutes = [each["cpu_s"] / 60.0 for each in curve]
    rewards = np.array([each["rewards"] for each in curve])
    with mpl.rc_context({"svg.hashsalt": "curve", "svg.fonttype": "none", "font.size": 9}):
        axes = plt.figure(figsize=(5, 2.6), layout="constrained").subplots()
        axes.fill_between(minutes, rewards.min(axis=1), rewards.max(axis=1), alpha=0.2)
        axes.plot(minutes, rewards.mean(axis=1), marker="o", markersize=3, label="mean")
        axes.axhline(-1.0, linestyle=":", color="grey")
        axes.annotate("says nothing", (minutes[-1], -1.0), ha="right", va="bottom")
        axes.set(xlabel="CPU time in minutes", ylabel="reward of an encounter")
        plt.savefig(figure, metadata={"Date": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=sys.modules[__name__].__doc__)
    parser.add_argument("--generations", type=int, default=8)
    parser.add_argument("--compare", type=int, default=10, metavar="RUNS")
    parser.add_argument("--out", type=Path, default=Path("agent.json"))
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args()
    scenario = encounter()
    env = RunEnv(scenario, "assistant", step_s=STEP_S, manoeuvres=MANOEUVRES)
    policy = train(env, given.generations, given.out)
    if given.figure is not None:
        draw_curve(json.loads(given.out.read_text())["curve"], given.figure)
    compare(env, scenario, policy, given.compare)
    env.close()


if __name__ == "__main__":
    main()
