"""The clock of a run tells programs by how much it is behind its pace."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from airhilt import load, run
from airhilt.bus.session import Bus, free_endpoint
from airhilt.messages import Clock


@pytest.mark.parametrize("pace", ["virtual", "100000x"])
def test_a_run_that_no_machine_can_keep_up_with_says_so_and_one_without_a_pace_does_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pace: str
) -> None:
    clocks: list[Clock] = []
    keep = Bus.keep

    def note(bus: Bus, key: str, payload: bytes) -> None:
        keep(bus, key, payload)
        if key == "clock":
            clocks.append(Clock.model_validate_json(payload))

    monkeypatch.setattr(Bus, "keep", note)
    short = load("s01b_dropped_hold").model_copy(update={"duration_s": 2.0, "cameras": ()})
    given: dict[str, Any] = {"assistant": "none", "speech": False, "report": False}
    given["endpoint"] = free_endpoint()
    run(short, out=tmp_path / "run", latency="fixed", pace=pace, **given)
    assert [clock.phase for clock in clocks] == ["waiting", "running", "running", "finished"]
    assert [clock.behind_s > 1.0 for clock in clocks[1:]] == [pace != "virtual"] * 3
    assert clocks[0].behind_s == 0.0
