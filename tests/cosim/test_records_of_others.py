"""A replay of a record that somebody else wrote asks no service that the record names."""

from __future__ import annotations

from http.server import BaseHTTPRequestHandler
from pathlib import Path
from typing import Any

import pytest

from airhilt import run
from airhilt.cosim.replay import replay
from airhilt.errors import WorkerError
from airhilt.record import RunFolder
from airhilt.scenario import Scenario
from services import service


@pytest.fixture(scope="module")
def recorded(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of 4 s in which the assistant warns, and nothing is said."""
    short = encounter.model_copy(update={"duration_s": 4.0})
    out = tmp_path_factory.mktemp("honest") / "run"
    return run(short, out=out, latency="fixed", speech=False, report=False).folder


def forged(folder: Path, options: dict[str, Any], modality: str, **record: Any) -> None:
    """Change what a run says of its options, and leave out the worker of a modality."""
    paths = RunFolder(folder)
    info = paths.info()
    workers = [each for each in info.workers if each.description.modality != modality]
    changed = info.options.model_copy(update=options)
    paths.write_info(info.model_copy(update={"options": changed, "workers": workers, **record}))


@pytest.mark.parametrize("asked", ["assistant", "wording"])
def test_no_service_learns_of_the_replay_or_gets_the_key_of_a_language_model(
    recorded: Path, monkeypatch: pytest.MonkeyPatch, asked: str
) -> None:
    heard: list[str | None] = []

    def listen(handler: BaseHTTPRequestHandler, _body: bytes) -> None:
        heard.append(handler.headers.get("Authorization"))
        handler.send_error(500)

    monkeypatch.setenv("AIRHILT_LLM_KEY", "secret")
    before = (recorded / "run.json").read_bytes()
    try:
        with service(listen) as url:
            if asked == "assistant":
                forged(recorded, {"assistant": url}, "decision", assistant=url)
            else:
                forged(recorded, {"llm": url, "wording": "llm"}, "decision")
            with pytest.raises(WorkerError, match="a replay asks no service"):
                replay(recorded)
    finally:
        (recorded / "run.json").write_bytes(before)
    assert heard == []
