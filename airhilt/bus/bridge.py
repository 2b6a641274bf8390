"""Common part of bridges: their options, the messages of the run, and a feed over TCP."""

from __future__ import annotations

import argparse
import contextlib
import queue
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, NamedTuple

import zenoh

from airhilt.bus.access import Role
from airhilt.bus.session import close_session, connect_client, find_run, wait_until_over
from airhilt.errors import AirhiltError, BusError, first_line
from airhilt.messages import AdsbReport, LiveReport, Message
from airhilt.units import SECOND_NS

PATIENCE_S = 30.0
"""Time for which a bridge waits for its run, in s."""
WAITING = 1000
"""Greatest number of pieces that wait for one client; one that falls further behind is let go."""
LAST_S = 1.0
"""Time that clients have at the end of a run to take what waits for them, in s."""
RETRY_S = 1.0
"""Time between two attempts to connect to a program, in s."""
SILENCE_S = 10.0
"""Time after which a bridge tells what it still waits for, in s."""
READ_BYTES = 65_536
"""Greatest number of bytes that are read from a receiver at a time."""
LOOPBACK = "127.0.0.1"
Publish = Callable[[str, Message], None]
"""Publishes a message on a key below the run."""


def options(
    documentation: str | None, port: int, role: Role = "observer"
) -> argparse.ArgumentParser:
    """Return a parser of the options that all bridges have.

    Parameters
    ----------
    documentation
        Docstring of the bridge.
    port
        Default of the option ``--port``.
    role
        Role of the bridge in a run with keys.
    """
    parser = argparse.ArgumentParser(
        description=documentation, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--connect", help="the run's endpoint, if not that of the keys")
    parser.add_argument("--tls", type=Path, help=f"folder with {role}.json of `airhilt keys init`")
    parser.add_argument("--run", help="name of the run, where a router leads to several")
    parser.add_argument("--port", type=int, default=port, help=f"default: {port}")
    return parser


def add_host(parser: argparse.ArgumentParser) -> None:
    """Add the option with the address on which a bridge listens."""
    parser.add_argument(
        "--host", default=LOOPBACK, help=f"address to listen on; default: {LOOPBACK}"
    )


def _subscribed(
    session: zenoh.Session,
    prefix: str,
    heard: Mapping[str, Callable[[bytes], None]],
    heard_raw: Mapping[str, Callable[[bytes, bytes], None]],
) -> list[zenoh.Subscriber[None]]:
    """Return subscribers that hand the messages of a run on, as `relay` says."""

    def forward(call: Callable[[bytes], None]) -> Callable[[zenoh.Sample], None]:
        return lambda sample: call(sample.payload.to_bytes())

    def forward_raw(call: Callable[[bytes, bytes], None]) -> Callable[[zenoh.Sample], None]:
        def hear(sample: zenoh.Sample) -> None:
            if sample.attachment is not None:
                call(sample.attachment.to_bytes(), sample.payload.to_bytes())

        return hear

    calls = {key: forward(call) for key, call in heard.items()}
    calls |= {key: forward_raw(call) for key, call in heard_raw.items()}
    return [session.declare_subscriber(f"{prefix}/{key}", call) for key, call in calls.items()]


def relay(
    given: argparse.Namespace,
    heard: Mapping[str, Callable[[bytes], None]],
    heard_raw: Mapping[str, Callable[[bytes, bytes], None]] | None = None,
    feed: Callable[[Publish], None] | None = None,
    missing: Callable[[], str | None] | None = None,
    told: Mapping[str, Callable[[list[bytes]], None]] | None = None,
) -> None:
    """Call functions with the messages of a run until the run is over.

    Parameters
    ----------
    given
        What the parser of `options` returned.
    heard
        Called with each message, by the pattern of its key below the run, such as ``adsb/*``; on a
        thread of Zenoh.
    heard_raw
        Called with the header and the bytes of each message on keys whose payload is raw bytes.
    feed
        Called once, on a thread of its own, with what publishes messages in the run; the program
        then joins it as an operator.
    missing
        Called once, `SILENCE_S` after the run is found; returns what is then told as missing.
    told
        Called once, before all others, with the messages that the run keeps on a key.

    Raises
    ------
    BusError
        There is no run at the endpoint, or there are several and none is named; or it does not let
        this program in; or ``feed`` failed.
    """
    role: Role = "observer" if feed is None else "operator"
    session = connect_client(given.connect, PATIENCE_S, given.tls, role)

    try:
        prefix = find_run(session, PATIENCE_S, given.run)
    except BusError:
        close_session(session)
        raise
    for key, take in (told or {}).items():
        replies = session.get(f"{prefix}/{key}", timeout=1.0)
        take([reply.ok.payload.to_bytes() for reply in replies if reply.ok is not None])
    subscribers = _subscribed(session, prefix, heard, heard_raw or {})
    if missing is not None:
        late = threading.Timer(SILENCE_S, lambda: tell(missing()))
        late.daemon = True
        late.start()
    news: queue.SimpleQueue[bool | None] = queue.SimpleQueue()
    failures: list[Exception] = []

    def run_feed(feed: Callable[[Publish], None]) -> None:
        try:
            feed(_publishing(session, prefix))
        except Exception as error:
            failures.append(error)
            news.put(None)

    if feed is not None:
        threading.Thread(target=run_feed, args=(feed,), daemon=True).start()
    with contextlib.suppress(KeyboardInterrupt):
        wait_until_over(session, prefix, news)
    for subscriber in subscribers:
        subscriber.undeclare()  # type: ignore[no-untyped-call]
    close_session(session)
    for error in failures:
        raise BusError(f"the feed failed: {first_line(error)}")


def tell(text: str | None) -> None:
    """Print a line for the user, if there is one."""
    if text is not None:
        sys.stderr.write(f"{text}\n")


def _publishing(session: zenoh.Session, prefix: str) -> Publish:
    """Return what publishes messages on the keys of a run."""

    def publish(key: str, message: Message) -> None:
        session.put(
            f"{prefix}/{key}",
            message.model_dump_json(),
            congestion_control=zenoh.CongestionControl.BLOCK,
        )

    return publish


@contextlib.contextmanager
def exiting_on_error() -> Iterator[None]:
    """Print an `AirhiltError` as one line and exit with its code."""
    try:
        yield
    except AirhiltError as error:
        sys.stderr.write(f"error: {error}\n")
        sys.exit(error.exit_code)


def serve_reports(
    documentation: str | None, port: int, encode: Callable[[AdsbReport], bytes]
) -> None:
    """Run a bridge that gives out the ADS-B reports of a run over TCP until the run is over.

    Parameters
    ----------
    documentation
        Docstring of the bridge.
    port
        Default of the port on which it listens.
    encode
        Returns what a report becomes.
    """
    parser = options(documentation, port)
    add_host(parser)
    parser.add_argument(
        "--to", metavar="HOST:PORT", help="connect to a program that listens there, and not listen"
    )
    given = parser.parse_args()
    with exiting_on_error():
        feed = Feed()
        if given.to is None:
            feed.listen(given.port, given.host)
        else:
            feed.connect(given.to)
        relay(
            given,
            {"adsb/*": lambda data: feed.send(encode(AdsbReport.model_validate_json(data)))},
        )
        feed.close()


def feed_reports(
    documentation: str | None, port: int, decode: Callable[[bytes], Iterable[LiveReport]]
) -> None:
    """Run a bridge that gives the targets of a receiver to a run, until the run is over.

    Parameters
    ----------
    documentation
        Docstring of the bridge.
    port
        Default of the port of the receiver.
    decode
        Returns the reports in the next bytes of the receiver.
    """
    parser = options(documentation, port, "operator")
    parser.add_argument(
        "--from", dest="host", default="127.0.0.1", metavar="HOST", help="default: 127.0.0.1"
    )
    given = parser.parse_args()

    def feed(publish: Publish) -> None:
        for connection in connections(given.host, given.port):
            with contextlib.suppress(OSError), connection:
                while data := connection.recv(READ_BYTES):
                    for report in decode(data):
                        publish(f"live/{report.icao24}", report)

    with exiting_on_error():
        address_of(given.host, given.port, "--from and --port")
        relay(given, {}, feed=feed)


class Address(NamedTuple):
    """A place to which a socket of a family can send or connect."""

    family: int
    address: tuple[Any, ...]


def address_of(host: str, port: int, named_by: str) -> Address:
    """Return the address of a host and a port, which were given by some options.

    Raises
    ------
    BusError
        There is no such host or port.
    """
    place = f"{host}:{port}; see {named_by}"
    if not 0 < port < 2**16:
        raise BusError(f"no port {place}; expected a port from 1 to 65535")
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port)[0]
    except (OSError, UnicodeError) as error:
        raise BusError(f"no host {place}: {error}") from None
    return Address(family, address)


