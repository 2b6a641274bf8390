"""The browsers that look at a run: each gets its changes, and says what it watches and does."""

from __future__ import annotations

import asyncio
import json
import time
from base64 import b64encode
from collections import deque
from collections.abc import Callable, Collection, Coroutine, Mapping
from contextlib import suppress
from secrets import token_hex
from types import MappingProxyType
from typing import Any

from fastapi import WebSocket, WebSocketDisconnect
from pydantic import ValidationError

from airhilt.errors import first_problem
from airhilt.messages import (
    MicrophoneAudio,
    PaceCommand,
    SeatListening,
    SpokenWords,
    Use,
)
from airhilt.station.audiences import Audience, SeatViews
from airhilt.station.changes import MOST_AT_ONCE, Changes, SeatChanges
from airhilt.station.consents import NO_VOICE, NO_WORDS, Consents
from airhilt.station.held_button import HeldButton, what_is_wrong_with
from airhilt.station.page_files import page_version
from airhilt.station.refusals import Refusals
from airhilt.station.seat_book import Hold, SeatBook
from airhilt.station.wishes import Claimed, ConsentAnswer, Pressed, RunLink, Wish
from airhilt.text import readable

PERIOD_S = 0.05
"""Time between two messages to a browser, in s."""
MOST_BROWSERS = 20
"""Largest number of browsers at a time."""
SILENT_S = 4.0
"""Time after which a browser that says nothing may be gone, in s: pages ask every 2 s."""
STALLED_S = 5.0
"""Time after which a browser is gone that takes nothing of what is sent to it, in s."""
ENDINGS = (asyncio.CancelledError, TimeoutError, WebSocketDisconnect, RuntimeError)
"""Exceptions with which a connection ends: Starlette raises the last one on a closed connection."""
POLICY_VIOLATION, TRY_LATER = 1008, 1013
"""Codes with which a WebSocket is closed (RFC 6455, 7.4.1, and IANA's registry)."""
OLD_PAGE = 4426
"""Likewise, of those that applications choose: the page has to be loaded again."""
CLAIMED_ELSEWHERE: Mapping[Claimed, str] = {
    "taken": "Somebody has the seat {seat} at another page of this run.",
    "claimed": "Somebody else may be about to take the seat {seat} at another page of this run. "
    "Try again.",
}
"""Reasons for which a seat cannot be claimed."""
ON_THE_AIR = "You are on the air. End your call before you take another seat."
"""Reason for which who transmits cannot take another seat."""
NO_PAUSE = "This run has no pause and no slow motion."
"""Reason for which nobody changes how fast the time passes."""
LONGEST_REASON = 100
"""Greatest length of a reason for closing, in characters; the protocol has 123 bytes."""


class _Browser:
    """One browser: what it watches, its seat, and what it has yet to be told."""

    def __init__(self, socket: WebSocket, identity: str) -> None:
        self.socket = socket
        self.identity = identity
        """Name that it keeps when its connection is lost; empty: it has none."""
        self.last_heard_s = time.monotonic()
        self.watched: str | None = None
        self.seen_of_seat = 0
        """Number of the first change of the seat that it has not seen."""
        self.shown_seat: str | None = None
        """Seat whose view its page shows; None: it shows what everybody sees."""
        self.tuned: frozenset[int] = frozenset()
        """Frequencies in kHz that are heard at its seat."""
        self.heard = 0
        """Number of the first piece of sound that it has not got."""
        self.button: HeldButton | None = None
        """Its transmit button, while it is held."""
        self.pressed_at = ""
        """Seat at which its button was pressed last."""
        self.is_voice_refused = False
        """True if it was told that the sound that comes now is refused."""
        self.unsent: deque[str] = deque()
        self.is_consent_untold = False
        """True if it is to be told, after what is in `unsent`, to what its person agrees then."""
        self.answered: list[int] = []
        """Numbers of the answers about consent that were passed on, of which it is not told yet."""

    def tell(self, kind: str, what: Any) -> None:
        self.unsent.append(json.dumps({kind: what}))


