"""Ordinary calls of a tower, each in its situation: what is seen of each afterwards.

All of them need two and a half minutes of processor time:
``pytest -m slow tests/station/test_tower_calls.py``.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from seats import logged, said
from tower_calls import CALLS, SITUATIONS, Seen, scenario_of


@pytest.mark.slow
@pytest.mark.parametrize("call", CALLS, ids=[call["id"] for call in CALLS])
def test_what_a_tower_says_is_done_or_refused(call: dict[str, Any], tmp_path: Path) -> None:
    callsign, _, at_s = SITUATIONS[call["situation"]]
    scenario = scenario_of(call["situation"], call.get("traffic", ()), at_s + call["within_s"])
    calls = [
        (0.0, call["text"]),
        *((then["after_s"], then["text"]) for then in call.get("then", ())),
    ]
    told = [said("Washington_Tower", at_s + after_s, text) for after_s, text in calls]
    seen = Seen(logged(scenario, tmp_path / "run", ["tower"], told), callsign, at_s)
    for expected in call["expected"]:
        assert seen.check(**expected), (expected, seen.words)
