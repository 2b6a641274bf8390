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
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path
from secrets import token_hex
from typing import Any, cast
from urllib.parse import urlencode

import httpx
import psutil
from cryptography import x509
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.hashes import SHA256
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat
from cryptography.x509.oid import NameOID
from fastapi import FastAPI
from websockets.sync.client import ClientConnection, connect

from airhilt.bus.seat_client import SeatClient
from airhilt.messages import (
    SHORTEST_SECRET,
    AgreeToUses,
    HearCall,
    LeaveSeat,
    PressToTalk,
    SayVoice,
    SeatAct,
    SeatAction,
    SeatState,
    Severity,
    TakeSeat,
    TuneFrequencies,
    key_chunk,
)
from airhilt.record import open_run
from airhilt.seats import Seats
from airhilt.sim import Director, Virtual
from airhilt.station.address import Address
from airhilt.station.app import live_app, recorded_app
from airhilt.station.audiences import heard_by
from airhilt.station.browsers import Browsers
from airhilt.station.changes import Changes
from airhilt.station.conductor import Conductor
from airhilt.station.debrief import Debrief
from airhilt.station.experiment_app import experiment_app
from airhilt.station.participant_progress import Progress
from airhilt.station.pictures import Picture
from airhilt.station.plan import plan_of
from airhilt.station.seat_views import SeatViews
from airhilt.station.server import serve
from airhilt.station.subscription import Sound, Subscription
from devtools import Page
from seats import state_of

PATIENCE_S = 60.0
TOKEN = "0123456789abcdef0123456789abcdef"
TOWER = state_of("TOWER", recipients=("TOWER", "ATC"), spoken_from=Severity.CAUTION)
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
    """Serve the debrief of one run, or of two side by side, in this process; yield the URL."""
    with ExitStack() as stack:
        debriefs = [Debrief(open_run(folder)) for folder in run_folders]
        for debrief in debriefs:
            stack.callback(debrief.close)
        yield stack.enter_context(serving(recorded_app(debriefs)))


@contextmanager
def experiment_page(plan_file: Path, out: Path, participant: str = "P01") -> Iterator[str]:
    """Serve the page of the team of a participant in this process; yield the URL."""
    plan = plan_of(json.loads(plan_file.read_text()), str(plan_file))
    team = [Progress(plan, out, name) for name in plan.team_of(participant)]
    with serving(experiment_app(Conductor(team))) as url:
        yield url


