"""The subscription of a station to a run: it listens, and passes on what people at seats do.

What comes faster than the station can take is dropped, so that the run never waits.
"""

from __future__ import annotations

import json
import queue
import threading
from base64 import b64encode
from collections import OrderedDict
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

import zenoh
from pydantic import ValidationError

from airhilt.bus.seat_client import SeatClient
from airhilt.host.text import readable
from airhilt.messages import (
    AdvisoryAudio,
    PageRefusal,
    Transmission,
    bus_message,
    key_chunk,
)
from airhilt.record import Logged
from airhilt.station.audiences import Audience, audience_of, heard_by
from airhilt.station.changes import Changes
from airhilt.station.connection import RunConnection
from airhilt.station.pictures import Picture

SUBSCRIBED = (
    "clock", "briefing", "status/*", "adsb/*", "surface/*", "radar/**", "radio/*/tx", "asr/*",
    "advisory/*", "equipment/**", "tts/*", "vision/*", "command/*",
)  # fmt: skip
"""Keys below the run of what everybody may see."""
TRUTH = "truth/**"
"""Keys of the truth, for observers alone; of it comes what the run shares."""
ASKED = ("briefing", "clock", "radar/*/info")
"""Keys that the run answers, for who comes late."""
STREAMED = "radio/*/audio"
"""Keys of the sound of transmissions while they last; the receiver of a seat has its own."""
MOST_WAITING_BYTES = 32_000_000
"""Largest size of the messages that wait for the station, in bytes."""
MOST_SOUNDS = 60
"""Largest number of transmissions and spoken advisories whose sound is kept."""
MOST_SOUND_BYTES = 64_000_000
"""Largest size of these sounds, in bytes: half an hour."""
MOST_PICTURES = 48
"""Largest number of pictures of a camera that are kept: about three seconds."""


class Sound(NamedTuple):
    """The PCM of a transmission or a spoken advisory, and who may hear it."""

    pcm: bytes
    audience: Audience


