"""The server of a page ends as one line says, whatever it does at that moment."""

from __future__ import annotations

import queue
import socket
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest
from fastapi import Request

from airhilt.station import server
from airhilt.station.address import Address
from airhilt.station.app import page_app
from stations import PATIENCE_S, serving


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


def test_a_large_body_is_refused_before_it_is_read() -> None:
    """Its size may be told or not."""
    app, read = page_app(), list[int]()

    @app.post("/wish")
    async def wish(request: Request) -> None:
        read.append(len(await request.body()))

    def pieces() -> Iterator[bytes]:
        for _ in range(40):
            yield bytes(1 << 16)

    with serving(app) as url:
        port = httpx.URL(url).port
        with socket.create_connection(("127.0.0.1", port), PATIENCE_S) as connection:
            head = (
                f"POST /wish HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 30000000\r\n\r\n"
            )
            connection.sendall(head.encode())
            assert connection.recv(100).startswith(b"HTTP/1.1 413 ")
        with httpx.Client(base_url=url, trust_env=False, timeout=PATIENCE_S) as client:
            assert client.post("wish", content=pieces()).status_code == 413
            assert client.post("wish", content=bytes(1000)).status_code == 200
    assert read == [1000]
