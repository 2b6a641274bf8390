"""Engines of AIRHILT behind addresses, in a thread of the tests or a process of their own."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, cast

import uvicorn

from airhilt.assistant.service_kinds import PATHS, ServiceKind
from airhilt.assistant.serving import service_app


@contextmanager
def served(kind: ServiceKind, engine: str, port: int | None = 0) -> Iterator[str]:
    """Yield the address of an engine in this process."""
    app = service_app(kind, engine)
    config = uvicorn.Config(app, port=port or 0, log_level="warning", lifespan="off")
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run)
    thread.start()
    try:
        while not server.started:
            thread.join(0.01)
        port = cast("Any", server.servers[0].sockets[0]).getsockname()[1]
        yield f"http://127.0.0.1:{port}{PATHS[kind]}"
    finally:
        server.should_exit = True
        thread.join()


@contextmanager
def serving(kind: ServiceKind, *options: str) -> Iterator[str]:
    """Yield the address that ``airhilt serve`` prints."""
    command = [sys.executable, "-m", "airhilt", "serve", kind, *options]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            yield process.stdout.readline().split()[0]
        finally:
            process.terminate()
