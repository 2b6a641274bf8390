"""A browser sees what its own seat would see, and without a seat nothing but the clock."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from websockets.sync.client import ClientConnection

from airhilt.messages import (
    ActorCommand,
    ActorTruth,
    AdsbReport,
    Advisory,
    CameraView,
    Detections,
    Evidence,
    Message,
    RadarInfo,
    RadarPlot,
    Status,
    SurfaceTrack,
    Transcript,
    Transmission,
)
from airhilt.record import Logged
from airhilt.station.audiences import Audience
from airhilt.station.live import LiveRun
from airhilt.station.pictures import Picture
from airhilt.station.subscription import Sound
from seats import state_of
from stations import PATIENCE_S, PretendedRun, named, opened, seat_page, wish

SECOND = 1_000_000_000
TOWER_KHZ, GROUND_KHZ = 119_100, 121_700
SEATS = (
    state_of("TOWER", recipients=("TOWER", "ATC")),
    state_of("AAL123", category="aircraft", icao24="a1b2c3", recipients=("AAL123", "a1b2c3")),
    state_of(
        "DAL456", category="aircraft", icao24="d4e5f6", has_adsb_in=True,
        recipients=("DAL456", "d4e5f6"), frequencies_khz=(GROUND_KHZ,), tuned_khz=(GROUND_KHZ,),
    ),
)  # fmt: skip


def report(icao24: str, callsign: str) -> AdsbReport:
    return AdsbReport(
        icao24=icao24, callsign=callsign, latitude_deg=38.85, longitude_deg=-77.04,
        altitude_ft=2_000.0, ground_speed_kt=140.0, track_deg=90.0, vertical_rate_fpm=0.0, nacp=9,
        nacv=2, receiver="tower", t_adsb_in_ns=SECOND, t_adsb_out_ns=SECOND, t_ns=SECOND,
    )  # fmt: skip


def advisory(recipient: str) -> Advisory:
    return Advisory(
        id="a-1", revision=0, recipient=recipient, recipients=("ATC", "AAL123"),
        kind="runway_conflict", severity="WARNING", traffic=("AAL123",),
        message=f"for {recipient}", t_ready_ns=SECOND, evidence=Evidence(sources=()), t_ns=SECOND,
    )  # fmt: skip


def transmission(frequency_khz: int) -> Transmission:
    return Transmission(
        id=f"call-{frequency_khz}", frequency_khz=frequency_khz, t_tx_ns=SECOND, t_end_ns=SECOND,
        samples=10,
    )  # fmt: skip


def picture_of(camera: str, carrier: str | None) -> Detections:
    view = CameraView(
        carrier=carrier, width_px=64, height_px=48, horizontal_fov_deg=60.0, latitude_deg=38.85,
        longitude_deg=-77.04, height_m=20.0, heading_deg=0.0, pitch_deg=0.0, roll_deg=0.0,
    )  # fmt: skip
    return Detections(
        camera=camera, seq=1, t_frame_ns=SECOND, view=view, engine="none", t_ns=SECOND
    )


TRACK = SurfaceTrack(
    airport="KDCA", track=1, kind="primary", t_track_ns=SECOND, latitude_deg=38.85,
    longitude_deg=-77.04, accuracy_m=5.0, ground_speed_kt=0.0, t_ns=SECOND,
)  # fmt: skip
RADAR = RadarInfo(
    site="ASR", kind="terminal", latitude_deg=38.85, longitude_deg=-77.04, altitude_m=20.0,
    rotation_s=4.8, primary_range_m=100_000.0, secondary_range_m=200_000.0, t_ns=0,
)  # fmt: skip
PLOT = RadarPlot(
    site="ASR", kind="secondary", t_plot_ns=SECOND, range_m=9_000.0, azimuth_deg=90.0,
    mode_a="7000", mode_c_ft=4_500, t_ns=SECOND,
)  # fmt: skip
COMMAND = ActorCommand.model_validate({"command": {"action": "go_around"}})
OFF = Status(modality="decision", state="off", t_ns=SECOND)
HEARD = Transcript(
    id=f"call-{GROUND_KHZ}", frequency_khz=GROUND_KHZ, text="hello", confidence=0.9, engine="ctc",
    t_tx_ns=SECOND, t_end_ns=SECOND, t_ns=SECOND,
)  # fmt: skip
PUBLISHED: tuple[tuple[str, Message], ...] = (
    ("adsb/a1b2c3", report("a1b2c3", "AAL123")),
    ("adsb/d4e5f6", report("d4e5f6", "DAL456")),
    ("surface/KDCA", TRACK),
    ("radar/ASR/info", RADAR),
    ("radar/ASR", PLOT),
    (f"radio/{TOWER_KHZ}/tx", transmission(TOWER_KHZ)),
    (f"radio/{GROUND_KHZ}/tx", transmission(GROUND_KHZ)),
    (f"asr/{GROUND_KHZ}", HEARD),
    ("advisory/ATC", advisory("ATC")),
    ("advisory/AAL123", advisory("AAL123")),
    ("vision/mast", picture_of("mast", None)),
    ("vision/nose", picture_of("nose", "DAL456")),
    ("command/AAL123", COMMAND),
    ("status/decision", OFF),
)
SEEN = {
    "TOWER": {
        "state AAL123", "state DAL456", "state track 1", f"call call-{TOWER_KHZ}",
        "advisory for ATC", "camera mast", "picture mast", "plot 7000",
    },
    "AAL123": {
        "state AAL123", f"call call-{TOWER_KHZ}", "advisory for AAL123", "event command",
    },
    "DAL456": {
        "state AAL123", "state DAL456", f"call call-{GROUND_KHZ}", "camera nose", "picture nose",
    },
}  # fmt: skip
"""Changes of the run, by the seats that see them."""
FILES = {
    "api/cameras/mast/1.jpg": "of-tower",
    "api/cameras/nose/1.jpg": "of-pilot",
    "api/calls/a-1-0-ATC.wav": "of-tower",
    "api/calls/a-1-0-DAL456.wav": "of-pilot",
}
"""Browsers that get each picture and sound."""


@pytest.fixture
def seats() -> Iterator[tuple[PretendedRun, str]]:
    run = PretendedRun(SEATS)
    live = LiveRun(run.changes, run.views, print)
    for key, message in PUBLISHED:
        live.take(Logged(key, "", message.t_ns, message.model_dump_json().encode()))
    pixels = bytes(64 * 48 * 3)
    for name, carrier in (("mast", None), ("nose", "DAL456")):
        run.pictures[name, 1] = Picture(64, 48, pixels, Audience("camera", carrier))
    for recipient in ("ATC", "DAL456"):
        run.kept[f"a-1-0-{recipient}"] = Sound(b"\0\0", Audience("advisory", recipient))
    with seat_page(run) as (_, url):
        yield run, url


def names(message: dict[str, Any]) -> set[str]:
    """Return what a message shows, besides the clock."""
    found = set()
    for kind, first, *_ in message.get("changes", ()):
        match kind:
            case "call" | "camera":
                found.add(f"{kind} {first.get('id') or first['name']}")
            case "advisory":
                found |= {f"advisory {one['message']}" for one in first["texts"]}
            case "event" if first["kind"] in ("command", "status"):
                found.add(f"event {first['kind']}")
            case "plot":
                found.add(f"plot {first['code']}")
            case "state" | "picture":
                found.add(f"{kind} {first}")
    return found


def shown_before(socket: ClientConnection, seat: str) -> set[str]:
    """Return what is shown before it is told that a seat is one's own."""
    shown: set[str] = set()
    while True:
        message = json.loads(socket.recv(timeout=PATIENCE_S))
        if message.get("seats", {}).get(seat, {}).get("is") == "yours":
            return shown
        shown |= names(message)


