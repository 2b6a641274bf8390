"""Calls of HTTP services: programs of somebody else that speak, listen or look."""

from __future__ import annotations

import ipaddress
import json
import os
import re
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, TypeVar
from urllib.parse import urlsplit

from airhilt.errors import AirhiltError, all_problems

if TYPE_CHECKING:
    import httpx
    from pydantic import BaseModel

Answer = TypeVar("Answer", bound="BaseModel")
SCHEMES = ("http", "https")
USAGE = "the address of a service"
"""Words for such an engine where error messages list what may be written."""
QUOTED_LENGTH = 200
"""Characters of an error answer that the error message quotes."""
MOST_FAILURES = 3
"""Number of requests in a row without a usable answer after which a service is asked no more."""
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
"""Bytes that some programs write before UTF-8; a reader of JSON may ignore them (RFC 8259, 8.1)."""


def is_service(engine: str) -> bool:
    """Return whether an engine, as the command line names it, is a service at an address."""
    return engine.partition(":")[0] in SCHEMES


class HttpService:
    """One address that answers POST requests; redirects and proxies are not followed.

    Parameters
    ----------
    subject
        Words at the head of error messages for what calls the service, such as ``voice http``.
    timeout_s
        Wall time for connecting, for each part of an answer, and for all of it.
    maximum_bytes
        Size of the largest answer that is accepted.
    key
        Bearer token of the requests; no error shows it. Empty: none.

    Raises
    ------
    AirhiltError
        The address is none, or contains a user or a password, which ``run.json`` would keep.
    """

    def __init__(
        self,
        subject: str,
        url: str,
        timeout_s: float,
        maximum_bytes: int,
        failure: type[AirhiltError],
        key: str = "",
    ) -> None:
        if "@" in _authority(url):
            raise failure(
                f"{subject}: the address at {without_user(url)} contains a user or a password; "
                "expected none"
            )
        if not _is_address(url):
            raise failure(
                f"{subject}: {url!r} is no address; expected one such as http://127.0.0.1:8000/path"
            )
        self.subject = subject
        self.url = url
        self._timeout_s = timeout_s
        self._maximum_bytes = maximum_bytes
        self._failure = failure
        self._key = key
        self._failures = 0
        """Failed attempts since the last answer."""

    @contextmanager
    def attempt(self) -> Iterator[None]:
        """Count a failed attempt: its error is passing unless it is the third in a row."""
        try:
            yield
        except AirhiltError as error:
            self._failures += 1
            error.is_passing = self._failures < MOST_FAILURES
            if not error.is_passing:
                error.args = (f"{error} ({MOST_FAILURES} times in a row)",)
            raise
        self._failures = 0

    def post(
        self,
        body: bytes,
        content_type: str,
        headers: Mapping[str, str] | None = None,
    ) -> bytes:
        """Return the answer to a request.

        Parameters
        ----------
        headers
            Further headers of the request.

        Raises
        ------
        AirhiltError
            The service is down, slow, says that it failed, or answers without an end.
        """
        import httpx  # Not at the top: most runs call no service, and importing it takes time.

        sent = {
            **(headers or {}),
            "Content-Type": content_type,
            "Accept-Encoding": "identity",
            **({"Authorization": f"Bearer {self._key}"} if self._key else {}),
        }
        until_s = time.monotonic() + self._timeout_s
        # The certificates take time to load.
        verify = self.url.startswith("https")
        try:
            with (
                httpx.Client(timeout=self._timeout_s, trust_env=False, verify=verify) as client,
                client.stream("POST", self.url, content=body, headers=sent) as answer,
            ):
                content = self._content(answer, until_s)
        except (TimeoutError, httpx.TimeoutException):
            raise self.error(
                f"has not answered for {self._timeout_s:g} s",
                "an answer in that time; choose a faster service, or a smaller model",
            ) from None
        except httpx.ConnectError as error:
            raise self.error(f"is not there: {error}", "a service that answers") from None
        except (httpx.TransportError, OSError) as error:
            raise self.error(
                f"broke off: {type(error).__name__}: {error}", "a complete answer"
            ) from None
        if answer.status_code != 200:
            # The key first: half of it would not be found any more.
            text = without_key(content.decode("utf-8", "replace"), self._key)
            quoted = _said(text)[:QUOTED_LENGTH].strip()
            to = answer.headers.get("Location")
            raise self.error(
                f"answered with HTTP status {answer.status_code}"
                f"{f' (go to {to[:QUOTED_LENGTH]!r})' if to else ''}"
                f"{f': {quoted!r}' if quoted else ''}",
                "200; redirects are not followed" if to else "200",
            )
        return content

    def _content(self, answer: httpx.Response, until_s: float) -> bytes:
        """Return the body of an answer; httpx limits the time of each part, not of the whole."""
        content = bytearray()
        for block in answer.iter_raw():
            content += block
            if len(content) > self._maximum_bytes:
                raise self.error(
                    f"answers with more than {self._maximum_bytes} bytes", "no more than that"
                )
            if time.monotonic() > until_s:
                raise TimeoutError
        return bytes(content)

    def parsed(self, data: bytes, model: type[Answer], expected: str) -> Answer:
        """Return an answer in JSON as a model.

        Raises
        ------
        AirhiltError
            It is not of the model.
        """
        from pydantic import ValidationError  # Not at the top: the help of the program needs none.

        try:
            return model.model_validate_json(data.removeprefix(BYTE_ORDER_MARK))
        except ValidationError as error:
            text = without_key(data.decode("utf-8", "replace"), self._key)
            what = f"answered {text[:60]!r}: {all_problems(error)}"
            raise self.error(what, expected) from None

    def error(self, what: str, expected: str) -> AirhiltError:
        """Return the error that says what the service does and what was expected."""
        error = self._failure(f"{self.subject}: {self.url} {what}; expected {expected}")
        error.is_of_machine = True
        return error


