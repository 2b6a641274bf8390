"""Shows a run live in Foxglove, Lichtblick and other programs of the Foxglove WebSocket protocol.

    python bridges/foxglove_websocket.py --connect tcp/127.0.0.1:7447

Open the data source "Foxglove WebSocket" at ``ws://localhost:8765``. The topics have the names of
the keys of the run, and ``/log`` has what is said: transcripts, advisories and alerts. The bridge
ends with the run.

Messages are those of Foxglove (https://docs.foxglove.dev/docs/sdk/schemas), as Protobuf. Programs
that read too slowly lose the oldest messages.
"""

from __future__ import annotations

import math
import threading
from typing import Any

from PIL import Image

from airhilt.bus.bridge import LAST_S, WallClock, exiting_on_error, options, relay
from airhilt.errors import BusError, first_line
from airhilt.messages import (
    ActorTruth,
    AdsbReport,
    Advisory,
    CameraFrame,
    Detection,
    Detections,
    EquipmentAlert,
    Severity,
    Transcript,
    Transmission,
)
from airhilt.station.pictures import encoded
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS

with exiting_on_error():
    try:
        from foxglove import Context, channels, start_server
        from foxglove.messages import (
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
    except ImportError as error:
        raise BusError(
            f"the package foxglove-sdk is missing or does not load ({first_line(error)}); install "
            "it with `pip install airhilt[foxglove]`"
        ) from None

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


class Display:
    """Gives out the messages of a run on the topics of a context."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._channels: dict[str, Any] = {}
        self._lines = channels.LogChannel("/log", context=context)
        self._times = WallClock()

    def show_report(self, data: bytes) -> None:
        """Show the position in an ADS-B report; its altitude is the pressure altitude."""
        report = AdsbReport.model_validate_json(data)
        speed, track = report.ground_speed_kt * KNOT, report.track_deg * DEGREE
        said = {
            "callsign": report.callsign,
            "squawk": report.squawk,
            "emergency": report.emergency,
            "category": report.emitter_category,
        }
        fix = LocationFix(
            timestamp=self._time(report.t_adsb_in_ns),
            latitude=report.latitude_deg,
            longitude=report.longitude_deg,
            altitude=(report.altitude_ft or 0.0) * FOOT,
            velocity=Vector3(
                x=speed * math.sin(track),
                y=speed * math.cos(track),
                z=report.vertical_rate_fpm * FOOT_PER_MINUTE,
            ),
            metadata=[KeyValuePair(key=key, value=value) for key, value in said.items() if value],
        )
        self._channel(channels.LocationFixChannel, f"/adsb/{report.icao24}").log(
            fix, log_time=self._time_ns(report.t_ns)
        )

    def show_truth(self, data: bytes) -> None:
        """Show the true position of an actor."""
        state = ActorTruth.model_validate_json(data)
        fix = LocationFix(
            timestamp=self._time(state.t_ns),
            latitude=state.latitude_deg,
            longitude=state.longitude_deg,
            altitude=state.altitude_m,
            velocity=Vector3(
                x=state.velocity_east_m_s, y=state.velocity_north_m_s, z=-state.velocity_down_m_s
            ),
            metadata=[KeyValuePair(key="phase", value=state.phase)],
        )
        self._channel(channels.LocationFixChannel, f"/truth/state/{state.actor}").log(
            fix, log_time=self._time_ns(state.t_ns)
        )

    def show_advisory(self, data: bytes) -> None:
        """Log an advisory of the assistant."""
        self._log_advisory("assistant", Advisory.model_validate_json(data))

    def show_alert(self, data: bytes) -> None:
        """Log an alert of equipment in the world."""
        alert = EquipmentAlert.model_validate_json(data)
        self._log_advisory(alert.equipment, alert.advisory)

    def show_transcript(self, data: bytes) -> None:
        """Log the words of a transmission."""
        transcript = Transcript.model_validate_json(data)
        if transcript.text:
            self._log(
                transcript.t_ns,
                LogLevel.Info,
                f"{transcript.frequency_khz / 1000:.3f} MHz",
                f"{transcript.speaker or 'unknown'}: {transcript.text}",
            )

    def show_transmission(self, header: bytes, pcm: bytes) -> None:
        """Give out the sound of a transmission."""
        transmission = Transmission.model_validate_json(header)
        if pcm:
            audio = RawAudio(
                timestamp=self._time(transmission.t_tx_ns),
                data=pcm,
                format="pcm-s16",
                sample_rate=transmission.sample_rate_hz,
                number_of_channels=1,
            )
            topic = f"/radio/{transmission.frequency_khz}/tx"
            self._channel(channels.RawAudioChannel, topic).log(
                audio, log_time=self._time_ns(transmission.t_ns)
            )

    def show_picture(self, header: bytes, pixels: bytes) -> None:
        """Show a picture of a camera as JPEG, if a program looks at it."""
        frame = CameraFrame.model_validate_json(header)
        channel = self._channel(channels.CompressedImageChannel, f"/camera/{frame.camera}/frame")
        if pixels and channel.has_sinks():
            size = frame.view.width_px, frame.view.height_px
            picture = CompressedImage(
                timestamp=self._time(frame.t_frame_ns),
                frame_id=frame.camera,
                data=encoded(Image.frombytes("RGB", size, pixels)),
                format="jpeg",
            )
            channel.log(picture, log_time=self._time_ns(frame.t_ns))

    def show_detections(self, data: bytes) -> None:
        """Show the boxes of what a detector found; they have the time of their picture."""
        found = Detections.model_validate_json(data)
        taken = self._time(found.t_frame_ns)
        annotations = ImageAnnotations(
            timestamp=taken,
            points=[_box(detection, taken) for detection in found.detections],
            texts=[_label(detection, taken) for detection in found.detections],
        )
        self._channel(channels.ImageAnnotationsChannel, f"/vision/{found.camera}").log(
            annotations, log_time=self._time_ns(found.t_ns)
        )

    def _log_advisory(self, source: str, advisory: Advisory) -> None:
        level = LEVELS[advisory.severity] if advisory.active else LogLevel.Info
        message = advisory.message if advisory.active else f"over: {advisory.message}"
        self._log(advisory.t_ns, level, f"{source} to {advisory.recipient}", message)

    def _log(self, t_ns: int, level: LogLevel, name: str, message: str) -> None:
        line = Log(timestamp=self._time(t_ns), level=level, name=name, message=message)
        self._lines.log(line, log_time=self._time_ns(t_ns))

    def _channel(self, kind: Any, topic: str) -> Any:
        """Return the channel of a topic, which is made at its first message."""
        channel = self._channels.get(topic)
        if channel is None:
            channel = self._channels[topic] = kind(topic, context=self._context)
        return channel

    def _time(self, t_ns: int) -> Timestamp:
        return Timestamp.from_datetime(self._times.at(t_ns))

    def _time_ns(self, t_ns: int) -> int:
        return round(self._times.at(t_ns).timestamp() * SECOND_NS)


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


def main() -> None:
    """Run the bridge until the run is over."""
    parser = options(__doc__, 8765)
    parser.add_argument(
        "--host", default="127.0.0.1", help="address to listen on; default: 127.0.0.1"
    )
    given = parser.parse_args()
    with exiting_on_error():
        context = Context()
        try:
            server = start_server(name="AIRHILT", host=given.host, port=given.port, context=context)
        except (RuntimeError, OverflowError) as error:
            raise BusError(
                f"cannot listen on {given.host}:{given.port}: {first_line(error)}; choose another "
                "port with --port"
            ) from None
        display = Display(context)
        relay(
            given,
            {
                "adsb/*": display.show_report,
                "truth/state/*": display.show_truth,
                "advisory/*": display.show_advisory,
                "equipment/*/*": display.show_alert,
                "asr/*": display.show_transcript,
                "vision/*": display.show_detections,
            },
            {
                "radio/*/tx": display.show_transmission,
                "camera/*/frame": display.show_picture,
            },
        )
        # Programs that do not read would hold up the end of the server.
        end = threading.Thread(target=server.stop, daemon=True)
        end.start()
        end.join(LAST_S)


if __name__ == "__main__":
    main()
