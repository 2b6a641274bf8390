"""Calls of HTTP services: speech that somebody else's program makes or recognises."""

from __future__ import annotations

import http.client
import time
import urllib.error
import urllib.parse
import urllib.request

from airhilt.errors import SpeechError

READ_BYTES = 65_536
QUOTED_BYTES = 200
"""Of an answer that is an error, in the message about it."""


class HttpService:
    """One address that answers POST requests.

    Parameters
    ----------
    subject
        What asks, at the head of messages: ``voice http``.
    url
        Where to, with ``http`` or ``https``.
    timeout_s
        Wall time for the whole answer.
    maximum_bytes
        Of an answer.

    Raises
    ------
    SpeechError
        The address is none.
    """

    def __init__(self, subject: str, url: str, timeout_s: float, maximum_bytes: int) -> None:
        try:
            parts = urllib.parse.urlsplit(url)
            is_address = parts.scheme in ("http", "https") and bool(parts.hostname)
            _ = parts.port
        except ValueError:
            is_address = False
        if not is_address:
            raise SpeechError(
                f"{subject}: {url!r} is no address; expected one such as http://127.0.0.1:8000/path"
            )
        self.subject = subject
        self.url = url
        self._timeout_s = timeout_s
        self._maximum_bytes = maximum_bytes

    def post(self, body: bytes, content_type: str) -> bytes:
        """Return the answer to a request.

        Raises
        ------
        SpeechError
            The service is down, slow, says that it failed, or answers without an end.
        """
        deadline = time.monotonic() + self._timeout_s
        request = urllib.request.Request(  # noqa: S310  (checked in __init__)
            self.url, body, {"Content-Type": content_type}, method="POST"
        )
        try:
            with urllib.request.urlopen(request, timeout=self._timeout_s) as answer:  # noqa: S310
                return self._read(answer, deadline)
        except urllib.error.HTTPError as error:
            with error:
                quoted = error.read(QUOTED_BYTES).decode("utf-8", "replace").strip()
            raise self.error(
                f"answered with HTTP status {error.code}{f': {quoted!r}' if quoted else ''}",
                "200",
            ) from None
        except TimeoutError:
            raise self._too_slow() from None
        except urllib.error.URLError as error:
            if isinstance(error.reason, TimeoutError):
                raise self._too_slow() from None
            raise self.error(f"is not there: {error.reason}", "a service that answers") from None
        except (OSError, http.client.HTTPException) as error:
            raise self.error(
                f"broke off: {type(error).__name__}: {error}", "a complete answer"
            ) from None

    def _read(self, answer: http.client.HTTPResponse, deadline: float) -> bytes:
        blocks: list[bytes] = []
        size = 0
        while block := answer.read1(READ_BYTES):
            size += len(block)
            if size > self._maximum_bytes:
                raise self.error(
                    f"answers with more than {self._maximum_bytes} bytes",
                    "an answer to one call on the radio",
                )
            if time.monotonic() > deadline:
                raise self._too_slow()
            blocks.append(block)
        promised = answer.length
        if promised:
            raise http.client.IncompleteRead(b"".join(blocks), promised)
        return b"".join(blocks)

    def _too_slow(self) -> SpeechError:
        return self.error(
            f"has not answered for {self._timeout_s:g} s",
            "an answer in that time; give it longer, or choose a faster service",
        )

    def error(self, what: str, expected: str) -> SpeechError:
        """Return the error that says what the service does and what was expected."""
        return SpeechError(f"{self.subject}: {self.url} {what}; expected {expected}")
