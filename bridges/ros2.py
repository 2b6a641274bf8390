"""Publishes a run on topics of ROS 2, for programs with the middleware rmw_zenoh.

    pip install airhilt[ros2]
    ros2 run rmw_zenoh_cpp rmw_zenohd
    python bridges/ros2.py --connect tcp/127.0.0.1:7448

``--to`` and ``--port`` name the Zenoh router of ROS 2, which rmw_zenohd is. Types are those of
ROS 2 Jazzy. Subscribers that read too slowly lose messages. The bridge ends with the run.

Keys, attachments and liveliness tokens are those of rmw_zenoh (docs/design.md and
rmw_zenoh_cpp/src/detail/liveliness_utils.cpp of https://github.com/ros2/rmw_zenoh).
"""

from __future__ import annotations

import itertools
import math
import os
import re
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np
import zenoh
from PIL import Image
from zenoh.ext import Int64, z_serialize

from airhilt.bus.bridge import WallClock, exiting_on_error, options, relay
from airhilt.bus.session import close_session, configuration
from airhilt.engines import Package
from airhilt.errors import BusError
from airhilt.messages import (
    AdsbReport,
    CameraFrame,
    Detection,
    Detections,
    Transmission,
)
from airhilt.record.kept_pictures import encoded
from airhilt.units import FOOT, SECOND_NS

with exiting_on_error():
    with Package("rosbags", "ros2").importing():
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore
    with Package("xxhash", "ros2").importing():
        import xxhash

NODE = "airhilt"
"""Name of the node, and the first part of its topics."""
QOS = "::,10:,:,:,,"
"""Quality of service as rmw_zenoh writes it: reliable, volatile, keeps the last 10 messages."""
GID_BYTES = 16
STATUS_FIX, SERVICE_GPS, COVARIANCE_TYPE_UNKNOWN = 0, 1, 0
"""Constants of sensor_msgs/NavSatStatus and sensor_msgs/NavSatFix."""
SAMPLE_BYTES = 2
VISION_MSGS = {
    "Point2D": "float64 x\nfloat64 y",
    "Pose2D": "vision_msgs/Point2D position\nfloat64 theta",
    "BoundingBox2D": "vision_msgs/Pose2D center\nfloat64 size_x\nfloat64 size_y",
    "ObjectHypothesis": "string class_id\nfloat64 score",
    "ObjectHypothesisWithPose": (
        "vision_msgs/ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose"
    ),
    "Detection2D": (
        "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\n"
        "vision_msgs/BoundingBox2D bbox\nstring id"
    ),
    "Detection2DArray": "std_msgs/Header header\nvision_msgs/Detection2D[] detections",
}
"""Messages of https://github.com/ros-perception/vision_msgs 4.1, which rosbags does not have."""


class Publisher(NamedTuple):
    """A publisher of a topic, its token, its identifier, and the numbers of its messages."""

    zenoh: zenoh.Publisher
    token: zenoh.LivelinessToken
    gid: bytes
    numbers: Iterator[int]


