"""The server of a page ends as one line says, whatever it does at that moment."""

from __future__ import annotations

import queue
import threading
from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest

from airhilt.station import server
from airhilt.station.address import Address
from airhilt.station.app import page_app
from stations import PATIENCE_S


def test_a_server_that_ends_during_a_long_request_says_so_without_a_traceback(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(server, "GRACE_S", 0.1)
    urls, is_over, is_drawn = queue.Queue[str](), threading.Event(), threading.Event()
    app = page_app()

    @app.get("/picture")
    def picture() -> None:
        is_over.set()
        is_drawn.wait(PATIENCE_S)

    with ThreadPoolExecutor() as pool:
        serving = pool.submit(
            server.serve, app, Address(port=0), opened=urls.put, notice=print, browser=False,
            is_over=is_over.is_set,
        )  # fmt: skip
        url = f"{urls.get(timeout=PATIENCE_S)}picture"
        answer = httpx.get(url, timeout=PATIENCE_S, trust_env=False)
        is_drawn.set()
        serving.result(PATIENCE_S)
    assert (answer.status_code, answer.text) == (503, "the station has ended")
    assert "Traceback" not in capfd.readouterr().err
