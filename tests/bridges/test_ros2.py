"""A subscriber of ROS 2 sees and hears a run as if another node published it."""

from __future__ import annotations

import io
import math
import struct
import subprocess
import sys
import time
from collections import defaultdict
from contextlib import ExitStack
from dataclasses import dataclass, field
from importlib.util import find_spec
from typing import Any

import pytest
import zenoh
from PIL import Image
from pydantic import BaseModel
from zenoh.ext import Int64, z_deserialize

from airhilt.bus import free_endpoint
from airhilt.bus.session import configuration
from airhilt.host import library
from airhilt.messages import (
    Advisory,
    CameraFrame,
    CameraView,
    Clock,
    Detection,
    Detections,
    Evidence,
    Severity,
    Transcript,
    Transmission,
)
from airhilt.units import FOOT, SECOND_NS
from buses import bus_of_a_run, router_of_others
from reports import REPORT

pytestmark = [
    pytest.mark.decoders,
    pytest.mark.skipif(
        find_spec("rosbags") is None or find_spec("xxhash") is None,
        reason="no rosbags or xxhash: pip install airhilt[ros2]",
    ),
]
LONG_S = 120.0
"""Time that a busy machine may take to start a program."""
DOMAIN = 7
PUBLISHED_HASHES = {
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "std_msgs/msg/UInt8MultiArray": (
        "5687e861b8d307a5e48b7515467ae7a5fc2daf805bd0ce6d8e9e604bade9f385"
    ),
    "sensor_msgs/msg/NavSatFix": "62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404",
    "sensor_msgs/msg/CompressedImage": (
        "15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a"
    ),
}
"""Hashes of the types of ROS 2 Jazzy; docs/design.md of rmw_zenoh has that of String."""
WIDTH, HEIGHT = 64, 48
VIEW = CameraView(
    latitude_deg=38.9, longitude_deg=-77.0, height_m=60.0, heading_deg=0.0, pitch_deg=0.0,
    roll_deg=0.0, horizontal_fov_deg=60.0, width_px=WIDTH, height_px=HEIGHT,
)  # fmt: skip
FRAME = CameraFrame(camera="4L-end", seq=3, t_frame_ns=500_000_000, view=VIEW, sha256="")
DETECTIONS = Detections(
    camera="4L-end", seq=3, t_frame_ns=500_000_000, view=VIEW, engine="network",
    detections=(Detection(label="deer", confidence=0.75, box=(10.0, 20.0, 30.0, 44.0)),),
)  # fmt: skip
SOUND = struct.pack("<4h", 0, 1000, -1000, 32_767)
TRANSMISSION = Transmission(id="t1", frequency_khz=119_100, t_tx_ns=0, t_end_ns=250_000, samples=4)
TRANSCRIPT = Transcript(
    id="t1", frequency_khz=119_100, t_tx_ns=0, t_end_ns=1, text="say again", confidence=1.0,
    engine="text", speaker="AAL123",
)  # fmt: skip
ADVISORY = Advisory(
    id="simple-1", revision=0, recipient="AAL123", recipients=("AAL123",),
    kind="loss_of_separation", severity=Severity.WARNING, traffic=("AAL123", "UAL7"),
    message="AAL123, climb and maintain flight level three six zero.",
    evidence=Evidence(sources=("adsb",)), t_ready_ns=0,
)  # fmt: skip
MESSAGES: dict[str, tuple[BaseModel, bytes | None]] = {
    "adsb/a1b2c3": (REPORT, None),
    "advisory/AAL123": (ADVISORY, None),
    "asr/119100": (TRANSCRIPT, None),
    "vision/4L-end": (DETECTIONS, None),
    "radio/119100/tx": (TRANSMISSION, SOUND),
    "camera/4L-end/frame": (FRAME, bytes([200, 100, 50] * WIDTH * HEIGHT)),
}
"""Messages of the run, and the raw bytes that each is a header of."""
END = Clock(run="run", phase="finished", pace="1x").model_dump_json().encode()


