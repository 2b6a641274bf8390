"""llama.cpp's own server, with a tiny random model: nonsense in valid JSON, all of it refused."""

from __future__ import annotations

import importlib.util
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

import airhilt
from airhilt import Scenario
from airhilt.cosim.replay import replay
from airhilt.messages import Advisory, ModelExchange
from airhilt.record import read_log
from paths import ROOT

INSTALLED = all(importlib.util.find_spec(each) for each in ("llama_cpp", "gguf", "uvicorn"))
PATIENCE_S = 60.0

pytestmark = [
    pytest.mark.llm,
    pytest.mark.skipif(
        not INSTALLED, reason="no llama.cpp: pip install 'llama-cpp-python[server]' gguf"
    ),
]


@pytest.fixture(scope="module")
def endpoint(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a server with the random model."""
    folder = tmp_path_factory.mktemp("llm")
    model = folder / "tiny.gguf"
    tool = ROOT / "tools" / "make" / "tiny_language_model.py"
    subprocess.run([sys.executable, str(tool), str(model)], check=True, capture_output=True)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    options = ["--host", "127.0.0.1", "--port", str(port), "--n_ctx", "8192"]
    command = [sys.executable, "-m", "llama_cpp.server", "--model", str(model), *options]
    with (
        (folder / "server.log").open("wb") as log,
        subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT) as server,
    ):
        try:
            wait_for(f"http://127.0.0.1:{port}/v1/models")
            yield f"http://127.0.0.1:{port}/v1"
        finally:
            server.terminate()


def wait_for(url: str) -> None:
    """Wait until a server answers."""
    until = time.monotonic() + PATIENCE_S
    while time.monotonic() < until:
        try:
            if httpx.get(url, trust_env=False).status_code == 200:
                return
        except httpx.TransportError:
            time.sleep(0.2)
    raise AssertionError(f"{url} does not answer")


def run_of(encounter: Scenario, folder: Path, **options: Any) -> tuple[Any, list[Any], list[Any]]:
    """Return the result of a run, its advisories and its questions to a model."""
    result = airhilt.run(
        encounter, out=folder, latency="fixed", speech=False, cameras=False, **options
    )
    log = list(read_log(result.folder / "log.mcap"))
    advisories = [
        Advisory.model_validate_json(one.data) for one in log if one.key.startswith("advisory/")
    ]
    exchanges = [
        ModelExchange.model_validate_json(one.data) for one in log if one.key.startswith("llm/")
    ]
    return result, advisories, exchanges


def test_the_rules_speak_whatever_a_random_model_makes_of_their_words_and_alerts(
    encounter: Scenario, tmp_path: Path, endpoint: str
) -> None:
    model = {"llm": endpoint, "llm_model": "tiny", "llm_deadline_s": PATIENCE_S}
    _, expected, _ = run_of(encounter, tmp_path / "rules")
    assert expected
    for name, options in (
        ("wording", {"wording": "llm"}),
        ("decision", {"assistant": "llm"}),
    ):
        result, advisories, exchanges = run_of(encounter, tmp_path / name, **options, **model)
        assert exchanges
        assert not any(each.failure for each in exchanges)
        assert any(each.rejections for each in exchanges)
        told = [(each.recipient, each.severity, each.message) for each in advisories]
        assert told == [(each.recipient, each.severity, each.message) for each in expected]
        assert replay(result.folder).identical