def taken(socket: ClientConnection, seat: str) -> set[str]:
    """Take a seat, and return what is shown before that is told."""
    wish(socket, act={"do": "take"}, seat=seat)
    return shown_before(socket, seat)


@pytest.mark.parametrize("seat", SEEN)
def test_who_takes_a_seat_is_shown_what_that_seat_sees(
    seats: tuple[PretendedRun, str], seat: str
) -> None:
    with opened(seats[1]) as socket:
        assert taken(socket, seat) == SEEN[seat]


def test_who_has_no_seat_is_shown_the_clock_alone(seats: tuple[PretendedRun, str]) -> None:
    run, url = seats
    with opened(url) as socket:
        run.changes.add("clock", 1.0, "stopped", "realtime")
        shown: list[str] = []
        while "stopped" not in json.dumps(message := json.loads(socket.recv(PATIENCE_S))):
            shown += [kind for kind, *_ in message.get("changes", ())]
        assert set(shown) <= {"clock"}


def seen_at(run: PretendedRun, seat: str | None) -> str:
    """Return all changes that are seen at a seat; None: without one."""
    return str(run.changes.since(0, admits=lambda audience: run.views.sees(seat, audience)))


def test_no_seat_sees_the_truth() -> None:
    run = PretendedRun(SEATS)
    truth = ActorTruth(
        actor="AAL123", category="aircraft", phase="cruise", on_ground=False, latitude_deg=38.85,
        longitude_deg=-77.04, altitude_m=600.0, height_agl_m=590.0, velocity_east_m_s=0.0,
        velocity_north_m_s=70.0, velocity_down_m_s=0.0, heading_deg=0.0, t_ns=SECOND,
    )  # fmt: skip
    LiveRun(run.changes, run.views, print).take(
        Logged("truth/state/AAL123", "", SECOND, truth.model_dump_json().encode())
    )
    for seat in (None, *SEEN):
        seen = seen_at(run, seat)
        assert "clock" in seen
        assert "AAL123" not in seen


def test_no_seat_is_told_latencies_or_the_engine_that_has_recognised_a_call(
    seats: tuple[PretendedRun, str],
) -> None:
    run, _ = seats
    for seat in SEEN:
        seen = seen_at(run, seat)
        assert "latency" not in seen
        assert "ctc" not in seen
        assert ('"text":"hello"' in seen.replace(": ", ":")) is (seat == "DAL456")
    assert '"latency"' in str(run.changes.since(0))


