"""A client of the Foxglove WebSocket protocol sees and hears a run."""

from __future__ import annotations

import base64
import io
import json
import math
import socket
import struct
import subprocess
import sys
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from importlib.util import find_spec
from typing import Any

import pytest
from PIL import Image
from pydantic import BaseModel
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from airhilt.bus import free_endpoint
from airhilt.host import library
from airhilt.messages import (
    ActorTruth,
    Advisory,
    CameraFrame,
    CameraView,
    Clock,
    Detection,
    Detections,
    EquipmentAlert,
    Evidence,
    Severity,
    Transcript,
    Transmission,
)
from airhilt.units import FOOT, KNOT
from buses import bus_of_a_run
from reports import REPORT

pytestmark = [
    pytest.mark.decoders,
    pytest.mark.skipif(
        find_spec("foxglove") is None, reason="no foxglove-sdk: pip install airhilt[foxglove]"
    ),
]
LONG_S = 120.0
"""Time that a busy machine may take to start a program."""
TRUTH = ActorTruth(
    actor="AAL123", category="aircraft", phase="cruise", on_ground=False, latitude_deg=38.9,
    longitude_deg=-77.0, altitude_m=10_668.0, height_agl_m=10_600.0, velocity_north_m_s=-3.0,
    velocity_east_m_s=231.5, velocity_down_m_s=2.0, heading_deg=91.0,
)  # fmt: skip
ON_GROUND = REPORT.model_copy(update={"icao24": "a4d5e6", "altitude_ft": None, "on_ground": True})
ADVISORY = Advisory(
    id="simple-1", revision=0, recipient="AAL123", recipients=("AAL123",),
    kind="loss_of_separation", severity=Severity.WARNING, traffic=("AAL123", "UAL7"),
    message="AAL123, climb and maintain flight level three six zero.",
    evidence=Evidence(sources=("adsb",)), t_ready_ns=0,
)  # fmt: skip
ALERT = EquipmentAlert(
    equipment="tcas", advisory=ADVISORY.model_copy(update={"message": "Traffic.", "active": False})
)
TRANSCRIPT = Transcript(
    id="t1", frequency_khz=119_100, t_tx_ns=0, t_end_ns=1, text="say again", confidence=1.0,
    engine="text", speaker="AAL123",
)  # fmt: skip
SOUND = struct.pack("<4h", 0, 1000, -1000, 32_767)
TRANSMISSION = Transmission(id="t1", frequency_khz=119_100, t_tx_ns=0, t_end_ns=250_000, samples=4)
WIDTH, HEIGHT = 64, 48
VIEW = CameraView(
    latitude_deg=38.9, longitude_deg=-77.0, height_m=60.0, heading_deg=0.0, pitch_deg=0.0,
    roll_deg=0.0, horizontal_fov_deg=60.0, width_px=WIDTH, height_px=HEIGHT,
)  # fmt: skip
FRAME = CameraFrame(camera="tower", seq=3, t_frame_ns=500_000_000, view=VIEW, sha256="")
DETECTIONS = Detections(
    camera="tower", seq=3, t_frame_ns=500_000_000, view=VIEW, engine="network",
    detections=(Detection(label="deer", confidence=0.75, box=(10.0, 20.0, 30.0, 40.0)),),
)  # fmt: skip
MESSAGES: dict[str, tuple[BaseModel, bytes | None]] = {
    "adsb/a1b2c3": (REPORT, None),
    "adsb/a4d5e6": (ON_GROUND, None),
    "truth/state/AAL123": (TRUTH, None),
    "advisory/AAL123": (ADVISORY, None),
    "equipment/tcas/AAL123": (ALERT, None),
    "asr/119100": (TRANSCRIPT, None),
    "vision/tower": (DETECTIONS, None),
    "radio/119100/tx": (TRANSMISSION, SOUND),
    "camera/tower/frame": (FRAME, bytes([200, 100, 50] * WIDTH * HEIGHT)),
}
"""Messages of the run, and the raw bytes that each is a header of."""

END = Clock(run="run", phase="finished", pace="1x").model_dump_json().encode()


