"""Mutates the scenarios that ship, and checks that each mutant is accepted or refused by name.

python tools/fuzz_scenarios.py --count 10000
python tools/fuzz_scenarios.py --count 200 --seed 7 --run-every 1 --keep failures
"""

from __future__ import annotations

import sys

from airhilt.cosim.setup import require_runnable
from airhilt.scenario import Scenario
from airhilt.world.loading import load_text
from mutants import fuzz


def read(text: str) -> Scenario:
    """Return the scenario in a text."""
    scenario = load_text(text, "mutant.json")
    require_runnable(scenario)
    return scenario


if __name__ == "__main__":
    sys.exit(fuzz("scenarios", read, __doc__))
