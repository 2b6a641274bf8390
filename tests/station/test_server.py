"""The server of a page ends as one line says, whatever it does at that moment."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import httpx
import pytest
from fastapi import FastAPI, Request

from airhilt.station import server
from airhilt.station.address import Address
from airhilt.station.app import page_app
from stations import PATIENCE_S


@contextmanager
def serving(app: FastAPI) -> Iterator[tuple[str, threading.Event]]:
    """Serve an application; yield its URL, and what ends the server when it is set."""
    urls, is_over = queue.Queue[str](), threading.Event()
    with ThreadPoolExecutor() as pool:
        done = pool.submit(
            server.serve, app, Address(port=0), opened=urls.put, notice=print, browser=False,
            is_over=is_over.is_set,
        )  # fmt: skip
        try:
            yield urls.get(timeout=PATIENCE_S), is_over
        finally:
            is_over.set()
            done.result(PATIENCE_S)


def test_a_server_that_ends_during_a_long_request_says_so_without_a_traceback(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(server, "GRACE_S", 0.1)
    is_drawn, app = threading.Event(), page_app()
    with serving(app) as (url, is_over):

        @app.get("/picture")
        def picture() -> None:
            is_over.set()
            is_drawn.wait(PATIENCE_S)

        answer = httpx.get(f"{url}picture", timeout=PATIENCE_S, trust_env=False)
        is_drawn.set()
    assert (answer.status_code, answer.text) == (503, "the station has ended")
    assert "Traceback" not in capfd.readouterr().err


def test_of_a_large_body_no_more_than_its_limit_is_read() -> None:
    app, read = page_app(), list[int]()

    @app.post("/wish")
    async def wish(request: Request) -> None:
        read.append(len(await request.body()))

    def pieces() -> Iterator[bytes]:
        for _ in range(500):
            yield bytes(1 << 16)

    with serving(app) as (url, _), httpx.Client(base_url=url, trust_env=False) as client:
        assert client.post("wish", content=pieces()).status_code == 413
        assert client.post("wish", content=bytes(2_000_000)).status_code == 413
        assert client.post("wish", content=bytes(1000)).status_code == 200
    assert read == [1000]
