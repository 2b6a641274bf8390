"""The messages of a run as those of Foxglove, on topics named as the keys of the run.

They are Protobuf of https://docs.foxglove.dev/docs/sdk/schemas. ``/log`` has what is said and told.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from airhilt.displays.lines import line_of
from airhilt.engines import Package
from airhilt.imaging.pinhole import Pinhole
from airhilt.messages import (
    ActorTruth,
    AdsbReport,
    CameraFrame,
    Detection,
    Detections,
    Message,
    Severity,
    Transmission,
)
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS

with Package("foxglove-sdk", "foxglove").importing():
    from foxglove import Context, channels
    from foxglove.messages import (
        CameraCalibration,
        Color,
        CompressedImage,
        ImageAnnotations,
        KeyValuePair,
        LocationFix,
        Log,
        LogLevel,
        Point2,
        PointsAnnotation,
        PointsAnnotationType,
        RawAudio,
        TextAnnotation,
        Timestamp,
        Vector3,
    )

LEVELS = {
    Severity.INFO: LogLevel.Info,
    Severity.ADVISORY: LogLevel.Info,
    Severity.CAUTION: LogLevel.Warning,
    Severity.WARNING: LogLevel.Error,
}
BOX_COLOUR = Color(r=1.0, g=0.8, b=0.0, a=1.0)
LABEL_COLOUR = Color(r=0.0, g=0.0, b=0.0, a=1.0)
BOX_WIDTH_PX = 2.0
LABEL_SIZE_PX = 12.0
LOG = "/log"
"""Topic of the lines."""


class FoxgloveChannels:
    """Gives out the messages of a run on the topics of a context.

    Parameters
    ----------
    time_ns
        Returns the time that displays show for a time of the run, both in ns.
    """

    def __init__(self, context: Context, time_ns: Callable[[int], int]) -> None:
        self._context = context
        self._time_ns = time_ns
        self._channels: dict[str, Any] = {}

    def show(self, message: Message) -> None:
        """Give out a message that has no raw bytes, if displays have something to show for it."""
        match message:
            case AdsbReport():
                self._show_report(message)
            case ActorTruth():
                self._show_truth(message)
            case Detections():
                self._show_detections(message)
        if line := line_of(message):
            log = Log(
                timestamp=self.timestamp(line.t_ns),
                level=LEVELS[line.severity],
                name=line.source,
                message=line.text,
            )
            self.give_out(channels.LogChannel, LOG, log, line.t_ns)

    def show_sound(self, transmission: Transmission, pcm: bytes, t_ns: int) -> None:
        """Give out the sound of a transmission at a time."""
        audio = RawAudio(
            timestamp=self.timestamp(transmission.t_tx_ns),
            data=pcm,
            format="pcm-s16",
            sample_rate=transmission.sample_rate_hz,
            number_of_channels=1,
        )
        topic = f"/radio/{transmission.frequency_khz}/tx"
        self.give_out(channels.RawAudioChannel, topic, audio, t_ns)

    def is_watched(self, camera: str) -> bool:
        """Return whether a program looks at the pictures of a camera."""
        topic = _picture_topic(camera)
        return bool(self._channel(channels.CompressedImageChannel, topic).has_sinks())

    def show_picture(self, frame: CameraFrame, jpeg: bytes) -> None:
        """Give out a picture, and the lens that it was taken with."""
        taken, view, pinhole = self.timestamp(frame.t_frame_ns), frame.view, Pinhole(frame.view)
        (x, y), focal = pinhole.centre_px, pinhole.focal_px
        picture = CompressedImage(timestamp=taken, frame_id=frame.camera, data=jpeg, format="jpeg")
        calibration = CameraCalibration(
            timestamp=taken,
            frame_id=frame.camera,
            width=view.width_px,
            height=view.height_px,
            K=[focal, 0.0, x, 0.0, focal, y, 0.0, 0.0, 1.0],
            R=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            P=[focal, 0.0, x, 0.0, 0.0, focal, y, 0.0, 0.0, 0.0, 1.0, 0.0],
        )
        topic = f"/camera/{frame.camera}/calibration"
        self.give_out(channels.CameraCalibrationChannel, topic, calibration, frame.t_ns)
        topic = _picture_topic(frame.camera)
        self.give_out(channels.CompressedImageChannel, topic, picture, frame.t_ns)

    def timestamp(self, t_ns: int) -> Timestamp:
        """Return a time of the run as displays show it."""
        return Timestamp(*divmod(self._time_ns(t_ns), SECOND_NS))

    def give_out(self, kind: Any, topic: str, message: Any, t_ns: int) -> None:
        """Give out a message of Foxglove at a time of the run."""
        self._channel(kind, topic).log(message, log_time=self._time_ns(t_ns))

    def _show_report(self, report: AdsbReport) -> None:
        """Show the position in an ADS-B report; its altitude is the pressure altitude."""
        speed, track = report.ground_speed_kt * KNOT, report.track_deg * DEGREE
        said = {
            "callsign": report.callsign,
            "squawk": report.squawk,
            "emergency": report.emergency,
            "category": report.emitter_category,
        }
        fix = LocationFix(
            timestamp=self.timestamp(report.t_adsb_in_ns),
            latitude=report.latitude_deg,
            longitude=report.longitude_deg,
            altitude=math.nan if report.altitude_ft is None else report.altitude_ft * FOOT,
            velocity=Vector3(
                x=speed * math.sin(track),
                y=speed * math.cos(track),
                z=report.vertical_rate_fpm * FOOT_PER_MINUTE,
            ),
            metadata=[KeyValuePair(key=key, value=value) for key, value in said.items() if value],
        )
        self.give_out(channels.LocationFixChannel, f"/adsb/{report.icao24}", fix, report.t_ns)

    def _show_truth(self, state: ActorTruth) -> None:
        fix = LocationFix(
            timestamp=self.timestamp(state.t_ns),
            latitude=state.latitude_deg,
            longitude=state.longitude_deg,
            altitude=state.altitude_m,
            velocity=Vector3(
                x=state.velocity_east_m_s, y=state.velocity_north_m_s, z=-state.velocity_down_m_s
            ),
            metadata=[KeyValuePair(key="phase", value=state.phase)],
        )
        self.give_out(channels.LocationFixChannel, truth_topic(state.actor), fix, state.t_ns)

    def _show_detections(self, found: Detections) -> None:
        """Show the boxes of what a detector found; they have the time of their picture."""
        taken = self.timestamp(found.t_frame_ns)
        annotations = ImageAnnotations(
            timestamp=taken,
            points=[_box(detection, taken) for detection in found.detections],
            texts=[_label(detection, taken) for detection in found.detections],
        )
        topic = f"/vision/{found.camera}"
        self.give_out(channels.ImageAnnotationsChannel, topic, annotations, found.t_ns)

    def _channel(self, kind: Any, topic: str) -> Any:
        """Return the channel of a topic, which is made at its first message."""
        channel = self._channels.get(topic)
        if channel is None:
            channel = self._channels[topic] = kind(topic, context=self._context)
        return channel


def truth_topic(actor: str) -> str:
    """Return the topic of the true positions of an actor."""
    return f"/truth/state/{actor}"


def _picture_topic(camera: str) -> str:
    return f"/camera/{camera}/frame"


def _box(detection: Detection, taken: Timestamp) -> PointsAnnotation:
    left, top, right, bottom = detection.box
    corners = ((left, top), (right, top), (right, bottom), (left, bottom))
    return PointsAnnotation(
        timestamp=taken,
        type=PointsAnnotationType.LineLoop,
        points=[Point2(x=x, y=y) for x, y in corners],
        outline_color=BOX_COLOUR,
        thickness=BOX_WIDTH_PX,
    )


def _label(detection: Detection, taken: Timestamp) -> TextAnnotation:
    left, top, _, _ = detection.box
    return TextAnnotation(
        timestamp=taken,
        position=Point2(x=left, y=top),
        text=f"{detection.label} {detection.confidence:.2f}",
        font_size=LABEL_SIZE_PX,
        text_color=LABEL_COLOUR,
        background_color=BOX_COLOUR,
    )