class Node:
    """A node of ROS 2 on a Zenoh session, as rmw_zenoh has it.

    Parameters
    ----------
    session
        Session with the router of ROS 2.
    domain
        ROS_DOMAIN_ID of the programs that are to see it.
    """

    def __init__(self, session: zenoh.Session, domain: int) -> None:
        self._session = session
        self._domain = domain
        self._types = get_typestore(Stores.ROS2_JAZZY)
        for name, definition in VISION_MSGS.items():
            self._types.register(get_types_from_msg(definition, f"vision_msgs/msg/{name}"))
        self._publishers: dict[str, Publisher] = {}
        self._ids = itertools.count()
        self._token = session.liveliness().declare_token(self._token_key("NN"))

    def make(self, kind: str, *values: Any) -> Any:
        """Return a message of a type, such as ``std_msgs/msg/String``, with its fields' values."""
        return self._types.types[kind](*values)

    def publish(self, topic: str, kind: str, *values: Any) -> None:
        """Publish a message with the values of its fields on a topic below the name of the node."""
        message = self._types.serialize_cdr(self.make(kind, *values), kind)
        with suppress(zenoh.ZError):  # Of a session that is closed: the run is over.
            publisher = self._publisher(topic, kind)
            number = Int64(next(publisher.numbers))
            attachment = z_serialize((number, Int64(time.time_ns()), publisher.gid))
            publisher.zenoh.put(bytes(message), attachment=attachment)

    def is_heard(self, topic: str, kind: str) -> bool:
        """Return whether a program has subscribed to a topic."""
        with suppress(zenoh.ZError):
            # The status is an object that Zenoh's stubs call a bool.
            status: Any = self._publisher(topic, kind).zenoh.matching_status
            return bool(status.matching)
        return False

    def _publisher(self, topic: str, kind: str) -> Publisher:
        """Return the publisher of a topic, which is made when the topic is first used."""
        publisher = self._publishers.get(topic)
        if publisher is None:
            name = f"{NODE}/{topic}"
            package, _, message = kind.split("/")
            rest = f"{package}::msg::dds_::{message}_", self._types.hash_rihs01(kind)
            key = self._token_key("MP", "%" + name.replace("/", "%"), *rest, QOS)
            publisher = self._publishers[topic] = Publisher(
                self._session.declare_publisher("/".join([str(self._domain), name, *rest])),
                self._session.liveliness().declare_token(key),
                xxhash.xxh3_128_intdigest(key.encode()).to_bytes(GID_BYTES, "little"),
                itertools.count(1),
            )
        return publisher

    def _token_key(self, kind: str, *rest: str) -> str:
        """Return the key of the token of the node (``NN``) or of the next publisher (``MP``)."""
        number = str(next(self._ids))
        zid = str(self._session.zid())
        parts = ("@ros2_lv", str(self._domain), zid, "0", number, kind, "%", "%", NODE, *rest)
        return "/".join(parts)


