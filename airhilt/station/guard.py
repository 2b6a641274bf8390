"""Keeps strangers out: checks Host, Origin and token of each request, and restricts the page."""

from __future__ import annotations

import hmac
from collections import Counter
from collections.abc import Callable
from urllib.parse import urlsplit

from starlette.datastructures import MutableHeaders
from starlette.requests import HTTPConnection
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from airhilt.host.text import readable
from airhilt.station.address import Address

COOKIE = "airhilt_token"
MOST_NOTICES = 20
"""Largest number of refusals of one source that are told."""
POLICY = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self'",
        "media-src 'self'",
        "connect-src 'self'",
        "frame-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'self'",
    )
)
"""Content Security Policy: nothing from elsewhere, and no script or style in the markup."""
HEADERS = {
    "Content-Security-Policy": POLICY,
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
}


class Refusals:
    """Tells what is refused: the first `MOST_NOTICES` of each source.

    Parameters
    ----------
    notice
        Is told of it.
    """

    def __init__(self, notice: Callable[[str], None]) -> None:
        self._notice = notice
        self._told: Counter[str] = Counter()

    def tell(self, what: str, source: str) -> None:
        """Tell of a refusal, and with the last one of a source that no more of it are told."""
        self._told[source] += 1
        if self._told[source] > MOST_NOTICES:
            return
        is_last = self._told[source] == MOST_NOTICES
        self._notice(f"refused {what}{f'; further ones {source} are not told' * is_last}")


class Guard:
    """Refuses requests of strangers before the application sees them.

    Parameters
    ----------
    app
        The application.
    address
        Where it listens, and the token that it asks for.
    notice
        Is told of refusals, the first ones.
    """

    def __init__(self, app: ASGIApp, address: Address, notice: Callable[[str], None]) -> None:
        self._app = app
        self._address = address
        self._refusals = Refusals(notice)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or let the application do it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return

        async def send_restricted(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        answer = self._answer(scope)
        if answer is None:
            await self._app(scope, receive, send_restricted)
        elif scope["type"] == "http":
            await answer(scope, receive, send_restricted)
        else:
            await send({"type": "websocket.close", "code": 1008, "reason": "refused"})

    def _answer(self, scope: Scope) -> Response | None:
        """Return what is answered in the application's place, None if the request may pass."""
        request = HTTPConnection(scope)
        host, origin = request.headers.get("host", ""), request.headers.get("origin")
        name = _hostname(host)
        if not self._address.knows(name):
            return self._refuse(
                f"host {name!r}: not a name of this station; open the address that it printed"
            )
        if origin is not None and origin != f"{self._address.scheme}://{host}":
            return self._refuse(f"origin {origin!r}: a page of another site may not ask here")
        token = self._address.token
        if not token or _is_same(request.cookies.get(COOKIE, ""), token):
            return None
        if _is_same(request.headers.get("authorization", ""), f"Bearer {token}"):
            return None  # A program, not a browser.
        if not _is_same(request.query_params.get("token", ""), token):
            return self._refuse("no token, or a wrong one; open the address that was printed")
        if scope["type"] == "websocket":
            return None
        answer = RedirectResponse("/", status_code=303)
        answer.set_cookie(
            COOKIE,
            token,
            secure=self._address.scheme == "https",
            httponly=True,
            samesite="strict",
        )
        return answer

    def _refuse(self, reason: str) -> Response:
        self._refusals.tell(f"a request: {readable(reason)}", "of this kind")
        return PlainTextResponse(f"airhilt: refused: {readable(reason)}\n", status_code=403)


def _hostname(host: str) -> str:
    """Return the name in a ``Host`` header, empty if it is none."""
    try:
        return (urlsplit(f"//{host}").hostname or "").lower()
    except ValueError:
        return ""


def _is_same(given: str, token: str) -> bool:
    return hmac.compare_digest(given.encode(), token.encode())
