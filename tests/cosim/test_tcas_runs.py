"""Runs in which TCAS II is the assistant: it gets its sensors, and crews follow it."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.messages import Advisory
from airhilt.options import Options
from airhilt.record import read_log
from meetings import meeting
from notices import Notices


@pytest.mark.slow
def test_tcas_warns_both_crews_and_they_pass_without_a_near_collision(tmp_path: Path) -> None:
    notices = Notices()
    options = Options(out=tmp_path / "run", assistant="tcas", latency="fixed", speech=False)
    result = run(meeting(), options, notices)
    log = list(read_log(result.folder / "log.mcap"))
    keys = {logged.key for logged in log}
    assert {"tcas/AAL123", "tcas/DAL456", "cockpit/AAL123", "cockpit/DAL456"} <= keys
    advisories = [
        Advisory.model_validate_json(m.data) for m in log if m.key.startswith("advisory/")
    ]
    assert {each.recipient for each in advisories} == {"AAL123", "DAL456"}
    assert {str(each.severity) for each in advisories} == {"CAUTION", "WARNING", "INFO"}
    summary = result.summary
    assert (summary.nmac, summary.collision) == (False, False)
    assert summary.t_first_warning_s is not None
    assert summary.nuisance_alerts == 0
    assert not [text for text in notices.texts if "nobody acts" in text]
    assert replay(result.folder).identical