class Subscription:
    """Listens to a run until it is closed; the connection stays open.

    Parameters
    ----------
    connection
        Connection to the run, as the operator where there are seats.
    take
        Called with each message, on one thread.
    lost
        Called on that thread once the run is not there any more.
    seats
        Seats of people, who see nothing of the truth.
    sounds
        Gets the sound of the frequencies piece by piece; None: it is not needed.

    Attributes
    ----------
    run
        Name of the run.
    """

    def __init__(
        self,
        connection: RunConnection,
        take: Callable[[Logged], None],
        lost: Callable[[], None],
        *,
        seats: Sequence[str] = (),
        sounds: Changes | None = None,
    ) -> None:
        self._streamed = sounds
        self._take = take
        self._lost = lost
        self._session, self._prefix = connection.session, connection.prefix
        self.run = connection.run
        self._waiting: queue.Queue[Logged | None] = queue.Queue()
        self._waiting_bytes = 0
        self._sounds: OrderedDict[str, Sound] = OrderedDict()
        self._has_seats = bool(seats)
        self._pictures: dict[str, OrderedDict[int, Picture]] = {}
        self._watched: dict[str, zenoh.Subscriber[None]] = {}
        self._watching = threading.Lock()
        """Held while it is changed which cameras are watched."""
        self._lock = threading.Lock()
        own = [f"seat/{key_chunk(seat)}" for seat in seats]
        cockpits = [f"cockpit/{key_chunk(seat)}{of}" for seat in seats for of in ("", "/position")]
        heard = [*SUBSCRIBED, *own, *cockpits] if seats else [*SUBSCRIBED, TRUTH]
        streamed = [] if sounds is None else [STREAMED, *(f"{key}/audio" for key in own)]
        self._kept: list[Any] = [
            self._session.declare_subscriber(f"{self._prefix}/{key}", receive)
            for keys, receive in ((heard, self._hear), (streamed, self._stream))
            for key in keys
        ]
        self._kept.append(
            self._session.liveliness().declare_subscriber(
                f"{self._prefix}/run", self._ended, history=True
            )
        )
        for key in (*ASKED, *own):  # What the run has told before.
            for sample in connection.answers(key):
                self._hear(sample)
        self._thread = threading.Thread(target=self._work, name="station", daemon=True)
        self._thread.start()

    def sound(self, name: str) -> Sound | None:
        """Return the sound of a transmission or a spoken advisory, None if it is not kept."""
        with self._lock:
            return self._sounds.get(name)

    def picture(self, camera: str, seq: int) -> Picture | None:
        """Return a picture of a camera that is watched, None if it is not kept."""
        with self._lock:
            kept = self._pictures.get(camera)
            return None if kept is None else kept.get(seq)

    def watch(self, cameras: set[str]) -> None:
        """Let the pictures of these cameras come, and no others: the run draws them for us."""
        with self._watching:
            for name in set(self._watched) - cameras:
                self._watched.pop(name).undeclare()  # type: ignore[no-untyped-call]
            for name in cameras - set(self._watched):
                key = f"{self._prefix}/camera/{name}/frame"
                self._watched[name] = self._session.declare_subscriber(key, self._see)
        with self._lock:
            for name in set(self._pictures) - cameras:
                del self._pictures[name]

    def seat_client(self, seat: str, secret: str) -> SeatClient:
        """Return a client for a seat, which is not taken yet."""
        return SeatClient(self._session, self._prefix, seat, secret)

    def log_refusal(self, text: str) -> None:
        """Let the log of the run have what was refused at the page, in words."""
        message = PageRefusal(text=readable(text))
        self._session.put(f"{self._prefix}/page", message.model_dump_json())

    def close(self) -> None:
        """Listen no more."""
        self.watch(set())
        for entity in self._kept:
            entity.undeclare()
        self._kept.clear()
        self._waiting.put(None)
        self._thread.join()

    def _hear(self, sample: zenoh.Sample) -> None:
        """Receive a message on a thread of Zenoh; one above its limit is dropped."""
        key = str(sample.key_expr)[len(self._prefix) + 1 :]
        data = sample.payload.to_bytes()
        header = b"" if sample.attachment is None else sample.attachment.to_bytes()
        model = bus_message(key)
        limit = None if model is None else model.limit
        if limit is not None and len(data) + len(header) > limit.size_bytes:
            return
        if header:
            self._keep_sound(key, header, data)
        self._post(Logged(key, "", 0, header or data))

    def _post(self, logged: Logged) -> None:
        """Let a message wait for the station; without room it is dropped."""
        with self._lock:
            if self._waiting_bytes + _size_bytes(logged) > MOST_WAITING_BYTES:
                return
            self._waiting_bytes += _size_bytes(logged)
        self._waiting.put(logged)

    def _keep_sound(self, key: str, header: bytes, pcm: bytes) -> None:
        """Keep the sound of a spoken advisory; without seats also that of a transmission.

        At seats calls are heard while they last, each at its own receiver.
        """
        model = bus_message(key)
        if not pcm or (model is Transmission and self._has_seats):
            return
        if model is not Transmission and model is not AdvisoryAudio:
            return
        with suppress(ValidationError):  # The receiver of the message tells it.
            message = model.model_validate_json(header)
            sound = Sound(pcm, audience_of(key, message))
            with self._lock:
                self._sounds[sound_name(message)] = sound
                while (
                    len(self._sounds) > MOST_SOUNDS
                    or sum(len(one.pcm) for one in self._sounds.values()) > MOST_SOUND_BYTES
                ):
                    self._sounds.popitem(last=False)

    def _stream(self, sample: zenoh.Sample) -> None:
        """Receive a piece of a transmission, its beginning or its end, on a thread of Zenoh."""
        if sample.attachment is None or self._streamed is None:
            return
        header = json.loads(sample.attachment.to_bytes())
        about = {name: header[name] for name in ("id", "frequency_khz")}
        sound = b64encode(sample.payload.to_bytes()).decode()
        piece = about | ({"pcm": sound} if sound else {})
        self._streamed.add(header["phase"], piece, audience=heard_by(header))

    def _see(self, sample: zenoh.Sample) -> None:
        """Receive a picture on a thread of Zenoh."""
        if sample.attachment is None:
            return
        frame = json.loads(sample.attachment.to_bytes())
        if frame["encoding"] != "rgb8":
            return
        view = frame["view"]
        picture = Picture(
            view["width_px"],
            view["height_px"],
            sample.payload.to_bytes(),
            Audience("camera", view["carrier"]),
        )
        with self._lock:
            kept = self._pictures.setdefault(frame["camera"], OrderedDict())
            kept[frame["seq"]] = picture
            while len(kept) > MOST_PICTURES:
                kept.popitem(last=False)

    def _ended(self, sample: zenoh.Sample) -> None:
        if sample.kind == zenoh.SampleKind.DELETE:
            self._waiting.put(Logged("", "", 0, b""))

    def _work(self) -> None:
        while (logged := self._waiting.get()) is not None:
            with self._lock:
                self._waiting_bytes -= _size_bytes(logged)
            if logged.key:
                self._take(logged)
            else:
                self._lost()


def sound_name(header: Transmission | AdvisoryAudio) -> str:
    """Return the name by which the sound of a transmission or a spoken advisory is asked for."""
    if isinstance(header, AdvisoryAudio):
        return f"{header.id}-{header.revision}-{header.recipient}"
    return header.id


def _size_bytes(logged: Logged) -> int:
    return len(logged.key) + len(logged.data)
