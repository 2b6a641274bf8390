"""A page that follows a run does not trust what other programs publish to it."""

from __future__ import annotations

import json
import queue
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager
from typing import TypeVar

import pytest
import zenoh

from airhilt.bus.access import ROLES
from airhilt.bus.session import Bus, configuration
from airhilt.errors import StationError
from airhilt.messages import (
    Advisory,
    AdvisoryAudio,
    Briefing,
    Clock,
    Phase,
    SeatAudioOpened,
    Transmission,
    TransmissionOpened,
    key_chunk,
)
from airhilt.record import Logged
from airhilt.station import subscription
from airhilt.station.audiences import Audience
from airhilt.station.changes import Changes
from airhilt.station.connection import RunConnection
from airhilt.station.subscription import MOST_SOUND_BYTES, Subscription
from seats import state_of

NESTED = b"[" * 30_000
PATIENCE_S = 10.0
Cli = Callable[..., subprocess.CompletedProcess[str]]
T = TypeVar("T")


class Followed:
    """A run that a page follows, and a program that publishes to it."""

    def __init__(self) -> None:
        self.bus = Bus("run")
        self.bus.keep("clock", b"{}")
        self.taken: list[Logged] = []
        self.is_lost = threading.Event()
        self._has_come = threading.Event()
        self._connection = RunConnection(self.bus.endpoint)
        self.page = Subscription(self._connection, self._take, self.is_lost.set)
        self._program = zenoh.open(configuration("client", "connect", self.bus.endpoint))

    def _take(self, logged: Logged) -> None:
        self.taken.append(logged)
        if logged.data == b'{"last": 1}':
            self._has_come.set()

    def publish(self, key: str, data: bytes, attachment: bytes | None = None) -> None:
        block = zenoh.CongestionControl.BLOCK
        self._program.put(
            f"{self.bus.prefix}/{key}", data, attachment=attachment, congestion_control=block
        )

    def publish_last(self) -> None:
        """Publish one more, and wait until the page has it, and all before it of its key."""
        self.publish("advisory/ATC", b'{"last": 1}')
        assert self._has_come.wait(PATIENCE_S)

    def wait_until(self, has_come: Callable[[], object]) -> None:
        """Wait until something of another key has come.

        Messages of several keys come in threads of their own, in any order.
        """
        until = time.monotonic() + PATIENCE_S
        while not has_come() and time.monotonic() < until:
            time.sleep(0.01)

    def close(self) -> None:
        self._program.close()  # type: ignore[no-untyped-call]
        self.page.close()
        self._connection.close()


@pytest.fixture
def followed() -> Iterator[Followed]:
    run = Followed()
    yield run
    run.bus.close()
    run.close()


@pytest.mark.parametrize(
    ("key", "data", "header"),
    [
        ("advisory/ATC", NESTED, None),
        ("tts/a", b"\0\0", b"garbage"),
        ("tts/a", b"\0\0", NESTED),
    ],
)
def test_a_malformed_message_says_nothing_on_the_terminal_and_ends_nothing(
    followed: Followed,
    capfd: pytest.CaptureFixture[str],
    key: str,
    data: bytes,
    header: bytes | None,
) -> None:
    followed.publish(key, data, header)
    followed.publish_last()
    assert capfd.readouterr().err == ""
    followed.bus.close()
    assert followed.is_lost.wait(PATIENCE_S)
    followed.bus = Bus("another")


def test_a_message_above_its_limit_is_dropped(followed: Followed) -> None:
    assert Advisory.limit is not None
    fits = json.dumps({"message": "x" * (Advisory.limit.size_bytes - 20)}).encode()
    for data in (fits, b"x" * (Advisory.limit.size_bytes + 1)):
        followed.publish("advisory/ATC", data)
        followed.publish("command/AAL123", b"x" * 1_000_000)
    followed.publish("advisory/ATC", b"x", b"x" * Advisory.limit.size_bytes)
    followed.publish_last()
    large = [each for each in followed.taken if len(each.data) > 100]
    assert [(each.key, each.data) for each in large] == [("advisory/ATC", fits)]


