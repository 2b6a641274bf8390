"""Opens the page of a run as a user does, with a server in a process of its own."""

from __future__ import annotations

import asyncio
import collections
import json
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import MappingProxyType
from typing import Any

import httpx
import psutil
import pytest
from cryptography import x509
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.hashes import SHA256
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat
from cryptography.x509.oid import NameOID
from fastapi import FastAPI
from websockets.sync.client import ClientConnection, connect

from airhilt.commands import Command
from airhilt.messages import (
    AdvisoryPerceived,
    CallHeard,
    Message,
    MicrophoneAudio,
    PaceCommand,
    SeatConsent,
    SeatInfo,
    SeatListening,
    Severity,
    SpokenWords,
    Use,
    WorkloadAnswer,
)
from airhilt.station import seat_book
from airhilt.station.address import Address
from airhilt.station.app import live_app
from airhilt.station.audiences import SeatViews, heard_by
from airhilt.station.browsers import Browsers
from airhilt.station.changes import Changes, SeatChanges
from airhilt.station.pictures import Picture
from airhilt.station.server import serve
from airhilt.station.subscription import Sound
from airhilt.station.wishes import Claimed

PATIENCE_S = 60.0
FREED_WITHIN_S = 10.0
"""Time in which a seat is free whose page is closed, in s; it is not after a test that failed."""
TOKEN = "0123456789abcdef0123456789abcdef"
TOWER = SeatInfo(
    seat="TOWER", recipients=("TOWER", "ATC"), frequencies_khz=(119_100,), has_sound=True,
    is_recognised=True, voice_is_recorded=True, longest_call_s=60.0,
    spoken_from=Severity.CAUTION,
)  # fmt: skip

ADVISORY: dict[str, Any] = {
    "t": 0.5, "equipment": "", "id": "a-1", "revision": 1, "severity": "WARNING", "active": True,
    "kind": "loss_of_separation", "traffic": ["AAL123", "DAL456"],
    "texts": [{"recipient": "ATC", "message": "Both lose separation.", "recommendation": None}],
    "evidence": {
        "sources": ["adsb"], "shares": {}, "note": "", "rules": [], "runway": None,
        "time_to_go_s": None, "time_to_loss_s": None, "radio_ids": [], "camera_ids": [],
        "tracks": [], "inconsistencies": [],
    },
}  # fmt: skip
"""An advisory as the page is told it."""


def reachable(folder: Path) -> list[str]:
    """Return options by which other machines reach a page, with new files in a folder."""
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "station")])
    now = datetime.now(UTC)
    certificate = (
        x509.CertificateBuilder(name, name, key.public_key(), x509.random_serial_number())
        .not_valid_before(now - timedelta(hours=1))
        .not_valid_after(now + timedelta(hours=1))
        .sign(key, SHA256())
    )
    files = {
        "--certificate": certificate.public_bytes(Encoding.PEM),
        "--key": key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption()),
        "--token-file": TOKEN.encode(),
    }
    for option, content in files.items():
        (folder / option.strip("-")).write_bytes(content)
    return ["--host=0.0.0.0", *(f"{one}={folder / one.strip('-')}" for one in files)]


@contextmanager
def viewed(*run_folders: Path) -> Iterator[str]:
    """Start `airhilt view`, yield the URL that it prints, and interrupt it."""
    with _served("view", *map(str, run_folders)) as url:
        yield url


@contextmanager
def experimenting(plan: Path, *options: str) -> Iterator[str]:
    """Start `airhilt experiment`, yield the URL that it prints, and interrupt it."""
    with _served("experiment", str(plan), *options) as url:
        yield url


