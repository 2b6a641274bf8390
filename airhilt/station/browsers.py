"""The browsers that look at a run: each gets its changes, and acts at its seat."""

from __future__ import annotations

import asyncio
import json
import time
from base64 import b64encode
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from fastapi import WebSocket, WebSocketDisconnect
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from airhilt.bus.seat_client import SeatClient
from airhilt.errors import first_problem
from airhilt.host.text import readable
from airhilt.messages import LeaveSeat, PressToTalk, ReleaseToTalk, SayVoice, SeatAct, TakeSeat
from airhilt.station.audiences import Audience
from airhilt.station.changes import MOST_AT_ONCE, Changes
from airhilt.station.guard import Refusals
from airhilt.station.page_files import page_version
from airhilt.station.seat_views import SeatViews
from airhilt.station.subscription import Subscription

PERIOD_S = 0.05
"""Time between two messages to a browser, in s."""
MOST_ACTS = 200
"""Largest number of acts of a browser that wait for the run."""
HOLD_S = 5.0
"""Time for which the seat of a browser that is gone is kept for it, in s."""
STALLED_S = 5.0
"""Time after which a browser is gone that takes nothing of what is sent to it, in s."""
ENDINGS = (asyncio.CancelledError, TimeoutError, WebSocketDisconnect, RuntimeError)
"""Exceptions with which a connection ends: Starlette raises the last one on a closed connection."""
POLICY_VIOLATION = 1008
"""Code with which a WebSocket is closed (RFC 6455, 7.4.1)."""
OLD_PAGE, REPLACED = 4426, 4409
"""Likewise, of those that applications choose: the page has to be loaded again, or has another
connection."""
LONGEST_REASON = 100
"""Greatest length of a reason for closing, in characters; the protocol has 123 bytes."""
NO_SEAT = "you have no seat; take one first"


class PageMessage(BaseModel):
    """Message of a page: exactly one of ``watch``, ``act`` and ``echo``.

    Acts are answered in their order with ``{"answer": reason}``, which is empty if the run has
    accepted the act. The voice comes in binary messages of PCM while the button is held.
    """

    model_config = ConfigDict(extra="forbid")
    watch: str | None = Field(
        default=None,
        max_length=80,
        pattern=r"^[A-Za-z0-9_.-]+$",
        description="the camera whose pictures are shown, null for none",
    )
    act: SeatAct | None = Field(default=None, description="an act at a seat")
    seat: str = Field(default="", max_length=80, description="the seat to take, with that act")
    echo: float | None = Field(
        default=None, allow_inf_nan=False, description="a number that is sent back"
    )

    @model_validator(mode="after")
    def _is_one(self) -> PageMessage:
        if len({"watch", "act", "echo"} & self.model_fields_set) != 1:
            raise ValueError("expected exactly one of watch, act, echo")
        return self


class _Browser:
    """One browser: what it watches, and what it has yet to be told."""

    def __init__(self, socket: WebSocket, identity: str, shown_seat: str | None) -> None:
        self.socket = socket
        self.identity = identity
        """Name that it keeps when its connection is lost, and its secret at a seat."""
        self.shown_seat = shown_seat
        """Seat whose view its page shows; None: it shows what everybody sees."""
        self.watched: str | None = None
        self.seen_of_seat = 0
        """Number of the first change of the seat that it has not seen."""
        self.heard = 0
        """Number of the first piece of sound that it has not got."""
        self.told_seats: dict[str, Any] = {}
        self.acts: asyncio.Queue[tuple[str, SeatAct]] = asyncio.Queue(MOST_ACTS)
        self.is_on_air = False
        """True while its sound is accepted."""
        self.unsent: deque[str] = deque()

    def tell(self, kind: str, what: Any) -> None:
        self.unsent.append(json.dumps({kind: what}))