def _said(text: str) -> str:
    """Return the sentence in an error answer of OpenAI's API or of FastAPI; otherwise the text."""
    try:
        answer = json.loads(text)
    except (ValueError, RecursionError):
        return text
    for name in ("error", "detail", "message"):
        if isinstance(answer, dict) and name in answer:
            answer = answer[name]
    return answer if isinstance(answer, str) else text


def key_of(variable: str, subject: str, failure: type[AirhiltError]) -> str:
    """Return the key of a service from the environment; empty if there is none.

    Raises
    ------
    AirhiltError
        The key can be none; the error does not show it.
    """
    key = os.environ.get(variable, "").strip()
    if not all("!" <= character <= "~" for character in key):
        raise failure(
            f"{subject}: the key in {variable} has blanks or letters that are not ASCII; expected "
            "a key in one word"
        )
    return key


def without_key(text: str, key: str) -> str:
    """Return a text without a key, which a service may quote; an empty key is none."""
    return text.replace(key, "***") if key else text


def without_user(url: str) -> str:
    """Return scheme and host of an address, without a user, a password or a query."""
    host = _authority(url).rpartition("@")[2]
    return f"{url.partition('://')[0]}://{host}"


def _authority(url: str) -> str:
    """Return the part of an address between the scheme and the path (RFC 3986, 3.2)."""
    rest = url.partition("://")[2]
    return re.split("[/?#]", rest, maxsplit=1)[0]


def is_elsewhere(url: str) -> bool:
    """Return whether an address is not that of this machine (RFC 1122, 3.2.1.3 g)."""
    import httpx

    host = httpx.URL(url).host
    try:
        return not ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host != "localhost"


def _is_address(url: str) -> bool:
    import httpx

    if not is_service(url) or not all("!" <= character <= "~" for character in url):
        return False
    try:
        parts = urlsplit(url)
        return bool(httpx.URL(url).host and parts.hostname) and parts.port != 0
    except (httpx.InvalidURL, ValueError):
        return False