@contextmanager
def _served(*command: str) -> Iterator[str]:
    arguments = [*command, "--port", "0", "--no-browser"]
    process = subprocess.Popen(
        [sys.executable, "-m", "airhilt", *arguments], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    with process.stdout:
        try:
            yield process.stdout.readline().split()[0]
        finally:
            process.send_signal(signal.SIGINT)
            assert process.wait(timeout=PATIENCE_S) == 0


@contextmanager
def running(
    encounter_file: Path, out: Path, *options: str, speech: bool = False
) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Start a run with its page; yield its process and the URL, and interrupt what goes on."""
    command = [sys.executable, "-m", "airhilt", "cosim", "--scenario", str(encounter_file)]
    command += ["--view", "--no-browser", "--port", "0", "--pace", "realtime"]
    command += [] if speech else ["--no-speech"]
    command += ["--latency", "fixed", "--out", str(out), *options]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True
    )
    assert process.stderr is not None
    # A run stands still once nobody reads what it tells.
    reader = threading.Thread(target=collections.deque, args=(process.stderr, 0))
    with process.stderr:
        try:
            url = url_of(process.stderr)
            reader.start()
            yield process, url
        finally:
            if process.poll() is None:
                for child in psutil.Process(process.pid).children():
                    child.kill()
                process.send_signal(signal.SIGINT)
            process.wait(timeout=PATIENCE_S)
            if reader.ident is not None:
                reader.join()


def url_of(told: Iterable[str]) -> str:
    """Return the URL among what a run tells; what it told instead is the error."""
    before = []
    for line in told:
        if line.startswith("http"):
            return line.split()[0]
        before.append(line)
    raise AssertionError("the run ended before it told the URL of its page: " + "".join(before))


@contextmanager
def stationed(runs: Path, *options: str) -> Iterator[tuple[subprocess.Popen[str], httpx.Client]]:
    """Start `airhilt station`; yield its process and a client, and interrupt it."""
    command = [sys.executable, "-m", "airhilt", "station", "--port", "0", "--no-browser"]
    process = subprocess.Popen(
        [*command, "--runs", str(runs), *options],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    assert process.stdout is not None
    with process.stdout:
        url = httpx.URL(process.stdout.readline().split()[0]).copy_with(host="127.0.0.1")
        base = url.copy_with(query=None)
        try:
            with httpx.Client(
                base_url=base, timeout=PATIENCE_S, trust_env=False, verify=False
            ) as client:
                client.get(url)  # A token in it becomes a cookie.
                yield process, client
        finally:
            process.send_signal(signal.SIGINT)
            process.wait(timeout=PATIENCE_S)


def asked(
    app: Any, path: str = "/", host: str = "127.0.0.1:8420", **headers: str
) -> httpx.Response:
    """Return the answer of an application to a request with these headers."""

    async def ask() -> httpx.Response:
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url=f"http://{host}") as client:
            return await client.get(path, headers=headers)

    return asyncio.run(ask())


@contextmanager
def browser(url: str, identity: str, shown_seat: str | None = None) -> Iterator[ClientConnection]:
    """Connect as a page does, by its identity and the seat whose view it shows already."""
    shown = "" if shown_seat is None else f"&shown={shown_seat}"
    place = f"{url.replace('http', 'ws')}api/live?browser={identity}{shown}"
    with connect(place, proxy=None) as socket:
        yield socket


def wish(socket: ClientConnection, **wished: Any) -> None:
    """Send what a browser wishes, such as `take="TOWER"`."""
    socket.send(json.dumps(wished))


def agree(socket: ClientConnection, what: str = "voice", *, is_given: bool = True) -> None:
    """Answer the question whether the voice may be used, or typed words."""
    wish(socket, consent={"answer": {"what": what, "is_given": is_given}})


def answer(socket: ClientConnection, kind: str) -> Any:
    """Return the next message of a kind."""
    while kind not in (message := json.loads(socket.recv(timeout=PATIENCE_S))):
        pass
    return message[kind]


class PretendedRun:
    """A run of which there is only its page, with a seat or more; notes what browsers do."""

    run = "pretended"

    def __init__(self, seats: Sequence[SeatInfo] = (TOWER,)) -> None:
        self.done: queue.Queue[Message | Command] = queue.Queue()
        self.heard: queue.Queue[CallHeard] = queue.Queue()
        self.deeds: list[str] = []
        """Names of what a person said and agreed to, in their order."""
        self.settings: queue.Queue[SeatListening | SeatConsent] = queue.Queue()
        """Settings of the radio of a seat, and answers about the voice."""
        self.presence: queue.Queue[tuple[str, bool]] = queue.Queue()
        self.changes, self.sounds = Changes(), Changes()
        self.of_seats = {info.seat: SeatChanges() for info in seats}
        self.views = SeatViews(self.of_seats)
        self.seat = self.of_seats[seats[0].seat]
        self.watched: queue.Queue[set[str]] = queue.Queue()
        """Cameras whose pictures were asked for, whenever there were any."""
        self.pictures: dict[tuple[str, int], Picture] = {}
        self.kept: dict[str, Sound] = {}
        self.elsewhere: dict[str, Claimed] = {}
        """Seats that somebody has at another page, or is about to take there."""
        self.told: list[str] = []
        """Lines that the terminal was told."""
        self.changes.add("clock", 0.0, "running", "realtime")
        for info in seats:
            self.views.learn(info)
            self.of_seats[info.seat].add("info", info.model_dump(mode="json", exclude={"t_ns"}))

    def watch(self, cameras: set[str]) -> None:
        """Note cameras whose pictures are to come."""
        if cameras:
            self.watched.put(cameras)

    def say(self, seat: str, words: SpokenWords) -> None:
        """Note words that were typed."""
        self.deeds.append("say")
        self.done.put(words)

    def speak(self, seat: str, audio: MicrophoneAudio) -> None:
        """Note what a microphone does."""
        self.deeds.append(audio.phase)
        self.done.put(audio)

    def listen(self, seat: str, listening: SeatListening) -> None:
        """Note what is listened to, apart from what is done."""
        self.settings.put(listening)

    def consent(self, seat: str, consent: SeatConsent) -> None:
        """Note an answer about the voice, apart from what is done."""
        self.deeds.append(f"consent to {consent.what}" if consent.is_given else "no consent")
        self.settings.put(consent)

    def perceive(self, seat: str, perceived: AdvisoryPerceived) -> None:
        """Note that an advisory was perceived."""
        self.done.put(perceived)

    def hear(self, seat: str, heard: CallHeard) -> None:
        """Note that a transmission is audible, apart from what is done."""
        self.heard.put(heard)

    def answer(self, seat: str, answer: WorkloadAnswer) -> None:
        """Note an answer to a question."""
        self.done.put(answer)

    def claim(self, seat: str) -> Claimed:
        """Return who has a seat: nobody at another page, unless that was set."""
        return self.elsewhere.get(seat, "ours")

    def occupy(self, seat: str, *, is_taken: bool) -> None:
        """Note if somebody has the seat."""
        self.presence.put((seat, is_taken))

    def set_pace(self, pace: PaceCommand) -> None:
        """Note how fast the time is to pass."""
        self.done.put(pace)

    def fly(self, seat: str, command: Command) -> None:
        """Note a command."""
        self.done.put(command)

    def stream(self, phase: str, **header: Any) -> None:
        """Let a piece of a transmission come, by its header."""
        self.sounds.add(phase, header, audience=heard_by(header))

    def call_on_air(self, name: str, *pieces: str) -> None:
        """Let a whole call come on the first frequency, in pieces of PCM as base64."""
        on_air = {"id": name, "frequency_khz": 119_100}
        self.stream("opened", **on_air)
        for pcm in pieces:
            self.stream("samples", **on_air, pcm=pcm)
        self.stream("closed", **on_air)

    def picture(self, camera: str, seq: int) -> Picture | None:
        """Return a picture of a camera."""
        return self.pictures.get((camera, seq))

    def sound(self, name: str) -> Sound | None:
        """Return the sound of a call."""
        return self.kept.get(name)

    def next(self) -> Any:
        """Return what a browser does next."""
        return self.done.get(timeout=PATIENCE_S)

    def call(self) -> tuple[MicrophoneAudio, bytes]:
        """Return the beginning of a call, and all of its sound."""
        pressed, pcm = self.next(), b""
        while (audio := self.next()).phase == "samples":
            pcm += audio.pcm
        assert (pressed.phase, audio.phase) == ("pressed", "released")
        return pressed, pcm


@contextmanager
def seats_given_back_at_once(run: PretendedRun) -> Iterator[None]:
    """Let nobody keep a seat who is gone, and wait at the end until all seats are free."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(seat_book, "HOLD_S", 0.0)
        yield
        is_taken = dict.fromkeys(run.of_seats, False)
        while any(is_taken.values()) or not run.presence.empty():
            is_taken |= [run.presence.get(timeout=FREED_WITHIN_S)]


@contextmanager
def seat_page(
    run: PretendedRun | None = None,
    *,
    has_seats: bool = True,
    agreed: Mapping[str, Use] = MappingProxyType({}),
) -> Iterator[tuple[PretendedRun, str]]:
    """Serve the page of a pretended run in this process; yield the run and the URL."""
    run = run or PretendedRun()
    seats, views = (run.of_seats, run.views) if has_seats else ({}, SeatViews())
    browsers = Browsers(run.changes, run, seats, run.sounds, run.told.append, views, agreed)
    with serving(live_app(run, browsers)) as url:  # type: ignore[arg-type]
        yield run, url


@contextmanager
def serving(app: FastAPI) -> Iterator[str]:
    """Serve an application in this process; yield the URL."""
    urls, is_over = queue.Queue[str](), threading.Event()
    thread = threading.Thread(
        target=serve,
        args=(app, Address(port=0)),
        kwargs={"opened": urls.put, "notice": print, "browser": False, "is_over": is_over.is_set},
    )
    thread.start()
    try:
        yield urls.get(timeout=PATIENCE_S)
    finally:
        is_over.set()
        thread.join()
