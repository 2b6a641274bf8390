"""Spaces of observations and actions."""

from __future__ import annotations

import string

import numpy as np
from gymnasium import spaces

from airhilt.envs.episode import Plan
from airhilt.envs.perception import LONGEST_CALLS, OWN, TRAFFIC, bounds


def observation_space(plan: Plan, name: str) -> spaces.Dict:
    """Return the space of what an agent observes."""
    least, greatest = bounds(TRAFFIC)
    rows = (len(plan.callsigns), 1)
    parts: dict[str, spaces.Space[object]] = {
        "traffic": spaces.Box(np.tile(least, rows), np.tile(greatest, rows)),
        "calls": spaces.Text(LONGEST_CALLS, min_length=0, charset=string.printable),
    }
    if name in plan.callsigns:
        parts["own"] = spaces.Box(*bounds(OWN))
    return spaces.Dict(parts)


def action_space(plan: Plan, name: str) -> spaces.MultiDiscrete:
    """Return the space of what an agent chooses: for each of its aircraft, 0 or a manoeuvre."""
    return spaces.MultiDiscrete([1 + len(plan.manoeuvres)] * len(plan.aircraft(name)))