def connections(host: str, port: int) -> Iterator[socket.socket]:
    """Yield a connection with a program, and another one whenever the last has ended.

    The first failure is told.
    """
    is_told = False
    while True:
        try:
            connection = socket.create_connection((host, port))
        except OSError as error:
            if not is_told:
                tell(f"nothing answers at {host}:{port}: {error}; trying on")
            is_told = True
        else:
            yield connection
        time.sleep(RETRY_S)


def datagrams(host: str, port: int, named_by: str = "--to and --port") -> Callable[[bytes], None]:
    """Return what sends UDP datagrams to a host, or to all hosts at a broadcast address.

    Nobody has to listen there: what cannot be sent is lost.

    Raises
    ------
    BusError
        There is no such host or port.
    """
    family, address = address_of(host, port, named_by)
    sender = socket.socket(family, socket.SOCK_DGRAM)
    sender.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
    sender.setblocking(False)

    def send(data: bytes) -> None:
        with contextlib.suppress(OSError):
            sender.sendto(data, address)

    return send


class WallClock:
    """Gives times of a run as times of day, as if the first of them were now."""

    def __init__(self) -> None:
        self._epoch: datetime | None = None

    def at(self, t_ns: int) -> datetime:
        """Return a time of the run, in ns, as a time of day in UTC."""
        if self._epoch is None:
            self._epoch = datetime.now(UTC) - timedelta(seconds=t_ns / SECOND_NS)
        return self._epoch + timedelta(seconds=t_ns / SECOND_NS)