@contextmanager
def commanded(*arguments: str | Path) -> Iterator[str]:
    """Start a command such as `airhilt view`, yield the URL that it prints, and interrupt it."""
    command = [sys.executable, "-m", "airhilt", *map(str, arguments), "--port=0", "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
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
    with opened(url, identity, shown=shown_seat) as socket:
        yield socket


def opened(url: str, identity: str = "somebody", **more: Any) -> ClientConnection:
    """Return a connection as that of a page, by its identity and what else it tells."""
    given = {"browser": named(identity)} | {name: one for name, one in more.items() if one}
    return connect(f"{url.replace('http', 'ws')}api/live?{urlencode(given)}", proxy=None)


def named(identity: str) -> str:
    """Return the identity of a page in the length that pages give them."""
    return identity.ljust(SHORTEST_SECRET, "-")


def wish(socket: ClientConnection, **wished: Any) -> None:
    """Send what a browser wishes, such as `take="TOWER"`."""
    socket.send(json.dumps(wished))


def do(socket: ClientConnection, do: str, seat: str = "", **more: Any) -> str:
    """Act at a seat, and return why that is refused; empty if it is not."""
    wish(socket, act={"do": do, **more}, seat=seat)
    return str(answer(socket, "answer"))


def sit(socket: ClientConnection, seat: str = "TOWER") -> None:
    """Take a seat, and let voice and words be used there."""
    assert do(socket, "take", seat) == ""
    assert do(socket, "agree", uses=["voice", "words"]) == ""


def answer(socket: ClientConnection, kind: str) -> Any:
    """Return the next message of a kind."""
    while kind not in (message := json.loads(socket.recv(timeout=PATIENCE_S))):
        pass
    return message[kind]


class PretendedRun:
    """A run of which there are only its seats and its page; notes what browsers do."""

    run = "pretended"

    def __init__(self, seats: Sequence[SeatState] = (TOWER,)) -> None:
        self.done: queue.Queue[SeatAct] = queue.Queue()
        self.heard: queue.Queue[HearCall] = queue.Queue()
        self.deeds: list[str] = []
        """Names of all acts, in their order."""
        self.settings: queue.Queue[TuneFrequencies | AgreeToUses] = queue.Queue()
        self.presence: queue.Queue[tuple[str, bool]] = queue.Queue()
        self.changes, self.sounds = Changes(), Changes()
        self.views = SeatViews(state.seat for state in seats)
        self.watched: queue.Queue[set[str]] = queue.Queue()
        """Cameras whose pictures were asked for, whenever there were any."""
        self.pictures: dict[tuple[str, int], Picture] = {}
        self.kept: dict[str, Sound] = {}
        self.told: list[str] = []
        """Lines that the terminal was told."""
        self.changes.add("clock", 0.0, "running", "realtime")
        self.seats = Seats(seats, self._published, Director(Virtual()))
        self._acting = threading.Lock()
        self.seats.open()

    def _published(self, _key: str, state: SeatState) -> None:
        self.views.learn(state)

    def watch(self, cameras: set[str]) -> None:
        """Note cameras whose pictures are to come."""
        if cameras:
            self.watched.put(cameras)

    def seat_client(self, seat: str, secret: str) -> SeatClient:
        """Return a client of a seat that has no bus."""
        return cast("SeatClient", PretendedClient(self, seat, secret))

    def act(self, seat: str, action: SeatAction) -> str:
        """Do something at a seat; return why that is refused."""
        key = f"seat/{key_chunk(seat)}/do"
        with self._acting:
            why = self.seats.refusal(key, action)
            if why:
                return why
            self.seats.note_secret(key, action)
            self.seats.take(key, action, b"")
        self._note(seat, action.act)
        return ""

    def end_hold(self, seat: str, holder: str) -> None:
        """Let who is gone leave the seat."""
        key = f"seat/{key_chunk(seat)}/do"
        with self._acting:
            if self.seats.ends_hold(key, holder):
                self.seats.take(key, SeatAction(holder=holder, act=LeaveSeat()), b"")
                self.presence.put((seat, False))

    def _note(self, seat: str, act: SeatAct) -> None:
        self.deeds.append(act.do)
        match act:
            case TakeSeat() | LeaveSeat():
                self.presence.put((seat, act.do == "take"))
            case TuneFrequencies() | AgreeToUses():
                self.settings.put(act)
            case HearCall():
                self.heard.put(act)
            case _:
                self.done.put(act)

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

    def call(self) -> tuple[PressToTalk, bytes]:
        """Return the beginning of a call, and all of its sound."""
        pressed, pcm = self.next(), b""
        while isinstance(act := self.next(), SayVoice):
            pcm += act.pcm
        assert (pressed.do, act.do) == ("press", "release")
        return pressed, pcm


class PretendedClient:
    """A client of a seat of a pretended run."""

    def __init__(self, run: PretendedRun, seat: str, secret: str) -> None:
        self.seat = seat
        self.holder = token_hex(8)
        self._run = run
        self._secret = secret

    def take(self) -> str:
        """Take the seat."""
        return self.act(TakeSeat())

    def act(self, act: SeatAct) -> str:
        """Do something at the seat."""
        return self._run.act(
            self.seat, SeatAction(holder=self.holder, secret=self._secret, act=act)
        )

    def close(self) -> None:
        """Let the hold end."""
        self._run.end_hold(self.seat, self.holder)


@contextmanager
def seat_page(
    run: PretendedRun | None = None, *, has_seats: bool = True
) -> Iterator[tuple[PretendedRun, str]]:
    """Serve the page of a pretended run in this process; yield the run and the URL."""
    run = run or PretendedRun()
    views = run.views if has_seats else SeatViews()
    subscription = cast("Subscription", run)
    browsers = Browsers(run.changes, subscription, views, run.sounds, run.told.append)
    with serving(live_app(subscription, browsers)) as url:
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


def take_seat(page: Page) -> None:
    """Take the seat that is chosen, and let voice and words be used, once the run is there."""
    page.wait_for("document.getElementById('state').textContent.startsWith('running')")
    page.evaluate("document.getElementById('seat-uses').value ||= 'voice'")
    page.activate("seat-take")
