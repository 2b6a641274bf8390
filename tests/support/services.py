"""Local HTTP services that behave as tests want."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Literal

Answer = Callable[[BaseHTTPRequestHandler, bytes], None]


@contextmanager
def service(answer: Answer) -> Iterator[str]:
    """Yield the address of a service that answers POST requests so."""

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            body = self.rfile.read(int(self.headers["Content-Length"]))
            try:
                answer(self, body)
            except (BrokenPipeError, ConnectionResetError):
                self.close_connection = True

        def log_message(self, *_: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, args=(0.02,))
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/service"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def answering(data: bytes, status: int = 200, kind: str = "application/json") -> Answer:
    """Return an answer with these bytes."""

    def answer(handler: BaseHTTPRequestHandler, _body: bytes) -> None:
        handler.send_response(status)
        handler.send_header("Content-Type", kind)
        handler.send_header("Content-Length", str(len(data)))
        handler.end_headers()
        handler.wfile.write(data)

    return answer


def endless(handler: BaseHTTPRequestHandler, _body: bytes) -> None:
    """Answer without an end."""
    handler.send_response(200)
    handler.end_headers()
    while True:
        handler.wfile.write(b"x" * 65_536)


def breaking_off(handler: BaseHTTPRequestHandler, _body: bytes) -> None:
    """Promise more than there is."""
    handler.send_response(200)
    handler.send_header("Content-Length", "1000")
    handler.end_headers()
    handler.wfile.write(b'{"text": ')


Slowness = Literal["silent", "dripping headers", "dripping"]


class Slow:
    """Answers after `PATIENCE_S`, or earlier if it is released; until then it is slow.

    Its answer is bounded, so that a test of somebody who waits for it fails and does not hang.
    """

    PATIENCE_S = 3.0

    def __init__(self, how: Slowness, data: bytes) -> None:
        self.released = threading.Event()
        self._how = how
        self._data = data

    def __call__(self, handler: BaseHTTPRequestHandler, body: bytes) -> None:
        match self._how:
            case "silent":
                self.released.wait(self.PATIENCE_S)
                answering(self._data)(handler, body)
            case "dripping headers":
                handler.send_response(200)
                handler.send_header("Content-Length", str(len(self._data)))
                self._drip(handler, b"X-Patience: 1\r\n")
                handler.end_headers()
                handler.wfile.write(self._data)
            case "dripping":
                handler.send_response(200)
                handler.end_headers()
                self._drip(handler, b" ")
                handler.wfile.write(self._data)

    def _drip(self, handler: BaseHTTPRequestHandler, drop: bytes) -> None:
        handler.flush_headers()
        for _ in range(30):
            if self.released.wait(self.PATIENCE_S / 30):
                return
            handler.wfile.write(drop)
            handler.wfile.flush()


def redirecting(to: str) -> Answer:
    """Return an answer that sends the caller somewhere else."""

    def answer(handler: BaseHTTPRequestHandler, _body: bytes) -> None:
        handler.send_response(303)
        handler.send_header("Location", to)
        handler.send_header("Content-Length", "0")
        handler.end_headers()

    return answer


def nobody() -> str:
    """Return an address where nothing listens."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return f"http://127.0.0.1:{free.getsockname()[1]}/service"