class Client(NamedTuple):
    """A connected program, and what waits for it; None is the end."""

    connection: socket.socket
    waiting: queue.Queue[bytes | None]
    thread: threading.Thread


class Feed:
    """Sends bytes to every connected program; one that falls behind is let go.

    Attributes
    ----------
    clients
        The connected programs.
    """

    def __init__(self) -> None:
        self.clients: list[Client] = []

    def listen(self, port: int, host: str = LOOPBACK) -> None:
        """Accept programs on a port of an address; raise `BusError` if it is taken."""
        try:
            server = socket.create_server((host, port))
        except (OSError, OverflowError, UnicodeError) as error:
            raise BusError(
                f"cannot listen on {host}:{port}: {error}; choose another port with --port, or "
                "address with --host"
            ) from None
        threading.Thread(target=self._accept, args=(server,), daemon=True).start()

    def connect(self, address: str) -> None:
        """Connect to a program that listens at ``HOST:PORT``, again whenever it goes."""
        host, _, port = address.rpartition(":")
        if not (host and port.isdecimal()):
            raise BusError(f"--to {address!r}: expected HOST:PORT, such as 127.0.0.1:30004")
        target = host, int(port)
        address_of(*target, "--to")
        threading.Thread(target=self._keep_connected, args=(target,), daemon=True).start()

    def send(self, data: bytes) -> None:
        """Queue bytes for all clients."""
        for client in list(self.clients):
            try:
                client.waiting.put_nowait(data)
            except queue.Full:
                self._let_go(client)

    def close(self) -> None:
        """Let clients take what waits for them, for a moment, and disconnect them."""
        deadline = time.monotonic() + LAST_S
        clients = list(self.clients)
        for client in clients:
            with contextlib.suppress(queue.Full):
                client.waiting.put_nowait(None)
        for client in clients:
            client.thread.join(max(deadline - time.monotonic(), 0.0))

    def _accept(self, server: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while True:
                self._admit(server.accept()[0])

    def _keep_connected(self, target: tuple[str, int]) -> None:
        for connection in connections(*target):
            self._admit(connection).join()

    def _admit(self, connection: socket.socket) -> threading.Thread:
        """Serve a client on a thread of its own."""
        waiting: queue.Queue[bytes | None] = queue.Queue(WAITING)
        thread = threading.Thread(target=lambda: self._serve(client), daemon=True)
        client = Client(connection, waiting, thread)
        self.clients.append(client)
        thread.start()
        return thread

    def _serve(self, client: Client) -> None:
        with contextlib.suppress(OSError), client.connection:
            while (data := client.waiting.get()) is not None:
                client.connection.sendall(data)
        self._let_go(client)

    def _let_go(self, client: Client) -> None:
        """Forget a client, and end whatever still sends to it."""
        with contextlib.suppress(OSError):
            client.connection.shutdown(socket.SHUT_RDWR)
        with contextlib.suppress(ValueError):
            self.clients.remove(client)