class Topics:
    """Publishes the messages of a run, in times of day."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._times = WallClock()

    def show_report(self, data: bytes) -> None:
        """Publish the position in an ADS-B report; its altitude is the pressure altitude."""
        report = AdsbReport.model_validate_json(data)
        self._node.publish(
            f"adsb_{report.icao24}",
            "sensor_msgs/msg/NavSatFix",
            self._header(report.t_adsb_in_ns, report.callsign or report.icao24),
            self._node.make("sensor_msgs/msg/NavSatStatus", STATUS_FIX, SERVICE_GPS),
            report.latitude_deg,
            report.longitude_deg,
            math.nan if report.altitude_ft is None else report.altitude_ft * FOOT,
            np.zeros(9),
            COVARIANCE_TYPE_UNKNOWN,
        )

    def show_picture(self, attachment: bytes, pixels: bytes) -> None:
        """Publish a picture of a camera as JPEG, if a program looks at it."""
        frame = CameraFrame.model_validate_json(attachment)
        topic, kind = f"{_camera(frame.camera)}/image/compressed", "sensor_msgs/msg/CompressedImage"
        if pixels and self._node.is_heard(topic, kind):
            size = frame.view.width_px, frame.view.height_px
            jpeg = encoded(Image.frombytes("RGB", size, pixels))
            header = self._header(frame.t_frame_ns, frame.camera)
            self._node.publish(topic, kind, header, "jpeg", np.frombuffer(jpeg, np.uint8))

    def show_detections(self, data: bytes) -> None:
        """Publish what a detector found in a picture; it has the time of the picture."""
        found = Detections.model_validate_json(data)
        header = self._header(found.t_frame_ns, found.camera)
        boxes = [self._detection(header, detection) for detection in found.detections]
        topic = f"{_camera(found.camera)}/detections"
        self._node.publish(topic, "vision_msgs/msg/Detection2DArray", header, boxes)

    def show_transmission(self, attachment: bytes, pcm: bytes) -> None:
        """Publish the sound of a transmission, at its end."""
        transmission = Transmission.model_validate_json(attachment)
        if pcm:
            dimensions = [
                self._node.make("std_msgs/msg/MultiArrayDimension", label, size, stride)
                for label, size, stride in (
                    ("samples", len(pcm) // SAMPLE_BYTES, len(pcm)),
                    ("bytes", SAMPLE_BYTES, SAMPLE_BYTES),
                )
            ]
            self._node.publish(
                f"radio_{transmission.frequency_khz}/audio",
                "std_msgs/msg/UInt8MultiArray",
                self._node.make("std_msgs/msg/MultiArrayLayout", dimensions, 0),
                np.frombuffer(pcm, np.uint8),
            )

    def shows_text(self, topic: str) -> Callable[[bytes], None]:
        """Return what publishes messages of the run as they are, in JSON."""
        return lambda data: self._node.publish(topic, "std_msgs/msg/String", data.decode())

    def _header(self, t_ns: int, frame_id: str) -> Any:
        time_ns = round(self._times.at(t_ns).timestamp() * SECOND_NS)
        stamp = self._node.make("builtin_interfaces/msg/Time", *divmod(time_ns, SECOND_NS))
        return self._node.make("std_msgs/msg/Header", stamp, frame_id)

    def _detection(self, header: Any, detection: Detection) -> Any:
        make, (left, top, right, bottom) = self._node.make, detection.box
        # A detector on pictures knows no pose.
        nowhere = make(
            "geometry_msgs/msg/PoseWithCovariance",
            make(
                "geometry_msgs/msg/Pose",
                make("geometry_msgs/msg/Point", 0.0, 0.0, 0.0),
                make("geometry_msgs/msg/Quaternion", 0.0, 0.0, 0.0, 1.0),
            ),
            np.zeros(36),
        )
        seen_as = make("vision_msgs/msg/ObjectHypothesis", detection.label, detection.confidence)
        centre = make("vision_msgs/msg/Point2D", (left + right) / 2.0, (top + bottom) / 2.0)
        box = make(
            "vision_msgs/msg/BoundingBox2D",
            make("vision_msgs/msg/Pose2D", centre, 0.0),
            right - left,
            bottom - top,
        )
        result = make("vision_msgs/msg/ObjectHypothesisWithPose", seen_as, nowhere)
        return make("vision_msgs/msg/Detection2D", header, [result], box, "")


def _camera(name: str) -> str:
    """Return the part of a topic that is of a camera; ROS 2 allows no other signs in it."""
    return "camera_" + re.sub(r"[^A-Za-z0-9]+", "_", name)


def main() -> None:
    """Run the bridge until the run is over."""
    parser = options(__doc__, 7447)
    parser.add_argument("--to", default="127.0.0.1", metavar="HOST", help="default: 127.0.0.1")
    parser.add_argument(
        "--domain",
        type=int,
        default=os.environ.get("ROS_DOMAIN_ID", "0"),
        help="ROS_DOMAIN_ID of the other programs; default: that of the environment, or 0",
    )
    given = parser.parse_args()
    with exiting_on_error():
        router = f"tcp/{given.to}:{given.port}"
        try:
            session = zenoh.open(configuration("client", "connect", router))
        except zenoh.ZError:
            raise BusError(
                f"no router of ROS 2 answers at {router}; start one with "
                "`ros2 run rmw_zenoh_cpp rmw_zenohd`, or name another with --to and --port"
            ) from None
        topics = Topics(Node(session, given.domain))
        try:
            relay(
                given,
                {
                    "adsb/*": topics.show_report,
                    "vision/*": topics.show_detections,
                    "asr/*": topics.shows_text("transcripts"),
                    "advisory/*": topics.shows_text("advisories"),
                },
                {
                    "radio/*/tx": topics.show_transmission,
                    "camera/*/frame": topics.show_picture,
                },
            )
        finally:
            close_session(session)


if __name__ == "__main__":
    main()