class Client:
    """A client of the protocol that subscribes to every topic and decodes it by its own schema.

    The protocol is that of https://github.com/foxglove/ws-protocol (docs/spec.md).
    """

    def __init__(self, connection: ClientConnection) -> None:
        self.heard: defaultdict[str, list[Any]] = defaultdict(list)
        self._connection = connection
        self._topics: dict[int, tuple[str, Any]] = {}

    def take(self) -> None:
        """Take what has come."""
        with suppress(TimeoutError):
            while True:
                message = self._connection.recv(timeout=0.1)
                if isinstance(message, bytes):
                    self._take_data(message)
                elif (said := json.loads(message))["op"] == "advertise":
                    self._subscribe(said["channels"])

    def _subscribe(self, channels: list[dict[str, Any]]) -> None:
        for channel in channels:
            self._topics[channel["id"]] = channel["topic"], message_class(channel)
        wanted = [{"id": channel["id"], "channelId": channel["id"]} for channel in channels]
        self._connection.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))

    def _take_data(self, message: bytes) -> None:
        operation, subscription, _ = struct.unpack_from("<BIQ", message)
        assert operation == 1
        topic, kind = self._topics[subscription]
        self.heard[topic].append(kind.FromString(message[struct.calcsize("<BIQ") :]))


def message_class(channel: dict[str, Any]) -> Any:
    """Return the class of the messages of a channel, by the schema that it advertises."""
    from google.protobuf.descriptor_pb2 import FileDescriptorSet
    from google.protobuf.descriptor_pool import DescriptorPool
    from google.protobuf.message_factory import GetMessageClass

    assert (channel["encoding"], channel["schemaEncoding"]) == ("protobuf", "protobuf")
    pool = DescriptorPool()
    for file in FileDescriptorSet.FromString(base64.b64decode(channel["schema"] + "==")).file:
        pool.AddSerializedFile(file.SerializeToString())
    return GetMessageClass(pool.FindMessageTypeByName(channel["schemaName"]))


def program(endpoint: str, port: int) -> list[str]:
    path = str(library.folder("bridges") / "foxglove_websocket.py")
    return [sys.executable, path, "--connect", endpoint, "--port", str(port)]


def connected(port: int) -> ClientConnection:
    """Return a connection with the bridge as soon as it listens."""
    deadline = time.monotonic() + LONG_S
    while True:
        try:
            return connect(
                f"ws://127.0.0.1:{port}",
                subprotocols=[Subprotocol("foxglove.sdk.v1")],
                ping_interval=None,
                close_timeout=1,
            )
        except OSError:
            assert time.monotonic() < deadline
            time.sleep(0.1)


@pytest.fixture(scope="module")
def heard() -> Iterator[dict[str, list[Any]]]:
    """Messages that a client got of a run that shares its truth, by topic."""
    port = int(free_endpoint().rsplit(":", 1)[1])
    with ExitStack() as stack:
        bus = stack.enter_context(bus_of_a_run("recorder"))
        bridge = subprocess.Popen(program(bus.endpoint, port))
        client = Client(stack.enter_context(connected(port)))
        deadline = time.monotonic() + LONG_S
        while len(client.heard) < 7 or len(client.heard["/log"]) < 3:
            assert time.monotonic() < deadline
            for key, (message, raw) in MESSAGES.items():
                text = message.model_dump_json().encode()
                bus.put(key, text if raw is None else raw, None if raw is None else text)
            client.take()
        bus.put("clock", END)
        assert bridge.wait(timeout=LONG_S) == 0
        yield dict(client.heard)


def test_a_report_is_a_fix_with_a_velocity_and_the_callsign(heard: dict[str, list[Any]]) -> None:
    fix = heard["/adsb/a1b2c3"][-1]
    assert (fix.latitude, fix.longitude) == (REPORT.latitude_deg, REPORT.longitude_deg)
    assert fix.altitude == pytest.approx(35_000.0 * FOOT)
    assert fix.velocity.x == pytest.approx(450.0 * KNOT)
    assert fix.velocity.y == pytest.approx(0.0, abs=1e-9)
    assert fix.velocity.z == pytest.approx(-64.0 * FOOT / 60.0)
    assert {pair.key: pair.value for pair in fix.metadata} == {
        "callsign": "AAL123", "squawk": "1325", "emergency": "none", "category": "A3",
    }  # fmt: skip