class Browsers:
    """Serves the browsers, gives them seats, and knows how many there are.

    Parameters
    ----------
    changes
        Changes of the run.
    run
        Gets what browsers do.
    seats
        Seats that browsers may take, one browser each, and the changes that only the person there
        sees.
    sounds
        What is heard on the frequencies, piece by piece; None: nothing is heard.
    notice
        Is told of what is refused: some of each seat, and some of all browsers without one.
    views
        What may be seen at each seat; a browser without one sees only what everybody may.
    agreed
        Use to which who takes a seat first has agreed before, by seat.
    """

    def __init__(
        self,
        changes: Changes,
        run: RunLink,
        seats: Mapping[str, SeatChanges] = MappingProxyType({}),
        sounds: Changes | None = None,
        notice: Callable[[str], None] = lambda _: None,
        views: SeatViews | None = None,
        agreed: Mapping[str, Use] = MappingProxyType({}),
    ) -> None:
        self._book = SeatBook[_Browser](seats)
        self._views = views or SeatViews(seats)
        self._refusals = Refusals(notice)
        self._consents = Consents(agreed)
        self._changes = changes
        self._of_seats = seats
        self._sounds = sounds or Changes()
        self._run = run
        self._known: dict[str, bool | None] = dict.fromkeys(seats, False)
        """By seat, True if the run knows that it is taken; None: it is to be told in any case."""
        self._listened: dict[str, frozenset[int]] = {}
        """Frequencies in kHz by seat, as the run was told that its person listens to them."""
        self._informing = asyncio.Lock()
        """Held while the run is told who has a seat."""
        self._taking = {seat: asyncio.Lock() for seat in seats}
        """By seat, held while a browser takes it: the claims to it come one after the other."""
        self._unended: set[asyncio.Task[None]] = set()
        """Tasks that go on to their end, whatever becomes of the browser that wished them."""
        self._browsers: list[_Browser] = []
        self._empty_since_s: float | None = time.monotonic()
        self.serving = token_hex(8)
        """Name of this start of the server, which no other start has."""

    @property
    def seats(self) -> tuple[str, ...]:
        """Names of the seats."""
        return self._book.seats

    def has_been_empty(self, seconds: float) -> bool:
        """Return true if there has been no browser for some time."""
        since_s = self._empty_since_s
        return since_s is not None and time.monotonic() - since_s >= seconds

    def admits(self, identity: str, audience: Audience) -> bool:
        """Return true if the browser of an identity may see something; it tells what is refused.

        In a run with seats, a browser sees what its own seat sees.
        """
        named = (one for one in self._browsers if identity and one.identity == identity)
        own = map(self._book.of, named)
        is_seen = any(self._views.sees(seat, audience) for seat in (None, *own))
        if not is_seen:
            self._refused("a file that is not for the seat of the browser, or without a seat")
        return is_seen

    async def serve(
        self,
        socket: WebSocket,
        begin: int = 0,
        identity: str = "",
        version: str = "",
        shown_seat: str | None = None,
        serving: str = "",
    ) -> None:
        """Send the changes to a browser, and do what it wishes, until it leaves.

        Parameters
        ----------
        begin
            Number of the first change that the browser has not seen.
        identity
            Name that it keeps: with it, it has its seat again after a short loss of connection.
        version
            Version of its page, empty if it is none.
        shown_seat
            Seat whose view the page shows already; None: it shows what everybody sees.
        serving
            Start of the server from which its page is, empty if it is none.
        """
        await socket.accept()
        if version not in ("", page_version()):
            self._refused("a page of another version")
            await socket.close(OLD_PAGE, "This page is of another version. Load it again.")
            return
        if serving not in ("", self.serving):
            self._refused("a page of another run, or of an earlier start of the server")
            await socket.close(OLD_PAGE, "The server was started anew. Load the page again.")
            return
        if len(self._browsers) >= MOST_BROWSERS:
            await socket.close(TRY_LATER, f"{MOST_BROWSERS} browsers look already")
            return
        browser = _Browser(socket, identity)
        browser.heard, browser.shown_seat = self._sounds.next_number, shown_seat
        self._browsers.append(browser)
        self._empty_since_s = None
        await self._give_back(browser)
        seat = self._book.of(browser)
        if seat is not None and browser.shown_seat != seat:
            self._consents.begin(seat)  # The page was loaded again: it asks again.
        self._tell_seats()
        self._tell_consent(browser)
        sending = asyncio.create_task(self._send(socket, browser, begin))
        listening = asyncio.create_task(self._listen(socket, browser))
        try:
            await asyncio.wait((sending, listening), return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._browsers.remove(browser)  # First of all: whatever fails now, the seat is free.
            back = self._hold(browser)
            self._tell_seats()
            if back is not None:
                self._tell_consent(back)
            if not self._browsers:
                self._empty_since_s = time.monotonic()
            for task in (sending, listening):
                task.cancel()
                with suppress(*ENDINGS):
                    await task
            await self._release(browser)
            await self._watch()

    async def _listen(self, socket: WebSocket, browser: _Browser) -> None:
        """Do what a browser wishes until it leaves, or sends what is no wish."""
        while (received := await socket.receive())["type"] != "websocket.disconnect":
            browser.last_heard_s = time.monotonic()
            pcm: bytes | None = received.get("bytes")
            wrong = None if pcm is None else what_is_wrong_with(pcm)
            try:
                if pcm is None:
                    await self._do(browser, Wish.model_validate_json(received.get("text") or ""))
                elif wrong is None:
                    await self._hear(browser, pcm)
            except ValidationError as error:
                wrong = first_problem(error)
            if wrong is not None:
                what = f"a message of a browser: {readable(wrong, LONGEST_REASON)}"
                self._refused(what, self._book.of(browser))
                await socket.close(POLICY_VIOLATION, readable(wrong, LONGEST_REASON))
                return

    async def _do(self, browser: _Browser, wish: Wish) -> None:
        if "watch" in wish.model_fields_set:
            await self._show(browser, wish.watch)
        elif wish.echo is not None:
            await browser.socket.send_text(json.dumps({"echo": wish.echo}))  # At once: it is timed.
        elif wish.take is not None:
            await asyncio.shield(self._to_the_end(self._take(browser, wish.take)))
        elif wish.leave is not None:
            await asyncio.shield(self._to_the_end(self._leave(browser)))
        elif wish.release is not None:
            browser.is_voice_refused = False
            await self._release(browser)  # It was let go, perhaps by a page that has left the seat.
        elif (seat := self._book.of(browser)) is None:
            self._refuse(browser, "You have no seat. Take one first.")
        else:
            await self._do_at_seat(browser, seat, wish)

    async def _do_at_seat(self, browser: _Browser, seat: str, wish: Wish) -> None:
        if wish.say is not None:
            await self._say(browser, seat, wish.say)
        elif wish.fly is not None:
            await asyncio.to_thread(self._run.fly, seat, wish.fly)
        elif wish.perceived is not None:
            await asyncio.to_thread(self._run.perceive, seat, wish.perceived)
        elif wish.heard is not None:
            await asyncio.to_thread(self._run.hear, seat, wish.heard)
        elif wish.press is not None:
            await self._press(browser, seat, wish.press)
        elif wish.answer is not None:
            await asyncio.to_thread(self._run.answer, seat, wish.answer)
        elif wish.tune is not None:
            await self._tune(browser, seat, frozenset(wish.tune))
        elif wish.consent is not None:
            taking = self._take_consent(browser, seat, wish.consent)
            await asyncio.shield(self._to_the_end(taking))
        elif wish.pace is not None:
            await self._set_pace(browser, seat, wish.pace)

    async def _set_pace(self, browser: _Browser, seat: str, pace: PaceCommand) -> None:
        view = self._views.of(seat)
        if view is not None and not view.may_pause:
            self._refuse(browser, NO_PAUSE)
        else:
            await asyncio.to_thread(self._run.set_pace, pace)

    async def _show(self, browser: _Browser, camera: str | None) -> None:
        """Let the pictures of a camera come, if they are for the browser.

        Who has lost the seat asks once more for the camera that was shown there, and gets nothing.
        """
        seat = self._book.of(browser)
        is_shown = self._views.shows_camera(seat, camera or "")
        if camera is not None and not is_shown and seat is not None:
            self._refuse(browser, f"The camera {readable(camera)} is not for your seat.")
        browser.watched = camera if is_shown else None
        await self._watch()

    async def _tune(self, browser: _Browser, seat: str, frequencies_khz: frozenset[int]) -> None:
        """Let a browser hear frequencies of its seat, and tell the run if they have changed."""
        view = self._views.of(seat)
        own = frozenset() if view is None else view.frequencies_khz
        if frequencies_khz - own:
            self._refuse(browser, "You listen to a frequency that your seat does not have.")
        browser.tuned = frequencies_khz & own
        if self._listened.get(seat) != browser.tuned:
            self._listened[seat] = browser.tuned
            listening = SeatListening(frequencies_khz=tuple(sorted(browser.tuned)))
            await asyncio.to_thread(self._run.listen, seat, listening)

    def _refuse(self, browser: _Browser, why: str) -> None:
        browser.tell("refused", why)
        self._refused(f"a wish of a browser: {why}", self._book.of(browser))

    def _refused(self, what: str, seat: str | None = None) -> None:
        """Tell what is refused; who has no seat does not use up what is told of a seat."""
        source = "of browsers without a seat" if seat is None else f"at the seat {readable(seat)}"
        self._refusals.tell(what, source)

    # --- voice and words --------------------------------------------------------------------

    async def _take_consent(self, browser: _Browser, seat: str, consent: ConsentAnswer) -> None:
        """Keep what a person agrees to while it has the seat, and tell the run.

        A call of a person who does not let the voice be used any more ends.
        """
        self._consents.take(seat, consent.answer)
        if not self._consents.admits_voice(seat):
            await self._release(browser)
        await asyncio.to_thread(self._run.consent, seat, consent.answer)
        browser.answered.append(consent.number)
        self._tell_consent(browser)

    def _tell_consent(self, browser: _Browser) -> None:
        """Tell a browser what its person agrees to, as far as this station knows.

        It is told how that is when the message is sent, and which answers that counts: so it knows
        which of its answers are still to come.
        """
        browser.is_consent_untold = True

    async def _say(self, browser: _Browser, seat: str, words: SpokenWords) -> None:
        if self._consents.admits_words(seat):
            await asyncio.to_thread(self._run.say, seat, words)
        else:
            self._refuse(browser, NO_WORDS)
            self._tell_consent(browser)

    def _refuse_voice(self, browser: _Browser) -> None:
        """Refuse what is spoken, once for each call."""
        if not browser.is_voice_refused:
            browser.is_voice_refused = True
            self._refuse(browser, NO_VOICE)
            self._tell_consent(browser)

    async def _press(self, browser: _Browser, seat: str, pressed: Pressed) -> None:
        browser.is_voice_refused = False
        if not self._consents.admits_voice(seat):
            self._refuse_voice(browser)
            return
        browser.button, browser.pressed_at = HeldButton(), seat
        audio = MicrophoneAudio(
            phase="pressed", frequency_khz=pressed.frequency_khz, delay_s=pressed.delay_s
        )
        await asyncio.to_thread(self._run.speak, seat, audio)

    async def _hear(self, browser: _Browser, pcm: bytes) -> None:
        """Pass on the sound of a microphone; what comes after its release is left out.

        So is what comes after the seat was left.
        """
        seat = self._book.of(browser)
        is_admitted = self._consents.admits_voice(seat)
        if seat is not None and not is_admitted:
            self._refuse_voice(browser)
        if browser.button is None or not is_admitted:
            return
        if not browser.button.admits(pcm):
            await self._release(browser)
            self._refuse(browser, "Your call was cut: more sound came than anybody can speak.")
            return
        encoded = {"phase": "samples", "pcm": b64encode(pcm)}
        audio = MicrophoneAudio.model_validate(encoded)
        await asyncio.to_thread(self._run.speak, browser.pressed_at, audio)

    async def _release(self, browser: _Browser) -> None:
        if browser.button is not None:
            browser.button = None
            released = MicrophoneAudio(phase="released")
            await asyncio.to_thread(self._run.speak, browser.pressed_at, released)

    # --- seats ------------------------------------------------------------------------------

    def _to_the_end(self, doing: Coroutine[None, None, None]) -> asyncio.Task[None]:
        """Do something that no browser ends by going away."""
        task = asyncio.create_task(doing)
        self._unended.add(task)
        task.add_done_callback(self._unended.discard)
        return task

    async def _take(self, browser: _Browser, seat: str) -> None:
        """Give a seat to a browser; who is refused it keeps the one that it has."""
        if self._book.of(browser) == seat:
            return  # The button was pressed twice.
        why = self._book.why_not(browser, seat) or (ON_THE_AIR if browser.button else None)
        if why is None:
            async with self._taking[seat]:
                why = self._book.why_not(browser, seat) or await self._claim(seat)
                if why is None and browser in self._browsers:
                    self._of_seats[seat].forget_notices()
                    await self._move(browser, seat)
                    if (before := self._consents.before(seat)) is not None:
                        await asyncio.to_thread(self._run.consent, seat, before)
                else:
                    await self._inform()  # The claim is withdrawn.
        if why is not None:
            self._refuse(browser, why)

    async def _claim(self, seat: str) -> str | None:
        """Claim a seat from the other pages of the run; return why that cannot be."""
        if not self._book.is_free(seat):
            return None  # It was kept for the browser: this page has it.
        if self._known[seat] is not False:
            await self._inform()  # Its last person has just left it.
        claimed = await asyncio.to_thread(self._run.claim, seat)
        if claimed == "ours":
            self._known[seat] = None
            return None
        if claimed == "taken":
            self._consents.end(seat)  # Somebody has had it first, at another page.
        return CLAIMED_ELSEWHERE[claimed].format(seat=readable(seat))

    async def _leave(self, browser: _Browser) -> None:
        """Give back the seat of a browser."""
        await self._release(browser)
        await self._move(browser, None)

    async def _move(self, browser: _Browser, seat: str | None) -> None:
        """Give a browser another seat, or none, and give back the one that it has.

        It has the other one before anything is waited for, so that nobody else can take it.
        """
        left = self._book.move(browser, seat)
        if left is not None:
            self._consents.end(left)
        if seat is not None:
            self._consents.begin(seat)
        browser.tuned, browser.seen_of_seat = frozenset(), 0
        if left is not None:
            browser.watched = None
        self._tell_seats()
        self._tell_consent(browser)
        await self._inform()
        if left is not None:
            await self._watch()

    async def _inform(self) -> None:
        """Tell the run who has a seat, until it knows what the book says."""
        async with self._informing:
            while (seat := self._untold()) is not None:
                is_taken = not self._book.is_free(seat)
                if not is_taken:
                    self._listened.pop(seat, None)
                await asyncio.to_thread(self._run.occupy, seat, is_taken=is_taken)
                self._known[seat] = is_taken

    def _untold(self) -> str | None:
        """Return a seat of which the run does not know what the book says, None if there is none.

        A seat that was left comes first, so that nobody is at two.
        """
        is_taken = {seat: not self._book.is_free(seat) for seat in self._known}
        untold = (seat for seat, is_known in self._known.items() if is_known is not is_taken[seat])
        return min(untold, key=is_taken.__getitem__, default=None)

    async def _give_back(self, browser: _Browser) -> None:
        """Give a browser the seat that it had before its connection was lost.

        The old connection may not have ended yet, if the network is cut; it brings nothing then.
        """
        if not browser.identity:
            return
        silent = next((one for one in self._browsers if self._is_silent(one, browser)), None)
        if silent is None:
            self._book.give_back(browser)
        else:
            self._book.move(browser, self._book.move(silent, None))
            await self._release(silent)

    def _is_silent(self, old: _Browser, new: _Browser) -> bool:
        """Return true if an old connection has a seat of the browser of a new one, and is cut."""
        is_same = old is not new and old.identity == new.identity
        has_seat = self._book.of(old) is not None
        return is_same and has_seat and time.monotonic() - old.last_heard_s > SILENT_S

    def _hold(self, browser: _Browser) -> _Browser | None:
        """Keep the seat of a browser that is gone, in case that it comes back.

        If it has come back already, it has the seat at once: return it then.
        """
        hold = self._book.hold(browser)
        if hold is None:
            return None
        named = (one for one in self._browsers if one.identity and one.identity == hold.identity)
        back = next((one for one in named if self._book.of(one) is None), None)
        if back is None:
            self._to_the_end(self._expire(hold))
        else:
            self._book.move(back, hold.seat)
            self._consents.begin(hold.seat)  # Its page was told that it had no seat: it asks again.
        return back

    async def _expire(self, hold: Hold) -> None:
        """Give a seat back whose browser has not come back."""
        await asyncio.sleep(hold.seconds)
        if self._book.expire(hold):
            self._consents.end(hold.seat)
            self._tell_seats()
            await self._inform()

    def _tell_seats(self) -> None:
        """Tell each browser which seats are free, taken, or its own."""
        for browser in self._browsers:
            browser.tell("seats", self._book.shown_to(browser))

    async def _watch(self) -> None:
        watched = {one.watched for one in self._browsers if one.watched is not None}
        await asyncio.to_thread(self._run.watch, watched)

    async def _send(self, socket: WebSocket, browser: _Browser, number: int) -> None:
        """Send all changes to a browser.

        Raises
        ------
        TimeoutError
            It takes nothing any more: the network is cut, which the connection alone does not tell
            while something waits to be sent.
        """

        async def send(text: str) -> None:
            async with asyncio.timeout(STALLED_S):
                await socket.send_text(text)

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
            while browser.unsent or self._has_other_view(browser):
                if self._has_other_view(browser):
                    browser.shown_seat = self._view_of(browser)
                    await send(json.dumps({"forget": True, "shown": browser.shown_seat}))
                    number = await send_changes(0, self._changes.next_number)
                else:
                    await send(browser.unsent.popleft())
            if browser.is_consent_untold:
                browser.is_consent_untold = False
                given = self._consents.given_at(self._book.of(browser))
                answered, browser.answered = browser.answered, []
                await send(json.dumps({"consent": {"given": given, "answered": answered}}))
            if (own := self._own(browser)) is not None:
                await send(f'{{"own":{own}}}')
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
        seat = self._book.of(browser)
        batch = None if seat is None else self._of_seats[seat].since(browser.seen_of_seat)
        if batch is None:
            return None
        browser.seen_of_seat = batch.next_number
        return batch.changes

    def _heard_at(self, browser: _Browser) -> list[Any]:
        """Return the pieces of sound, as JSON, that a browser has yet to get."""
        view = self._views.of(self._book.of(browser))

        def is_heard(audience: Audience) -> bool:
            return view is not None and view.hears(audience)

        batch = self._sounds.since(browser.heard, admits=is_heard)
        if batch is None:
            return []
        browser.heard = batch.next_number
        return _on(browser.tuned, batch.changes)

    def _view_of(self, browser: _Browser) -> str | None:
        """Return the seat whose view a browser is shown; None: it is shown what everybody sees."""
        seat = self._book.of(browser)
        return None if self._views.of(seat) is None else seat

    def _has_other_view(self, browser: _Browser) -> bool:
        """Return true if the page of a browser shows the view of another seat than it has now."""
        return browser.shown_seat != self._view_of(browser)


def _on(tuned: Collection[int], changes: str) -> list[Any]:
    """Return the pieces of sound, as JSON, that are on the frequencies that are tuned to."""
    return [piece for piece in json.loads(changes) if piece[1]["frequency_khz"] in tuned]
