"""Calls of HTTP services: programs of somebody else that speak, listen or look."""

from __future__ import annotations

import http.client
import socket
import threading
import urllib.parse
from contextlib import closing, suppress
from http import HTTPStatus

from airhilt.errors import AirhiltError

READ_BYTES = 65_536
QUOTED_BYTES = 200
"""Of an answer that is an error, in the message about it."""

_CONNECTIONS: dict[str, type[http.client.HTTPConnection]] = {
    "http": http.client.HTTPConnection,
    "https": http.client.HTTPSConnection,
}


def is_service(engine: str) -> bool:
    """Return whether an engine, as the command line names it, is a service at an address."""
    return engine.partition(":")[0] in _CONNECTIONS


class HttpService:
    """One address that answers POST requests; redirects and proxies are not followed.

    Parameters
    ----------
    subject
        What asks, at the head of messages: ``voice http``.
    url
        Where to, with ``http`` or ``https``.
    timeout_s
        Wall time for the whole exchange, from looking up the name to the last byte.
    maximum_bytes
        Of an answer.
    failure
        Class of all errors.

    Raises
    ------
    AirhiltError
        The address is none.
    """

    def __init__(
        self,
        subject: str,
        url: str,
        timeout_s: float,
        maximum_bytes: int,
        failure: type[AirhiltError],
    ) -> None:
        try:
            self._address = urllib.parse.urlsplit(url)
            is_address = is_service(url) and bool(self._address.hostname)
            _ = self._address.port
        except ValueError:
            is_address = False
        if not is_address or not all("!" <= character <= "~" for character in url):
            raise failure(
                f"{subject}: {url!r} is no address; expected one such as http://127.0.0.1:8000/path"
            )
        self.subject = subject
        self.url = url
        self._timeout_s = timeout_s
        self._maximum_bytes = maximum_bytes
        self._failure = failure

    def post(self, body: bytes, content_type: str) -> bytes:
        """Return the answer to a request.

        Raises
        ------
        AirhiltError
            The service is down, slow, says that it failed, or answers without an end.
        """
        try:
            return _Exchange(self, body, content_type).within(self._timeout_s)
        except TimeoutError:
            raise self.error(
                f"has not answered for {self._timeout_s:g} s",
                "an answer in that time; give it longer, or choose a faster service",
            ) from None
        except (OSError, http.client.HTTPException) as error:
            raise self.error(
                f"broke off: {type(error).__name__}: {error}", "a complete answer"
            ) from None

    def connect(self) -> http.client.HTTPConnection:
        """Return a connection to the service.

        Raises
        ------
        AirhiltError
            It is not there.
        """
        kind, host = _CONNECTIONS[self._address.scheme], self._address.hostname or ""
        connection = kind(host, self._address.port, timeout=self._timeout_s)
        try:
            connection.connect()
        except TimeoutError:
            raise
        except (OSError, UnicodeError) as error:  # UnicodeError: a name that cannot be looked up
            raise self.error(f"is not there: {error}", "a service that answers") from None
        return connection

    def ask(self, connection: http.client.HTTPConnection, body: bytes, content_type: str) -> bytes:
        """Return the answer that comes over a connection.

        Raises
        ------
        AirhiltError
            The service says that it failed, or answers too much.
        """
        address = self._address
        target = (address.path or "/") + (f"?{address.query}" if address.query else "")
        connection.request("POST", target, body, {"Content-Type": content_type})
        with connection.getresponse() as answer:
            if answer.status != HTTPStatus.OK:
                quoted = answer.read(QUOTED_BYTES).decode("utf-8", "replace").strip()
                raise self.error(
                    f"answered with HTTP status {answer.status}{f': {quoted!r}' if quoted else ''}",
                    "200",
                )
            return self._read(answer)

    def _read(self, answer: http.client.HTTPResponse) -> bytes:
        blocks: list[bytes] = []
        size = 0
        while block := answer.read1(READ_BYTES):
            size += len(block)
            if size > self._maximum_bytes:
                raise self.error(
                    f"answers with more than {self._maximum_bytes} bytes",
                    "no more than that",
                )
            blocks.append(block)
        promised = answer.length
        if promised:
            raise http.client.IncompleteRead(b"".join(blocks), promised)
        return b"".join(blocks)

    def error(self, what: str, expected: str) -> AirhiltError:
        """Return the error that says what the service does and what was expected."""
        return self._failure(f"{self.subject}: {self.url} {what}; expected {expected}")


class _Exchange(threading.Thread):
    """One request and its answer, in a thread that can be left alone if the service is slow."""

    def __init__(self, service: HttpService, body: bytes, content_type: str) -> None:
        super().__init__(name=service.subject, daemon=True)
        self._service = service
        self._request = (body, content_type)
        self._socket: socket.socket | None = None
        self._is_given_up = False
        self._answer = b""
        self._failure: Exception | None = None

    def within(self, timeout_s: float) -> bytes:
        """Return the answer if it comes in time.

        Raises
        ------
        TimeoutError
            It does not.
        """
        self.start()
        self.join(timeout_s)
        if self.is_alive():
            self._give_up()
            raise TimeoutError
        if self._failure is not None:
            raise self._failure
        return self._answer

    def run(self) -> None:
        """Ask the service."""
        try:
            with closing(self._service.connect()) as connection:
                self._socket = connection.sock
                if not self._is_given_up:
                    self._answer = self._service.ask(connection, *self._request)
        except Exception as error:
            self._failure = error

    def _give_up(self) -> None:
        """Cut the connection, so that what waits for it ends."""
        self._is_given_up = True
        if self._socket is not None:
            with suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)
