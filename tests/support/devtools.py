"""Drives a headless Chromium by the DevTools protocol over a pipe, with the standard library."""

from __future__ import annotations

import itertools
import json
import os
import select
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
ARGUMENTS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--hide-scrollbars", "--remote-debugging-pipe",
)  # fmt: skip
PATIENCE_S = 120.0
RESTING_PLACE = f"""(element) => new Promise((found, failed) => {{
    const due = performance.now() + {PATIENCE_S * 1000.0};
    let before = null;
    const look = () => {{
        const {{ x, y, width, height }} = element.getBoundingClientRect(),
            place = [x + width / 2, y + height / 2],
            isOnTop = element.contains(document.elementFromPoint(...place));
        if (isOnTop && String(place) === before) found(place);
        else if (performance.now() > due) failed(new Error(`nobody can click on ${{element.id}}`));
        else requestAnimationFrame(look);
        before = isOnTop ? String(place) : null;
    }};
    look();
}})"""
"""Function of a page that finds where an element is, once it moves no more and nothing covers it.

A browser tells a click by what it has drawn: an element that has just come is not there yet.
"""


class Page:
    """One page of the browser, and what its console said."""

    def __init__(self, commands: int, answers: int) -> None:
        self.complaints: list[str] = []
        self._commands = commands
        self._answers = answers
        self._received = b""
        self._ids = itertools.count(1)
        self._session: str | None = None
        self._events: list[str] = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Do one thing and return the answer."""
        number = next(self._ids)
        message: dict[str, Any] = {"id": number, "method": method, "params": parameters}
        if self._session is not None:
            message["sessionId"] = self._session
        os.write(self._commands, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._receive()
            if answer.get("id") == number:
                assert "error" not in answer, f"{method}: {answer['error']}"
                result: dict[str, Any] = answer["result"]
                return result

    def open(
        self, place: Path | str, width: int = 1280, height: int = 900, dark: bool = False
    ) -> None:
        """Open a file or a URL in a window of this size and wait until it is drawn."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width, height=height, deviceScaleFactor=1, mobile=False,
        )  # fmt: skip
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])
        self._events.clear()
        url = place if isinstance(place, str) else place.resolve().as_uri()
        self.call("Page.navigate", url=url)
        while "Page.loadEventFired" not in self._events:
            self._receive()

    def evaluate(self, expression: str) -> Any:
        """Return the value of an expression in the page."""
        answer = self.call(
            "Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def wait_for(self, expression: str) -> None:
        """Wait until an expression in the page is true."""
        due = time.monotonic() + PATIENCE_S
        while not self.evaluate(f"Boolean({expression})"):
            assert time.monotonic() < due, f"never true: {expression}"
            time.sleep(0.05)

    def press(self, key: str, code: int) -> None:
        """Press a key and let it go."""
        for kind in ("keyDown", "keyUp"):
            self.key(kind, key, code)

    def key(self, kind: str, key: str, code: int, *, repeats: bool = False) -> None:
        """Press a key (``keyDown``) or let it go (``keyUp``); one that is held repeats."""
        text = {"Enter": "\r", " ": " "}.get(key, "") if kind == "keyDown" else ""
        self.call(
            "Input.dispatchKeyEvent",
            type=kind, key=key, windowsVirtualKeyCode=code, autoRepeat=repeats, text=text,
        )  # fmt: skip

    def click(self, name: str) -> None:
        """Click on the element with an id, as a person does: where it has come to rest."""
        x, y = self.evaluate(f"({RESTING_PLACE})(document.getElementById({name!r}))")
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def activate(self, name: str) -> None:
        """Do what a click does, wherever the element is: what comes and goes may move it."""
        element = f"document.getElementById({name!r})"
        script = f"{element}.focus(); {element}.click()"
        answer = self.call("Runtime.evaluate", expression=script, userGesture=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]

    def _receive(self) -> dict[str, Any]:
        due = time.monotonic() + PATIENCE_S
        while b"\0" not in self._received:
            ready, _, _ = select.select([self._answers], [], [], max(due - time.monotonic(), 0.0))
            assert ready, "the browser does not answer"
            received = os.read(self._answers, 1 << 20)
            assert received, "the browser has ended"
            self._received += received
        one, _, self._received = self._received.partition(b"\0")
        message: dict[str, Any] = json.loads(one)
        self._note(message)
        return message

    def _note(self, message: dict[str, Any]) -> None:
        method, parameters = message.get("method", ""), message.get("params", {})
        self._events.append(method)
        if method == "Runtime.exceptionThrown":
            self.complaints.append(json.dumps(parameters["exceptionDetails"]))
        elif method == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
            self.complaints.append(parameters["entry"]["text"])
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning"):
            self.complaints.append(json.dumps(parameters["args"]))


@contextmanager
def browser_page(executable: str, *more: str) -> Iterator[Page]:
    """Start a browser, with more arguments, yield its page, and end the browser."""
    to_browser, commands = os.pipe()
    answers, from_browser = os.pipe()
    # The browser reads from descriptor 3 and writes to 4; a shell puts the pipes there.
    shell = f'exec "$0" "$@" 3<&{to_browser} 4>&{from_browser}'
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        process = subprocess.Popen(
            ["bash", "-c", shell, executable, *ARGUMENTS, *more, f"--user-data-dir={profile}"],
            pass_fds=(to_browser, from_browser),
            start_new_session=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)
        try:
            yield Page(commands, answers)
        finally:
            os.close(commands)
            os.close(answers)
            os.killpg(process.pid, signal.SIGKILL)  # It would take its time to end by itself.
            process.wait(timeout=PATIENCE_S)
