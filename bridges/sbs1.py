"""Gives out the ADS-B reports of a run as an SBS-1 "BaseStation" feed.

    python bridges/sbs1.py --connect tcp/127.0.0.1:7447 --port 30003

Each report becomes one line, of type MSG,3 in the air and MSG,2 on the ground. Times are simulation
times, as if the run had begun at midnight of 1 January 1970. The feed listens on the loopback
address and ends with the run.
"""

from __future__ import annotations

import argparse
import contextlib
import queue
import socket
import sys
import threading
from datetime import UTC, datetime, timedelta
from pathlib import Path

import zenoh

from airhilt.bus.session import ROOT, connect_client
from airhilt.errors import BusError
from airhilt.messages import AdsbReport, Clock
from airhilt.units import SECOND_NS

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def line(report: AdsbReport) -> str:
    """Return a report as one line of the feed (without its end).

    Type 3 is an airborne position, type 2 a surface position, which has no altitude.
    """
    when = EPOCH + timedelta(seconds=report.t_adsb_out_ns / SECOND_NS)
    date, clock = when.strftime("%Y/%m/%d"), when.strftime("%H:%M:%S.%f")[:-3]
    kind, ground = ("2", "-1") if report.on_ground else ("3", "0")
    altitude = "" if report.altitude_ft is None else f"{report.altitude_ft:.0f}"
    return ",".join(
        [
            "MSG", kind, "1", "1", report.icao24.upper(), "1", date, clock, date, clock,
            report.callsign or "", altitude, f"{report.ground_speed_kt:.0f}",
            f"{report.track_deg:.0f}", f"{report.latitude_deg:.5f}",
            f"{report.longitude_deg:.5f}", f"{report.vertical_rate_fpm:.0f}", "", "0", "0", "0",
            ground,
        ]
    )  # fmt: skip


class Feed:
    """A TCP server that sends every line to every client; one that falls behind is let go."""

    WAITING_LINES = 1000

    def __init__(self, port: int) -> None:
        self._server = socket.create_server(("127.0.0.1", port))
        self._clients: list[queue.Queue[str]] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def send(self, text: str) -> None:
        """Queue a line for all clients."""
        for client in list(self._clients):
            try:
                client.put_nowait(text)
            except queue.Full:
                self._clients.remove(client)

    def _accept(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                connection, _ = self._server.accept()
                client: queue.Queue[str] = queue.Queue(self.WAITING_LINES)
                self._clients.append(client)
                threading.Thread(target=self._serve, args=(connection, client), daemon=True).start()

    def _serve(self, connection: socket.socket, client: queue.Queue[str]) -> None:
        with contextlib.suppress(OSError), connection:
            while True:
                connection.sendall(f"{client.get()}\r\n".encode())
        with contextlib.suppress(ValueError):
            self._clients.remove(client)


def main() -> None:
    """Run the bridge until the run is over."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--connect", help="the run's endpoint, if not that of the keys")
    parser.add_argument("--tls", type=Path, help="folder with observer.json of `airhilt keys init`")
    parser.add_argument("--port", type=int, default=30003, help="where clients connect")
    given = parser.parse_args()
    feed = Feed(given.port)
    try:
        session = connect_client(given.connect, 30.0, given.tls, "observer")
    except BusError as error:
        sys.exit(str(error))

    def forward(sample: zenoh.Sample) -> None:
        feed.send(line(AdsbReport.model_validate_json(sample.payload.to_bytes())))

    adsb = session.declare_subscriber(f"{ROOT}/*/adsb/*", forward)
    clock = session.declare_subscriber(f"{ROOT}/*/clock")
    for sample in clock:
        message = Clock.model_validate_json(sample.payload.to_bytes())
        if message.phase in ("finished", "stopped"):
            break
    adsb.undeclare()  # type: ignore[no-untyped-call]
    session.close()  # type: ignore[no-untyped-call]


if __name__ == "__main__":
    main()