def test_what_has_no_room_to_wait_is_dropped(
    followed: Followed, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(subscription, "MOST_WAITING_BYTES", 100)
    followed.publish("advisory/ATC", b"x" * 100)
    followed.publish_last()
    assert [each.data for each in followed.taken if each.key == "advisory/ATC"] == [b'{"last": 1}']


def test_the_sounds_that_are_kept_have_a_limit(followed: Followed) -> None:
    size = 7_000_000
    for number in range(12):
        header = AdvisoryAudio(
            id=f"call-{number}", revision=0, recipient="ATC", text="stop", t_dec_ns=0, engine="",
            samples=size // 2, sha256="",
        )  # fmt: skip
        followed.publish("tts/a", bytes(size), header.model_dump_json().encode())
    followed.wait_until(lambda: followed.page.sound("call-11-0-ATC"))
    kept = [number for number in range(12) if followed.page.sound(f"call-{number}-0-ATC")]
    assert kept == list(range(12 - MOST_SOUND_BYTES // size, 12))


def test_the_sound_of_the_receiver_of_a_seat_is_for_that_seat_alone() -> None:
    sounds = Changes()
    times = {"t_tx_ns": 0, "frequency_khz": 119_100}
    with closing(Bus("run")) as bus:
        bus.keep("clock", b"{}")
        with closing(RunConnection(bus.endpoint)) as connection:
            page = Subscription(
                connection, lambda _: None, lambda: None, seats=["Ops 1"], sounds=sounds
            )
            with closing(page):
                sent = {
                    "seat/AAL123/audio": SeatAudioOpened(id="call", seat="AAL123", **times),
                    "radio/119100/audio": TransmissionOpened(id="call", **times),
                    "seat/Ops_1/audio": SeatAudioOpened(id="call", seat="Ops 1", **times),
                }
                for key, header in sent.items():
                    bus.put(key, b"", header.model_dump_json().encode())
                until = time.monotonic() + PATIENCE_S
                while sounds.next_number < 2 and time.monotonic() < until:
                    time.sleep(0.01)
    audiences: set[Audience] = set()

    def note(audience: Audience) -> bool:
        audiences.add(audience)
        return True

    sounds.since(0, admits=note)
    assert audiences == {Audience("frequency", 119_100), Audience("receiver", "Ops 1")}


@pytest.mark.parametrize("seats", [(), ("TOWER",)])
def test_truth_comes_to_pages_without_seats_alone_and_so_does_the_sound_of_whole_calls(
    seats: tuple[str, ...],
) -> None:
    call = Transmission(id="call", frequency_khz=119_100, t_tx_ns=0, t_end_ns=1, samples=1)
    advice = AdvisoryAudio(
        id="a", revision=0, recipient="ATC", text="stop", t_dec_ns=0, engine="", samples=1,
        sha256="",
    )  # fmt: skip
    with closing(Bus("run", anyone=ROLES)) as bus:
        bus.keep("clock", b"{}")
        with closing(RunConnection(bus.endpoint)) as connection:
            taken: queue.Queue[Logged] = queue.Queue()
            with closing(Subscription(connection, taken.put, lambda: None, seats=seats)) as page:
                bus.put("truth/radio/call", b"{}")
                bus.put("radio/119100/tx", b"\0\0", call.model_dump_json().encode())
                bus.put("tts/a", b"\0\0", advice.model_dump_json().encode())
                truth = set() if seats else {"truth/radio/call"}
                wanted = {"radio/119100/tx", "tts/a"} | truth
                came: set[str] = set()
                while not wanted <= came:
                    came.add(taken.get(timeout=PATIENCE_S).key)
                assert {key for key in came if key.startswith("truth")} == truth
                assert page.sound("a-0-ATC")
                assert bool(page.sound("call")) is not bool(seats)


def test_a_page_that_comes_late_asks_where_the_radars_are() -> None:
    with closing(Bus("run")) as bus:
        bus.keep("clock", b"{}")
        bus.keep("radar/ASR/info", b'{"site": "ASR"}')
        taken: queue.Queue[Logged] = queue.Queue()
        with (
            closing(RunConnection(bus.endpoint)) as connection,
            closing(Subscription(connection, taken.put, lambda: None)),
        ):
            while (logged := taken.get(timeout=PATIENCE_S)).key != "radar/ASR/info":
                pass
        assert logged.data == b'{"site": "ASR"}'


@contextmanager
def begun(phase: Phase = "running") -> Iterator[Bus]:
    """A run with seats of two units."""
    with closing(Bus("run")) as bus:
        tell_phase(bus, phase)
        for seat in ("Washington Ground", "Washington Tower"):
            bus.keep(f"seat/{key_chunk(seat)}", state_of(seat).model_dump_json().encode())
        briefing = Briefing(
            controller="Washington Tower", horizontal_separation_nm=3.0,
            vertical_separation_ft=1000.0,
        )  # fmt: skip
        bus.keep("briefing", briefing.model_dump_json().encode())
        yield bus


def tell_phase(bus: Bus, phase: Phase) -> None:
    clock = Clock(t_ns=0, run="run", phase=phase, pace="realtime")
    bus.keep("clock", clock.model_dump_json().encode())


def test_a_seat_that_a_run_does_not_have_is_refused_with_the_names_of_its_seats(
    airhilt_command: Cli,
) -> None:
    with begun() as bus:
        done = airhilt_command("view", "--connect", bus.endpoint, "--seat", "Tower")
    assert done.returncode == 2
    assert (
        "--seat 'Tower': not a seat of the run; expected 'Washington Ground', 'Washington Tower'"
    ) in done.stderr


def test_a_seat_may_be_asked_for_by_the_role_of_its_unit() -> None:
    with begun() as bus, closing(RunConnection(bus.endpoint)) as connection:
        found = connection.seats(["Washington Tower", "ground", "tower"], pytest.fail)
        assert set(found) == {"Washington Tower", "Washington Ground"}


def test_a_role_is_known_once_the_run_has_begun_and_a_name_is_taken_before_that() -> None:
    told: list[str] = []
    with begun("waiting") as bus, closing(RunConnection(bus.endpoint)) as connection:
        assert connection.seats(["Tower"], told.append) == ("Tower",)
        assert told == []
        beginning = threading.Timer(0.3, tell_phase, (bus, "running"))
        beginning.start()
        assert connection.seats(["tower"], told.append) == ("Washington Tower",)
        beginning.join()
    assert told == ["the run has not begun; until then nobody knows the seat of 'tower'"]


def test_a_role_that_waits_for_a_run_is_refused_once_the_run_is_gone() -> None:
    with ExitStack() as run:
        connection = RunConnection(run.enter_context(begun("waiting")).endpoint)
        ending = threading.Timer(0.3, run.close)
        ending.start()
        with pytest.raises(StationError, match=r"no answer"):
            connection.seats(["ground"], lambda _: None)
        ending.join()
        connection.close()


def test_a_role_in_a_run_that_is_over_is_refused() -> None:
    with begun("finished") as bus, closing(RunConnection(bus.endpoint)) as connection:
        with pytest.raises(StationError, match=r"--seat 'tower': .*\(finished\); expected a run"):
            connection.seats(["tower"], pytest.fail)
        assert connection.seats(["Tower"], pytest.fail) == ("Tower",)
