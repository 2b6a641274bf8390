"""Strangers are kept out of a station."""

from __future__ import annotations

import asyncio
from pathlib import Path
from urllib.parse import urlencode

import pytest
from starlette.responses import PlainTextResponse
from starlette.types import Message, Receive, Scope, Send

from airhilt.station.address import Address
from airhilt.station.guard import MOST_NOTICES, Guard
from stations import asked

TOKEN = "correct horse battery"
FAR = Address("192.168.1.7", certificate=Path("c.pem"), key=Path("k.pem"), token=TOKEN)


def guarded(address: Address, told: list[str] | None = None) -> Guard:
    notice = (lambda _: None) if told is None else told.append
    return Guard(PlainTextResponse("the page"), address, notice)


@pytest.mark.parametrize("host", ["localhost:8420", "[::1]:8420"])
def test_the_own_names_are_let_in(host: str) -> None:
    assert asked(guarded(Address()), host=host).text == "the page"


@pytest.mark.parametrize("host", ["127.0.0.1.evil.example", "192.168.1.7"])
def test_another_name_is_refused(host: str) -> None:
    told: list[str] = []
    answer = asked(guarded(Address(), told), host=host)
    assert answer.status_code == 403
    assert "not a name of this station" in answer.text
    assert len(told) == 1


@pytest.mark.parametrize("origin", ["https://127.0.0.1:8420", "null"])
def test_a_page_of_another_site_is_refused(origin: str) -> None:
    answer = asked(guarded(Address()), origin=origin)
    assert answer.status_code == 403
    assert "another site" in answer.text
    assert asked(guarded(Address()), origin="http://127.0.0.1:8420").status_code == 200


def test_without_the_token_nothing_is_told() -> None:
    answer = asked(guarded(FAR), "/?token=wrong", host="192.168.1.7:8420")
    assert answer.status_code == 403
    assert "the page" not in answer.text


def test_the_token_in_the_url_becomes_a_cookie_that_scripts_cannot_read() -> None:
    answer = asked(guarded(FAR), f"/?token={TOKEN}", host="192.168.1.7:8420")
    assert (answer.status_code, answer.headers["location"]) == (303, "/")
    cookie = answer.headers["set-cookie"]
    assert all(word in cookie for word in ("HttpOnly", "Secure", "SameSite=strict"))
    again = asked(guarded(FAR), host="192.168.1.7:8420", cookie=cookie.partition(";")[0])
    assert again.text == "the page"


def test_every_answer_forbids_scripts_and_styles_in_the_markup() -> None:
    for host in ("127.0.0.1", "evil.example"):
        policy = asked(guarded(Address()), host=host).headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "unsafe" not in policy


def test_a_flood_of_refusals_is_told_a_few_times_only() -> None:
    told: list[str] = []
    app = guarded(Address(), told)
    for _ in range(MOST_NOTICES + 10):
        asked(app, host="evil.example")
    assert len(told) == MOST_NOTICES
    assert "further ones" in told[-1]


@pytest.mark.parametrize(("token", "is_let_in"), [(TOKEN, True), ("wrong", False)])
def test_a_socket_is_let_in_by_the_token_in_its_url(token: str, is_let_in: bool) -> None:
    reached: list[Scope] = []
    sent: list[Message] = []

    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        reached.append(scope)

    async def receive() -> Message:
        return {"type": "websocket.connect"}

    async def send(message: Message) -> None:
        sent.append(message)

    scope = {
        "type": "websocket",
        "headers": [(b"host", b"192.168.1.7:8420")],
        "query_string": urlencode({"token": token}).encode(),
    }
    asyncio.run(Guard(app, FAR, lambda _: None)(scope, receive, send))
    assert bool(reached) is is_let_in
    assert [message["type"] for message in sent] == ([] if is_let_in else ["websocket.close"])
