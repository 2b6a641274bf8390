"""Engines of AIRHILT behind addresses, in a thread of the tests."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, cast

import uvicorn

from airhilt.assistant.service_kinds import PATHS, ServiceKind
from airhilt.assistant.serving import service_app


@contextmanager
def served(kind: ServiceKind, engine: str) -> Iterator[str]:
    """Yield the address of an engine."""
    config = uvicorn.Config(service_app(kind, engine), port=0, log_level="warning", lifespan="off")
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
