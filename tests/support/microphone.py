"""A browser whose microphone plays a file, and somebody who talks into it."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.audio.wav import write_wav
from devtools import BROWSERS, Page, browser_page
from seats import voice

PAUSE_S = 2.0
"""Silence after the words, before they come again."""
FAKE = ("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream")
BUTTON = "document.getElementById('talk-button').textContent"
TALK_STATE = "document.getElementById('talk-state').textContent"
SAY = "document.getElementById('say-button').click()"
"""Script that says what is typed."""
SAID = """new Promise((done) => {
    let last = null;
    const look = setInterval(() => {
        const level = Number(document.getElementById('talk-level').value), now = performance.now();
        if (level > 0.05) last = now;
        else if (last !== null && now - last > 700) { clearInterval(look); done(true); }
    }, 20);
})"""
"""True as soon as something has been said and 0.7 s have passed since."""
NO_CONNECTION = """(() => {
    const there = Object.getOwnPropertyDescriptor(WebSocket.prototype, 'readyState');
    const set = (one) => Object.defineProperty(WebSocket.prototype, 'readyState', one);
    set({ get: () => 3, configurable: true });
    window.connect = () => { set(there); };
})()"""
"""Closes the connection for the page, until it calls `connect`."""


def microphone_file(path: Path, text: str) -> Path:
    """Write a file in which a text is said, to be played again and again."""
    pause = np.zeros(round(PAUSE_S * SAMPLE_RATE_HZ), np.float32)
    write_wav(path, np.concatenate([voice(text), pause]))
    return path


@contextmanager
def page_with_microphone(*arguments: str) -> Iterator[Page]:
    """Start a browser with arguments, yield its page, and check that it has no complaints."""
    executable = next((found for name in BROWSERS if (found := shutil.which(name))), None)
    if executable is None:
        pytest.skip("no Chromium on PATH: apt-get install chromium")
    with browser_page(executable, *arguments) as page:
        yield page
        assert page.complaints == []


def playing(path: Path) -> tuple[str, ...]:
    """Return the arguments of a browser whose microphone plays a file."""
    return (*FAKE, f"--use-file-for-fake-audio-capture={path}")


def sit_down(page: Page, url: str, seat: str | None = None, uses: str = "voice") -> None:
    """Open the page and take a seat with what may be used; None: the first seat."""
    page.open(url, width=1280, height=720)
    state = "document.getElementById('state').textContent"
    page.wait_for(f"['paused', 'running'].some((one) => {state}.startsWith(one))")
    if seat is not None:
        page.evaluate(f"document.getElementById('seat-name').value = {seat!r}")
    page.evaluate(f"document.getElementById('seat-uses').value = {uses!r}")
    page.activate("seat-take")
    page.wait_for("!document.getElementById('talk').hidden")


def open_microphone(page: Page) -> None:
    """Open the microphone, and wait until it can be used or is refused."""
    page.activate("talk-button")
    page.wait_for(f"{BUTTON} === 'Hold to talk' || {TALK_STATE}.includes('Type')")


def talk(page: Page) -> None:
    """Hold the space bar while the file is said once, from one pause to the next."""
    page.evaluate(SAID)
    page.key("keyDown", " ", 32)
    page.wait_for(f"{BUTTON} === 'On the air'")
    page.evaluate(SAID)
    page.key("keyUp", " ", 32)
