"""Shows a run live in Foxglove, Lichtblick and other programs of the Foxglove WebSocket protocol.

    python bridges/foxglove_websocket.py --connect tcp/127.0.0.1:7447

Open the data source "Foxglove WebSocket" at ``ws://localhost:8765``. The topics have the names of
the keys of the run, and ``/log`` has what is said: transcripts, advisories and alerts. The bridge
ends with the run.

Messages are those of Foxglove (https://docs.foxglove.dev/docs/sdk/schemas), as Protobuf. Programs
that read too slowly lose the oldest messages.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from PIL import Image

from airhilt.bus.bridge import LAST_S, WallClock, add_host, exiting_on_error, options, relay
from airhilt.errors import BusError, first_line
from airhilt.messages import (
    ActorTruth,
    AdsbReport,
    Advisory,
    CameraFrame,
    Detections,
    EquipmentAlert,
    Message,
    Transcript,
    Transmission,
)
from airhilt.record.kept_pictures import encoded
from airhilt.units import SECOND_NS

with exiting_on_error():
    from foxglove import Context, start_server

    from airhilt.displays.foxglove_channels import FoxgloveChannels

SHOWN: dict[str, type[Message]] = {
    "adsb/*": AdsbReport,
    "truth/state/*": ActorTruth,
    "advisory/*": Advisory,
    "equipment/*/*": EquipmentAlert,
    "asr/*": Transcript,
    "vision/*": Detections,
}
"""Messages that are shown, by the patterns of their keys."""


class Display:
    """Gives out the messages of a run that goes on, in times of day."""

    def __init__(self, context: Context) -> None:
        times = WallClock()
        self._channels = FoxgloveChannels(
            context, lambda t_ns: round(times.at(t_ns).timestamp() * SECOND_NS)
        )

    def shows(self, kind: type[Message]) -> Callable[[bytes], None]:
        """Return what shows the messages of a class."""
        return lambda data: self._channels.show(kind.model_validate_json(data))

    def show_transmission(self, header: bytes, pcm: bytes) -> None:
        """Give out the sound of a transmission, at its end."""
        transmission = Transmission.model_validate_json(header)
        if pcm:
            self._channels.show_sound(transmission, pcm, transmission.t_ns)

    def show_picture(self, header: bytes, pixels: bytes) -> None:
        """Show a picture of a camera, if a program looks at it."""
        frame = CameraFrame.model_validate_json(header)
        if pixels and self._channels.is_watched(frame.camera):
            size = frame.view.width_px, frame.view.height_px
            self._channels.show_picture(frame, encoded(Image.frombytes("RGB", size, pixels)))


def main() -> None:
    """Run the bridge until the run is over."""
    parser = options(__doc__, 8765)
    add_host(parser)
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
            {pattern: display.shows(kind) for pattern, kind in SHOWN.items()},
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