def test_an_altitude_that_is_not_known_is_no_number(heard: dict[str, list[Any]]) -> None:
    assert math.isnan(heard["/adsb/a4d5e6"][-1].altitude)


def test_the_truth_of_a_run_that_shares_it_is_a_fix_of_its_own(
    heard: dict[str, list[Any]],
) -> None:
    fix = heard["/truth/state/AAL123"][-1]
    assert (fix.latitude, fix.longitude, fix.altitude) == (38.9, -77.0, 10_668.0)
    assert (fix.velocity.x, fix.velocity.y, fix.velocity.z) == (231.5, -3.0, -2.0)


def test_times_of_a_run_are_times_of_day(heard: dict[str, list[Any]]) -> None:
    fix, picture = heard["/adsb/a1b2c3"][-1], heard["/camera/tower/frame"][-1]
    assert abs(fix.timestamp.seconds - time.time()) < 2 * LONG_S
    between_ns = picture.timestamp.ToNanoseconds() - fix.timestamp.ToNanoseconds()
    assert between_ns == pytest.approx(FRAME.t_frame_ns - REPORT.t_adsb_in_ns, abs=1000)


def test_what_is_said_is_logged_by_its_severity(heard: dict[str, list[Any]]) -> None:
    warning, info = 4, 2
    assert {(line.level, line.name, line.message) for line in heard["/log"]} == {
        (warning, "assistant to AAL123", ADVISORY.message),
        (info, "tcas to AAL123", "over: Traffic."),
        (info, "119.100 MHz", "AAL123: say again"),
    }


def test_a_transmission_is_heard_sample_by_sample(heard: dict[str, list[Any]]) -> None:
    audio = heard["/radio/119100/tx"][-1]
    assert audio.data == SOUND
    assert (audio.format, audio.sample_rate, audio.number_of_channels) == ("pcm-s16", 16_000, 1)


def test_a_picture_is_a_jpeg_of_its_colours(heard: dict[str, list[Any]]) -> None:
    picture = heard["/camera/tower/frame"][-1]
    assert picture.format == "jpeg"
    image = Image.open(io.BytesIO(picture.data), formats=["JPEG"])
    assert image.size == (WIDTH, HEIGHT)
    pixel = image.getpixel((5, 5))
    assert isinstance(pixel, tuple)
    assert math.dist(pixel, (200, 100, 50)) < 10.0


def test_detections_are_boxes_on_the_picture_of_the_same_time(
    heard: dict[str, list[Any]],
) -> None:
    annotations, picture = heard["/vision/tower"][-1], heard["/camera/tower/frame"][-1]
    assert annotations.timestamp.ToNanoseconds() == picture.timestamp.ToNanoseconds()
    (box,), (label,) = annotations.points, annotations.texts
    line_loop = 2
    assert box.type == line_loop
    assert [(point.x, point.y) for point in box.points] == [(10, 20), (30, 20), (30, 40), (10, 40)]
    assert label.text == "deer 0.75"


def test_a_client_that_never_reads_does_not_hold_up_the_end() -> None:
    port = int(free_endpoint().rsplit(":", 1)[1])
    sound = bytes(1_000_000)
    header = TRANSMISSION.model_copy(update={"samples": len(sound) // 2}).model_dump_json()
    with bus_of_a_run() as bus:
        bridge = subprocess.Popen(program(bus.endpoint, port))
        with connected(port) as connection:
            client = Client(connection)
            while not client.heard:
                bus.put("radio/119100/tx", sound, header.encode())
                client.take()
            for _ in range(100):
                bus.put("radio/119100/tx", sound, header.encode())
                time.sleep(0.01)
            bus.put("clock", END)
            assert bridge.wait(timeout=LONG_S) == 0


def test_a_port_that_is_taken_is_one_line_and_exit_code_2() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        done = subprocess.run(
            program(free_endpoint(), port), capture_output=True, text=True, timeout=LONG_S
        )
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert f"127.0.0.1:{port}" in line
    assert "--port" in line