def types() -> Any:
    """Return the types of ROS 2 Jazzy and of vision_msgs, written out as its files have them."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    for name, text in {
        "Point2D": "float64 x\nfloat64 y",
        "Pose2D": "vision_msgs/Point2D position\nfloat64 theta",
        "BoundingBox2D": "vision_msgs/Pose2D center\nfloat64 size_x\nfloat64 size_y",
        "ObjectHypothesis": "string class_id\nfloat64 score",
        "ObjectHypothesisWithPose": (
            "ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose"
        ),
        "Detection2D": (
            "std_msgs/Header header\nObjectHypothesisWithPose[] results\nBoundingBox2D bbox\n"
            "string id"
        ),
        "Detection2DArray": "std_msgs/Header header\nDetection2D[] detections",
    }.items():
        store.register(get_types_from_msg(text, f"vision_msgs/msg/{name}"))
    return store


@dataclass
class Heard:
    """Samples and tokens that a subscriber to the whole domain has heard."""

    messages: defaultdict[str, list[Any]] = field(default_factory=lambda: defaultdict(list))
    """Messages, read back by their type, by topic."""
    attachments: defaultdict[str, list[tuple[int, int, bytes]]] = field(
        default_factory=lambda: defaultdict(list)
    )
    types: dict[str, tuple[str, str]] = field(default_factory=dict)
    """Type, and the rest of the key with its hash, by topic."""
    tokens: set[str] = field(default_factory=set)
    ended: set[str] = field(default_factory=set)
    """Tokens that were there and are no more."""

    def hear(self, store: Any, sample: zenoh.Sample) -> None:
        _, *topic, kind, kind_hash = str(sample.key_expr).split("/")
        name = "/".join(topic)
        package, _, _, _, _, _, message = kind.split(":")
        full = f"{package}/msg/{message.removeprefix(':').removesuffix('_')}"
        self.types[name] = full, f"{kind}/{kind_hash}"
        attachment = sample.attachment
        assert attachment is not None
        number, time_ns, gid = z_deserialize(tuple[Int64, Int64, bytes], attachment)
        self.attachments[name].append((int(number), int(time_ns), gid))
        self.messages[name].append(store.deserialize_cdr(sample.payload.to_bytes(), full))

    def see(self, sample: zenoh.Sample) -> None:
        here = sample.kind == zenoh.SampleKind.PUT
        (self.tokens if here else self.ended).add(str(sample.key_expr))


def program(endpoint: str, router: str) -> list[str]:
    path = str(library.folder("bridges") / "ros2.py")
    port = router.rsplit(":", 1)[1]
    return [
        sys.executable, path, "--connect", endpoint, "--port", port, "--domain", str(DOMAIN)
    ]  # fmt: skip


@pytest.fixture(scope="module")
def heard() -> Heard:
    """Messages of a run that a subscriber of ROS 2 heard."""
    store, heard = types(), Heard()
    with ExitStack() as stack:
        bus = stack.enter_context(bus_of_a_run())
        endpoint = stack.enter_context(router_of_others())
        node = zenoh.open(configuration("client", "connect", endpoint))
        stack.callback(node.close)
        node.declare_subscriber(f"{DOMAIN}/**", lambda sample: heard.hear(store, sample))
        node.liveliness().declare_subscriber(f"@ros2_lv/{DOMAIN}/**", heard.see, history=True)
        bridge = subprocess.Popen(program(bus.endpoint, endpoint))
        deadline = time.monotonic() + LONG_S
        while any(len(heard.messages[topic]) < 2 for topic in TOPICS):
            assert time.monotonic() < deadline
            for key, (message, raw) in MESSAGES.items():
                text = message.model_dump_json().encode()
                bus.put(key, text if raw is None else raw, None if raw is None else text)
            time.sleep(0.1)
        bus.put("clock", END)
        assert bridge.wait(timeout=LONG_S) == 0
        while heard.tokens - heard.ended:
            assert time.monotonic() < deadline
            time.sleep(0.01)
    return heard


TOPICS = {
    "airhilt/adsb_a1b2c3": "sensor_msgs/msg/NavSatFix",
    "airhilt/advisories": "std_msgs/msg/String",
    "airhilt/transcripts": "std_msgs/msg/String",
    "airhilt/camera_4L_end/detections": "vision_msgs/msg/Detection2DArray",
    "airhilt/camera_4L_end/image/compressed": "sensor_msgs/msg/CompressedImage",
    "airhilt/radio_119100/audio": "std_msgs/msg/UInt8MultiArray",
}


def test_every_topic_has_its_type_and_the_hash_that_is_published(heard: Heard) -> None:
    assert {topic: kind for topic, (kind, _) in heard.types.items()} == TOPICS
    for kind, key in heard.types.values():
        package, _, name = kind.split("/")
        if kind in PUBLISHED_HASHES:
            assert key == f"{package}::msg::dds_::{name}_/RIHS01_{PUBLISHED_HASHES[kind]}"


def test_the_node_and_its_publishers_are_in_the_graph_until_the_run_ends(heard: Heard) -> None:
    tokens = sorted(token.split("/") for token in heard.tokens)
    (session,) = {token[2] for token in tokens}
    assert {"/".join(token[5:]) for token in tokens} == {"NN/%/%/airhilt"} | {
        f"MP/%/%/airhilt/%{topic.replace('/', '%')}/{key}/::,10:,:,:,,"
        for topic, (_, key) in heard.types.items()
    }
    assert len({tuple(token[:5]) for token in tokens}) == len(TOPICS) + 1
    assert {tuple(token[:4]) for token in tokens} == {("@ros2_lv", str(DOMAIN), session, "0")}


def test_messages_are_numbered_and_name_their_publisher_as_the_graph_does(heard: Heard) -> None:
    import xxhash

    gids = {
        xxhash.xxh3_128_intdigest(token.encode()).to_bytes(16, "little") for token in heard.tokens
    }
    for attachments in heard.attachments.values():
        numbers, times_ns, publishers = zip(*attachments, strict=True)
        assert list(numbers) == list(range(numbers[0], numbers[0] + len(numbers)))
        assert all(abs(each - time.time_ns()) < 2 * LONG_S * SECOND_NS for each in times_ns)
        assert len(set(publishers)) == 1
        assert gids.issuperset(publishers)


def test_a_report_is_a_fix_in_the_time_of_day(heard: Heard) -> None:
    fix = heard.messages["airhilt/adsb_a1b2c3"][-1]
    assert (fix.latitude, fix.longitude) == (REPORT.latitude_deg, REPORT.longitude_deg)
    assert fix.altitude == pytest.approx(35_000.0 * FOOT)
    assert fix.status.status == fix.status.STATUS_FIX
    assert fix.header.frame_id == "AAL123"
    assert abs(fix.header.stamp.sec - time.time()) < 2 * LONG_S


def test_a_picture_is_a_jpeg_of_its_colours(heard: Heard) -> None:
    picture = heard.messages["airhilt/camera_4L_end/image/compressed"][-1]
    assert (picture.format, picture.header.frame_id) == ("jpeg", "4L-end")
    image = Image.open(io.BytesIO(picture.data.tobytes()), formats=["JPEG"])
    assert image.size == (WIDTH, HEIGHT)
    pixel = image.getpixel((5, 5))
    assert isinstance(pixel, tuple)
    assert math.dist(pixel, (200, 100, 50)) < 10.0


def test_detections_are_boxes_with_the_time_of_their_picture(heard: Heard) -> None:
    found = heard.messages["airhilt/camera_4L_end/detections"][-1]
    picture = heard.messages["airhilt/camera_4L_end/image/compressed"][-1]
    assert found.header == picture.header
    (detection,) = found.detections
    box, (result,) = detection.bbox, detection.results
    assert (box.center.position.x, box.center.position.y) == (20.0, 32.0)
    assert (box.size_x, box.size_y) == (20.0, 24.0)
    assert (result.hypothesis.class_id, result.hypothesis.score) == ("deer", 0.75)


def test_a_transmission_is_heard_sample_by_sample(heard: Heard) -> None:
    audio = heard.messages["airhilt/radio_119100/audio"][-1]
    assert audio.data.tobytes() == SOUND
    assert [(each.label, each.size) for each in audio.layout.dim] == [("samples", 4), ("bytes", 2)]


def test_transcripts_and_advisories_are_json_of_the_run(heard: Heard) -> None:
    said, told = (heard.messages[f"airhilt/{name}"][-1] for name in ("transcripts", "advisories"))
    assert Transcript.model_validate_json(said.data) == TRANSCRIPT
    assert Advisory.model_validate_json(told.data) == ADVISORY


def test_without_a_router_of_ros_2_there_is_one_line_and_exit_code_2() -> None:
    done = subprocess.run(
        program(free_endpoint(), endpoint := free_endpoint()),
        capture_output=True, text=True, timeout=LONG_S,
    )  # fmt: skip
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert endpoint in line
    assert "rmw_zenohd" in line
