"""Runs the server of a station until it is interrupted."""

from __future__ import annotations

import asyncio
import threading
import time
import webbrowser
from collections.abc import Callable
from contextlib import suppress

import uvicorn
from starlette.exceptions import HTTPException
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from airhilt.station.address import Address
from airhilt.station.guard import Guard

LARGEST_MESSAGE_BYTES = 1 << 20
"""Greatest size of a message from a browser, and of the body of a request, in bytes."""
MOST_CONNECTIONS = 200
"""Largest number of connections at a time."""
PING_S, PATIENCE_S = 2.0, 5.0
"""Time between two questions if a browser is there, and for which its answer may take, in s."""
GRACE_S = 2
"""Time that open connections have to end with the server, in s."""
CHECK_PERIOD_S = 0.1
"""Time between two questions if nobody needs the server any more, in s."""


class _Interruptible:
    """Application that answers, and has no traceback, when the server gives up what it does."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        try:
            await self._app(scope, receive, send)
        except asyncio.CancelledError:
            # Nobody waits for this task but uvicorn, which would print a traceback.
            with suppress(RuntimeError):  # Its answer has begun.
                await PlainTextResponse("the station has ended", 503)(scope, receive, send)


class _Bounded:
    """Application that answers 413 to a request with a large body, and reads no more of it."""

    def __init__(self, app: ASGIApp, largest_bytes: int) -> None:
        self._app = app
        self._largest_bytes = largest_bytes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        received_bytes = 0

        async def receive_bounded() -> Message:
            nonlocal received_bytes
            message = await receive()
            received_bytes += len(message.get("body", b""))
            if received_bytes > self._largest_bytes:
                what = f"the body of the request has more than {self._largest_bytes:,} bytes"
                raise HTTPException(413, what, {"Connection": "close"})
            return message

        await self._app(scope, receive_bounded, send)


def serve(
    app: ASGIApp,
    address: Address,
    *,
    opened: Callable[[str], None],
    notice: Callable[[str], None],
    browser: bool = True,
    is_over: Callable[[], bool] | None = None,
    largest_bytes: int = LARGEST_MESSAGE_BYTES,
) -> None:
    """Serve an application to browsers until it is interrupted, or nobody needs it any more.

    Parameters
    ----------
    opened
        Is told the URL, once it can be opened.
    notice
        Is told of requests that were refused.
    browser
        True opens the URL in the user's browser.
    is_over
        Says, ten times a second, if nobody needs the server any more; None: it always is.
    largest_bytes
        Greatest size of the body of a request.

    Raises
    ------
    StationError
        The address cannot be listened at.
    """
    listening = address.bound()
    url = address.url(listening.getsockname()[1])
    config = uvicorn.Config(
        Guard(_Bounded(_Interruptible(app), largest_bytes), address, notice),
        log_level="warning",
        access_log=False,
        lifespan="off",
        server_header=False,
        ssl_certfile=address.certificate,
        ssl_keyfile=address.key,
        limit_concurrency=MOST_CONNECTIONS,
        timeout_graceful_shutdown=GRACE_S,
        ws_max_size=LARGEST_MESSAGE_BYTES,
        ws_ping_interval=PING_S,
        ws_ping_timeout=PATIENCE_S,
    )

    server = uvicorn.Server(config)
    with listening, suppress(KeyboardInterrupt):
        opened(url)  # The system keeps who comes before the server runs.
        if browser:
            threading.Thread(target=webbrowser.open, args=(url,), daemon=True).start()
        if is_over is not None:
            threading.Thread(target=_end_when, args=(is_over, server), daemon=True).start()
        server.run(sockets=[listening])


def _end_when(is_over: Callable[[], bool], server: uvicorn.Server) -> None:
    while not is_over():
        time.sleep(CHECK_PERIOD_S)
    server.should_exit = True
