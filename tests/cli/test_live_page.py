"""The page of a run that goes on leaves nothing open in the process of the run."""

from __future__ import annotations

import subprocess
from typing import Any

import pytest

from airhilt.cli.live_page import live_page


def test_the_pipe_of_the_page_is_closed_when_the_run_is_interrupted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    started: list[subprocess.Popen[str]] = []
    popen = subprocess.Popen

    def start(*given: Any, **more: Any) -> subprocess.Popen[str]:
        started.append(popen(*given, **more))
        return started[0]

    monkeypatch.setattr(subprocess, "Popen", start)
    with (
        pytest.raises(KeyboardInterrupt),
        live_page("tcp/127.0.0.1:1", None, [], ["--port=0", "--no-browser"]),
    ):
        raise KeyboardInterrupt
    assert started[0].stdout is not None
    assert started[0].stdout.closed