class Browsers:
    """Serves the browsers, and passes on what they do at seats: the run says what is allowed.

    Parameters
    ----------
    changes
        Changes of the run.
    run
        Gets what browsers do.
    views
        Seats that browsers may take, and what may be seen at each; a browser without one sees only
        what everybody may.
    sounds
        What is heard on the frequencies, piece by piece.
    notice
        Is told of what is refused.
    """

    def __init__(
        self,
        changes: Changes,
        run: Subscription,
        views: SeatViews,
        sounds: Changes,
        notice: Callable[[str], None],
    ) -> None:
        self._views = views
        self._refusals = Refusals(notice)
        self._changes = changes
        self._sounds = sounds
        self._run = run
        self._clients: dict[str, SeatClient] = {}
        """Clients of the seats that browsers have, by identity."""
        self._expiring: dict[str, asyncio.Task[None]] = {}
        """Tasks that give up the seats of browsers that are gone, by identity."""
        self._browsers: list[_Browser] = []
        self._empty_since_s: float | None = time.monotonic()

    @property
    def version(self) -> str:
        """Name of the page: another one for another run, or if its files have changed."""
        return f"{page_version()} {self._run.run}"

    @property
    def seats(self) -> tuple[str, ...]:
        """Names of the seats."""
        return tuple(self._views.own)

    def has_been_empty(self, seconds: float) -> bool:
        """Return true if there has been no browser for some time."""
        since_s = self._empty_since_s
        return since_s is not None and time.monotonic() - since_s >= seconds

    def admits(self, identity: str, audience: Audience) -> bool:
        """Return true if the browser of an identity may see something; it tells what is refused.

        In a run with seats, a browser sees what its own seat sees.
        """
        is_seen = any(self._views.sees(seat, audience) for seat in (None, self._seat_of(identity)))
        if not is_seen:
            self._refused("a file that is not for the seat of the browser, or without a seat")
        return is_seen

    async def serve(
        self, socket: WebSocket, begin: int, identity: str, version: str, shown_seat: str | None
    ) -> None:
        """Send the changes to a browser, and do what it wishes, until it leaves.

        Parameters
        ----------
        begin
            Number of the first change that the browser has not seen.
        identity
            Name that it keeps: with it, it has its seat again after a short loss of connection.
        version
            `version` of its page, empty if it is none.
        shown_seat
            Seat whose view the page shows already; None: it shows what everybody sees.
        """
        await socket.accept()
        if version not in ("", self.version):
            self._refused("a page of another version or run")
            await socket.close(OLD_PAGE, "This page is of another version or run. Load it again.")
            return
        await self._replace(identity)
        if (expiring := self._expiring.pop(identity, None)) is not None:
            expiring.cancel()
        browser = _Browser(socket, identity, shown_seat)
        browser.heard = self._sounds.next_number
        self._browsers.append(browser)
        self._empty_since_s = None
        tasks = [
            asyncio.create_task(doing)
            for doing in (
                self._send(browser, begin),
                self._listen(browser),
                self._do(browser),
            )
        ]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._browsers.remove(browser)
            if not self._browsers:
                self._empty_since_s = time.monotonic()
            if identity in self._clients and not self._has_browser(identity):
                self._expiring[identity] = asyncio.create_task(self._expire(identity))
            for task in tasks:
                task.cancel()
                with suppress(*ENDINGS):
                    await task
            if browser.is_on_air:
                await self._act(identity, "", ReleaseToTalk())
            await self._watch()

    async def _replace(self, identity: str) -> None:
        """Close the other connection of a page: the network was cut, and it has not ended yet."""
        for other in self._browsers:
            if identity and other.identity == identity:
                with suppress(*ENDINGS):
                    await other.socket.close(REPLACED, "This page has another connection.")

    async def _listen(self, browser: _Browser) -> None:
        """Take in what a browser wishes until it leaves, or sends what is no message."""
        while (received := await browser.socket.receive())["type"] != "websocket.disconnect":
            pcm: bytes | None = received.get("bytes")
            try:
                if pcm is not None:
                    wish = PageMessage(act=SayVoice.model_validate({"pcm": b64encode(pcm)}))
                else:
                    wish = PageMessage.model_validate_json(received.get("text") or "")
            except ValidationError as error:
                wrong = readable(first_problem(error), LONGEST_REASON)
                self._refused(f"a message of a browser: {wrong}", self._seat_of(browser.identity))
                await browser.socket.close(POLICY_VIOLATION, wrong)
                return
            if "watch" in wish.model_fields_set:
                await self._show(browser, wish.watch)
            elif wish.echo is not None:
                # At once: it is timed.
                await browser.socket.send_text(json.dumps({"echo": wish.echo}))
            elif wish.act is not None:
                await browser.acts.put((wish.seat, wish.act))

    async def _show(self, browser: _Browser, camera: str | None) -> None:
        """Let the pictures of a camera come, if they are for the browser."""
        seat = self._seat_of(browser.identity)
        is_shown = self._views.shows_camera(seat, camera or "")
        browser.watched = camera if is_shown else None
        await self._watch()

    async def _watch(self) -> None:
        watched = {one.watched for one in self._browsers if one.watched is not None}
        await asyncio.to_thread(self._run.watch, watched)

    def _refused(self, what: str, seat: str | None = None) -> None:
        """Tell what is refused; who has no seat does not use up what is told of a seat."""
        source = "of browsers without a seat" if seat is None else f"at the seat {readable(seat)}"
        self._refusals.tell(what, source)

    # --- seats ------------------------------------------------------------------------------

    async def _do(self, browser: _Browser) -> None:
        """Do what a browser wishes at its seat, in order, and answer."""
        while True:
            seat, act = await browser.acts.get()
            if isinstance(act, SayVoice):
                if browser.is_on_air and (why := await self._act(browser.identity, seat, act)):
                    browser.is_on_air = False
                    browser.tell("cut", why)
                continue
            why = await self._act(browser.identity, seat, act)
            if isinstance(act, PressToTalk | ReleaseToTalk):
                browser.is_on_air = isinstance(act, PressToTalk) and not why
            browser.tell("answer", why)

    async def _act(self, identity: str, seat: str, act: SeatAct) -> str:
        """Do something at a seat; return why that is refused, empty if it is not."""
        client = self._clients.get(identity)
        if isinstance(act, TakeSeat) and (client is None or client.seat != seat):
            return await self._take(identity, seat)
        if client is None:
            return NO_SEAT
        why = await asyncio.to_thread(client.act, act)
        if isinstance(act, LeaveSeat):
            await self._give_up(identity)
        return why

    async def _take(self, identity: str, seat: str) -> str:
        """Take a seat, and leave the other one that the browser has; return why it cannot."""
        if seat not in self._views.own:
            return f"{readable(seat)} is no seat of this page"
        client = await asyncio.to_thread(self._run.seat_client, seat, identity)
        if why := await asyncio.to_thread(client.take):
            await asyncio.to_thread(client.close)
            return why
        await self._give_up(identity)
        self._clients[identity] = client
        return ""

    async def _give_up(self, identity: str) -> None:
        client = self._clients.pop(identity, None)
        if client is not None:
            await asyncio.to_thread(client.close)

    async def _expire(self, identity: str) -> None:
        """Leave the seat of a browser that does not come back."""
        await asyncio.sleep(HOLD_S)
        del self._expiring[identity]
        await self._give_up(identity)

    def _has_browser(self, identity: str) -> bool:
        return any(one.identity == identity for one in self._browsers)

    def _seat_of(self, identity: str) -> str | None:
        """Return the seat that the browser of an identity has, as the run says."""
        client = self._clients.get(identity)
        if client is None or self._views.holder(client.seat) != client.holder:
            return None
        return client.seat

    def _seats_shown_to(self, browser: _Browser) -> dict[str, Any]:
        """Return what a browser is told of each seat."""
        own = self._seat_of(browser.identity)
        return {
            seat: {
                "is": "yours" if seat == own else "taken" if self._views.holder(seat) else "free",
                "recorded": self._views.records_voices(seat),
            }
            for seat in self._views.own
        }

    # --- what browsers are sent -------------------------------------------------------------

    async def _send(self, browser: _Browser, number: int) -> None:
        """Send all changes to a browser.

        Raises
        ------
        TimeoutError
            It takes nothing any more: the network is cut, which the connection alone does not tell
            while something waits to be sent.
        """

        async def send(text: str) -> None:
            async with asyncio.timeout(STALLED_S):
                await browser.socket.send_text(text)

        def is_seen(audience: Audience) -> bool:
            return self._views.sees(browser.shown_seat, audience)

        async def send_changes(first: int, end: int) -> int:
            """Send the changes before a number, and return the next number.

            It ends earlier when the browser is to see something else from then on.
            """
            while (
                first < end
                and not self._has_other_view(browser)
                and (batch := self._changes.since(first, end, is_seen)) is not None
            ):
                first = batch.next_number
                if batch.changes != "[]":
                    await send(f'{{"next":{first},"changes":{batch.changes}}}')
            return first

        # What has been comes before the seat is told: nothing of it sounds at the seat once more.
        number = await send_changes(number, self._changes.next_number)
        while True:
            if self._has_other_view(browser):
                browser.shown_seat = self._seat_of(browser.identity)
                browser.seen_of_seat = 0
                await send(json.dumps({"forget": True, "shown": browser.shown_seat}))
                number = await send_changes(0, self._changes.next_number)
            if (seats := self._seats_shown_to(browser)) != browser.told_seats:
                browser.told_seats = seats
                await send(json.dumps({"seats": seats}))
            if (own := self._own(browser)) is not None:
                await send(f'{{"own":{own}}}')
            while browser.unsent:
                await send(browser.unsent.popleft())
            if heard := self._heard_at(browser):
                await send(json.dumps({"sounds": heard}))
            end = min(self._changes.next_number, number + MOST_AT_ONCE)
            if number >= end:
                await asyncio.sleep(PERIOD_S)
                continue
            number = await send_changes(number, end)
            await asyncio.sleep(0)

    def _own(self, browser: _Browser) -> str | None:
        """Return what a browser has yet to get of its seat alone, as JSON, None if nothing."""
        seat = self._seat_of(browser.identity)
        batch = None if seat is None else self._views.own[seat].since(browser.seen_of_seat)
        if batch is None:
            return None
        browser.seen_of_seat = batch.next_number
        return batch.changes

    def _heard_at(self, browser: _Browser) -> list[Any]:
        """Return the pieces of sound, as JSON, that a browser has yet to get."""
        seat = self._seat_of(browser.identity)
        batch = self._sounds.since(
            browser.heard, admits=lambda audience: self._views.hears(seat, audience)
        )
        if batch is None:
            return []
        browser.heard = batch.next_number
        tuned_khz = self._views.tuned_khz(seat)
        heard = json.loads(batch.changes)
        return [piece for piece in heard if piece[1]["frequency_khz"] in tuned_khz]

    def _has_other_view(self, browser: _Browser) -> bool:
        """Return true if the page of a browser shows the view of another seat than it has now."""
        return browser.shown_seat != self._seat_of(browser.identity)