def test_what_comes_later_is_shown_at_the_seats_that_see_it(
    seats: tuple[PretendedRun, str],
) -> None:
    run, url = seats
    with opened(url) as socket, opened(url, "tab") as second_tab:
        taken(socket, "AAL123")
        run.changes.add("state", "DAL456", audience=Audience("adsb", "d4e5f6"))
        run.changes.add("state", "AAL123", audience=Audience("adsb", "a1b2c3"))
        assert names(json.loads(next(one for one in socket if "state" in one))) == {"state AAL123"}
        run.changes.add("state", "everybody")
        assert names(json.loads(next(one for one in second_tab if "state" in one))) == {
            "state everybody"
        }


def test_who_comes_back_is_shown_what_the_seat_saw_meanwhile(
    seats: tuple[PretendedRun, str],
) -> None:
    run, url = seats
    with opened(url, "one") as socket:
        taken(socket, "AAL123")
    begin = run.changes.next_number
    for icao24, name in (("a1b2c3", "AAL123"), ("d4e5f6", "DAL456")):
        run.changes.add("state", name, audience=Audience("adsb", icao24))
    with opened(url, "one", shown="AAL123", **{"from": begin}) as socket:
        assert shown_before(socket, "AAL123") == {"state AAL123"}


def test_who_leaves_a_seat_forgets_it_before_what_everybody_sees_is_shown(
    seats: tuple[PretendedRun, str],
) -> None:
    run, url = seats
    run.changes.add("state", "everybody")
    with opened(url) as socket:
        assert taken(socket, "TOWER") == SEEN["TOWER"] | {"state everybody"}
        wish(socket, act={"do": "leave"})
        assert shown_anew(socket) == {"state everybody"}


def test_who_comes_back_without_the_seat_that_the_page_shows_forgets_it(
    seats: tuple[PretendedRun, str],
) -> None:
    _, url = seats
    with opened(url, "one") as socket:
        taken(socket, "AAL123")
    with opened(url, "one", shown="TOWER", **{"from": 9}) as socket:
        assert shown_anew(socket) == SEEN["AAL123"]
    with opened(url, "two", shown="TOWER", **{"from": 9}) as socket:
        assert shown_anew(socket) == set()


def shown_anew(socket: ClientConnection) -> set[str]:
    """Return what is shown between the message to forget and that of the seats."""
    while "forget" not in json.loads(socket.recv(timeout=PATIENCE_S)):
        pass
    shown: set[str] = set()
    while "seats" not in (message := json.loads(socket.recv(timeout=PATIENCE_S))):
        shown |= names(message)
    return shown


def test_files_are_for_the_browser_at_a_seat_that_sees_them(
    seats: tuple[PretendedRun, str],
) -> None:
    run, url = seats
    answers = {}
    with opened(url, "of-tower") as tower, opened(url, "of-pilot") as pilot:
        taken(tower, "TOWER")
        taken(pilot, "DAL456")
        with httpx.Client(base_url=url, trust_env=False) as client:
            for file in FILES:
                for browser in ("of-tower", "of-pilot", "without-a-seat", ""):
                    found = client.get(file, params={"browser": named(browser)})
                    if found.status_code != 403:
                        answers[file, browser] = found.status_code
                        assert found.content
                    else:
                        assert "not for the seat" in found.text
    assert answers == dict.fromkeys(FILES.items(), 200)
    assert any("refused a file" in line for line in run.told)


def test_pictures_of_a_camera_that_the_seat_does_not_see_are_not_drawn(
    seats: tuple[PretendedRun, str],
) -> None:
    run, url = seats
    with opened(url) as socket:
        taken(socket, "DAL456")
        for camera in ("mast", "unknown", "nose"):
            socket.send(json.dumps({"watch": camera}))
        assert run.watched.get(timeout=PATIENCE_S) == {"nose"}


@pytest.mark.parametrize(("seat", "heard"), [("AAL123", "own"), ("TOWER", "site")])
def test_a_seat_with_a_receiver_of_its_own_hears_that_and_the_others_the_one_of_the_units(
    seat: str, heard: str
) -> None:
    tower, pilot, _ = SEATS
    run = PretendedRun((tower, pilot.model_copy(update={"has_own_receiver": True})))
    with seat_page(run) as (_, url), opened(url) as socket:
        taken(socket, seat)
        socket.send(json.dumps({"echo": 1.0}))
        next(one for one in socket if "echo" in one)
        run.stream("chunk", id="call", frequency_khz=TOWER_KHZ, pcm="site")
        run.stream("chunk", id="call", frequency_khz=TOWER_KHZ, pcm="another", seat="DAL456")
        run.stream("chunk", id="call", frequency_khz=GROUND_KHZ, pcm="untuned", seat="AAL123")
        run.stream("chunk", id="call", frequency_khz=TOWER_KHZ, pcm="own", seat="AAL123")
        pieces: list[str] = []
        while not pieces:
            message = json.loads(socket.recv(timeout=PATIENCE_S))
            pieces = [piece[1]["pcm"] for piece in message.get("sounds", ())]
        assert pieces == [heard]
