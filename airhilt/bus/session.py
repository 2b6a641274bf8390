"""The run's own Zenoh session: a router on loopback that workers and viewers connect to."""

from __future__ import annotations

import json
import os
import queue
import random
import re
import socket
import threading
import time
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

import zenoh

from airhilt.bus.access import BY_CERTIFICATE, HOLDERS, WITHOUT_KEYS, Role, Subjects, access_control
from airhilt.bus.closed import Answer, ClosedBus
from airhilt.bus.endpoints import is_taken, require_authenticated
from airhilt.bus.intake import Source, size_filter
from airhilt.errors import BusError, RendererError
from airhilt.messages import Clock
from airhilt.sim.payload import Payload

if TYPE_CHECKING:
    from airhilt.bus.certificates import Holder, Keys

ROOT = "airhilt"
"""First chunk of every key; the second is the run."""
RETRY_S = 0.2
"""Time between two attempts to connect, in s."""
SERVER_PORTS = range(20_000, 32_000)
"""Ports below those that systems give to outgoing connections: Linux from 32,768, others from
49,152 (RFC 6335, section 6)."""

LARGEST_BYTES = 128_000_000
"""Size in bytes above which Zenoh drops any message, such as the reply of a worker."""
RECEIVED = 4
"""Number of messages that Zenoh keeps for one subscription; while there is no room for another, it
lets the senders wait."""
RETURNS_S = 5.0
"""Wall time in s in which a program or a run may come back to a router between them."""
CLOSING_S = 1.0
"""Wall time in s that a program waits for its session to close. Zenoh itself waits for 10 s for a
connected program that does not read, and then fails."""

IN_USE = "Address already in use"
"""Text in the error of Zenoh where another program has the port."""
SHARED_MEMORY = "POSIX shm"
"""Text in the error of Zenoh where a segment of shared memory cannot be made."""
SHARED_MEMORY_FOLDER = "/dev/shm"  # noqa: S108
"""Folder in which Linux keeps segments of shared memory."""
SOURCE_POSITION = re.compile(r" at \S+\.rs:\d+\.?")
"""Place in the source of Zenoh that an error names."""


def free_endpoint() -> str:
    """Return a loopback endpoint on a port that is free at this moment.

    Outgoing connections get none of these ports, where the system keeps to these ranges: so no
    other program is given it before the run listens, and nothing that waits for the run connects
    to itself.
    """
    for port in random.sample(SERVER_PORTS, len(SERVER_PORTS)):
        with socket.socket() as probe, suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return f"tcp/127.0.0.1:{port}"
    raise BusError(f"no port from {SERVER_PORTS.start} to {SERVER_PORTS.stop - 1} is free")


def configuration(
    mode: Literal["router", "client"],
    kind: Literal["listen", "connect"],
    endpoint: str,
    more: Mapping[str, Any] = MappingProxyType({}),
) -> zenoh.Config:
    """Return a configuration with one explicit endpoint, no discovery, and ``more`` settings."""
    config = zenoh.Config()
    settings: dict[str, Any] = {
        "mode": mode,
        f"{kind}/endpoints": [endpoint],
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "scouting/delay": 0,
        **more,
    }
    if mode == "client":
        settings["connect/timeout_ms"] = 5000
        settings["connect/exit_on_failure"] = True
    for key, value in settings.items():
        try:
            config.insert_json5(key, json.dumps(value))
        except zenoh.ZError:
            raise BusError(f"endpoint {endpoint!r}: expected the form tcp/127.0.0.1:7447") from None
    return config


_opened_by: set[int] = set()
"""Ids of this process, and of those that it was forked from, that have opened a session."""


def _opened(config: zenoh.Config) -> zenoh.Session:
    """Return a session. The threads of Zenoh are not in a fork, where it would wait for ever."""
    if _opened_by - {os.getpid()}:
        raise BusError(
            "this process was forked from one that has had a run or a client on the bus, and has "
            "not the threads of its bus; expected another way to start it: "
            "multiprocessing.get_context('spawn')"
        )
    session = zenoh.open(config)
    _opened_by.add(os.getpid())
    return session


def connect_client(
    endpoint: str | None, patience_s: float, tls: Path | None = None, role: Role = "worker"
) -> zenoh.Session:
    """Return a session with the run at an endpoint, waiting for it to come up.

    Parameters
    ----------
    endpoint
        Where the run accepts connections; None: where the keys say.
    tls
        Folder with the keys of the role; None: the run asks for none.

    Raises
    ------
    BusError
        Nothing listens there in time or lets this program in, the keys are none, or Zenoh cannot
        make its shared memory.
    """
    keys = _keys(tls, role)
    if endpoint is None and keys is not None:
        endpoint = keys.endpoint
    if endpoint is None:
        raise BusError("no endpoint of a run; expected one, such as tcp/127.0.0.1:7447, or keys")
    require_authenticated(endpoint, keys is not None, insecure=keys is None)
    config = configuration("client", "connect", endpoint, keys.settings if keys else {})
    deadline = time.monotonic() + patience_s
    while True:
        try:
            return _opened(config)
        except zenoh.ZError as error:
            _require_shared_memory(error)
            if time.monotonic() > deadline:
                if is_taken(endpoint):
                    expected = (
                        "the keys of the run" if keys else "the run's own keys with --tls, if any"
                    )
                    raise BusError(
                        f"what listens on {endpoint} does not let this program in: it is no run, "
                        f"or one with other keys; expected {expected} (Zenoh: {_reason(error)})"
                    ) from None
                raise BusError(
                    f"nothing listens on {endpoint} after {patience_s:g} s; start the run first: "
                    f"airhilt cosim --scenario NAME --endpoint {endpoint} (Zenoh: {_reason(error)})"
                ) from None
            time.sleep(RETRY_S)


def _keys(folder: Path | None, holder: Holder) -> Keys | None:
    if folder is None:
        return None
    # Not at the top: a run without keys starts without the library behind them.
    from airhilt.bus.certificates import read_keys

    return read_keys(folder, holder)


def find_run(session: zenoh.Session, patience_s: float, run: str | None = None) -> str:
    """Return the beginning of the keys of the run that answers at the endpoint of a session.

    Parameters
    ----------
    run
        Name of the run; None: there is one only.

    Raises
    ------
    BusError
        None answers in time, or several do.
    """
    deadline = time.monotonic() + patience_s
    while time.monotonic() < deadline:
        replies = session.get(f"{ROOT}/{run or '*'}/clock", timeout=1.0)
        found = {str(each.ok.key_expr).split("/")[1] for each in replies if each.ok is not None}
        if len(found) > 1:
            raise BusError(
                f"several runs answer at the endpoint: {', '.join(sorted(found))}; expected the "
                "name of one, with --run"
            )
        if found:
            return f"{ROOT}/{found.pop()}"
        time.sleep(0.1)
    named = "" if run is None else f" {run!r}"
    raise BusError(f"no run{named} answers at the endpoint after {patience_s:g} s")


def wait_until_over(
    session: zenoh.Session, prefix: str, news: queue.SimpleQueue[bool | None] | None = None
) -> None:
    """Wait until a run says that it is over, or has been out of reach for `RETURNS_S`.

    Parameters
    ----------
    prefix
        Beginning of its keys.
    news
        A queue in which None ends the wait too.
    """
    news = news or queue.SimpleQueue()

    def hear_clock(sample: zenoh.Sample) -> None:
        clock = Clock.model_validate_json(sample.payload.to_bytes())
        if clock.phase in ("finished", "stopped"):
            news.put(None)

    kept: list[Any] = [
        session.declare_subscriber(f"{prefix}/clock", hear_clock),
        session.liveliness().declare_subscriber(
            f"{prefix}/run", lambda each: news.put(each.kind == zenoh.SampleKind.PUT), history=True
        ),
    ]
    is_there: bool | None = True
    while is_there is not None:
        try:
            is_there = news.get(timeout=None if is_there else RETURNS_S)
        except queue.Empty:
            break
    for subscriber in kept:
        subscriber.undeclare()


class Bus(ClosedBus):
    """The session of a run: publishes under ``airhilt/<run>/`` and hears what others publish there.

    Parameters
    ----------
    run
        Name of the run, one key chunk.
    endpoint
        Endpoint at which to accept connections; None takes a free loopback port.
    anyone
        Roles of every program that connects, where there are no keys.
    tls
        Folder with the keys of the run: each program has the role of its certificate.
    insecure
        True if programs of other machines may connect without keys.

    Raises
    ------
    BusError
        The endpoint is malformed, in use, or open to other machines without keys; the keys are
        none; or Zenoh cannot make its shared memory.
    """

    def __init__(
        self,
        run: str,
        endpoint: str | None = None,
        *,
        anyone: Collection[Role] = WITHOUT_KEYS,
        tls: Path | None = None,
        insecure: bool = False,
    ) -> None:
        keys = _keys(tls, "router")
        super().__init__(run, endpoint or (keys.endpoint if keys else free_endpoint()))
        self.prefix = f"{ROOT}/{run}"
        self.tls = tls
        require_authenticated(self.endpoint, keys is not None, insecure)
        subjects: Subjects = BY_CERTIFICATE if keys else {None: anyone}
        settings = {
            "access_control": access_control(ROOT, run, subjects),
            "low_pass_filter": size_filter(self.prefix),
            "transport/link/rx/max_message_size": LARGEST_BYTES,
        }
        settings |= keys.settings if keys else {}
        try:
            self.session = _opened(configuration("router", "listen", self.endpoint, settings))
        except zenoh.ZError as error:
            _require_shared_memory(error)
            advice = (
                "another program has the port: choose another with --endpoint, or leave it out for "
                "a free one"
                if IN_USE in str(error)
                else "expected a free port of this machine, such as tcp/127.0.0.1:7447"
            )
            raise BusError(
                f"cannot listen on {self.endpoint}: {_reason(error)}; {advice}"
            ) from None
        self._publishers: dict[str, zenoh.Publisher] = {}
        self._latest: dict[str, bytes] = {}
        self._hearing: list[tuple[Any, threading.Thread]] = []
        self._kept: list[Any] = [self.session.liveliness().declare_token(f"{self.prefix}/run")]

    def put(self, key: str, payload: Payload, attachment: bytes | None = None) -> None:
        """Publish to other processes under a key relative to the run.

        A deferred payload is made only if somebody has subscribed to the key. One that cannot be
        made is not published: whoever should have made it tells that.
        """
        publisher = self._publishers.get(key)
        if publisher is None:
            publisher = self.session.declare_publisher(
                f"{self.prefix}/{key}", allowed_destination=zenoh.Locality.REMOTE
            )
            self._publishers[key] = publisher
        if isinstance(payload, bytes):
            publisher.put(payload, attachment=attachment)
        # The status is an object that Zenoh's stubs call a bool.
        elif publisher.matching_status.matching:  # type: ignore[attr-defined]
            with suppress(RendererError):
                publisher.put(bytes(payload), attachment=attachment)

    def keep(self, key: str, payload: bytes) -> None:
        """Publish, and answer later queries on the key with the payload kept last."""
        if key not in self._latest:
            self._kept.append(self.session.declare_queryable(f"{self.prefix}/{key}", self._reply))
        self._latest[key] = payload
        self.put(key, payload)

    def _reply(self, query: zenoh.Query) -> None:
        with query:
            for key, payload in self._latest.items():
                name = f"{self.prefix}/{key}"
                if query.key_expr.intersects(zenoh.KeyExpr(name)):
                    query.reply(name, payload)

    def hear(
        self,
        pattern: str,
        heard: Callable[[str, bytes], None],
        admit: Callable[[int, Source | None], bool] = lambda _size, _source: True,
    ) -> None:
        """Call ``heard`` with key (relative to the run) and payload of what others publish.

        Parameters
        ----------
        heard
            Runs on a thread of its own, as ``admit`` does.
        admit
            Says, of the size of a message and the number that its sender gave it, if it is heard.
        """
        subscriber = self.session.declare_subscriber(
            f"{self.prefix}/{pattern}",
            zenoh.handlers.FifoChannel(RECEIVED),
            allowed_origin=zenoh.Locality.REMOTE,
        )

        def take(sample: zenoh.Sample) -> None:
            size = len(sample.payload) + len(sample.attachment or b"")
            if admit(size, _source(sample)):
                heard(str(sample.key_expr)[len(self.prefix) + 1 :], sample.payload.to_bytes())

        self._receive(pattern, subscriber, take)

    def _receive(self, pattern: str, subscriber: Any, take: Callable[[Any], None]) -> None:
        """Call ``take`` with each sample or query, on a thread that ends with the subscriber.

        A callback of Zenoh's own would not do: it keeps what it calls after the session is closed.
        """

        def receive() -> None:
            for sample in subscriber:
                take(sample)

        thread = threading.Thread(target=receive, name=f"hear {pattern}", daemon=True)
        thread.start()
        self._hearing.append((subscriber, thread))

    @property
    def returns_s(self) -> float:
        """Wall time in s in which a program may come back: 0 unless a router is connected."""
        return RETURNS_S if self.session.info.routers_zid() else 0.0

    def is_alive(self, key: str) -> bool:
        """Return whether a liveliness token is declared now; the key is relative to the run."""
        tokens = self.session.liveliness().get(f"{self.prefix}/{key}")
        return any(reply.ok is not None for reply in tokens)

    def watch_workers(self, changed: Callable[[str, bool], None]) -> None:
        """Call ``changed`` with a worker's name and whether it is there (on another thread)."""
        self._watch("worker/*", lambda key, is_there: changed(key.rpartition("/")[2], is_there))

    def watch_holders(self, ended: Callable[[str, str], None]) -> None:
        """Call ``ended`` with the key of a seat and a holder whose token of it has ended.

        It is called on another thread.
        """

        def end(key: str, is_there: bool) -> None:
            if not is_there:
                seat_key, _, holder = key.partition("/holder/")
                ended(seat_key, holder)

        self._watch(HOLDERS, end)

    def has_holder(self, seat_key: str, holder: str) -> bool:
        """Return whether the liveliness token of a holder is declared now."""
        return self.is_alive(f"{seat_key}/holder/{holder}")

    def answer(self, pattern: str, asked: Callable[[str, bytes, Answer], None]) -> None:
        """Call ``asked`` with key (relative to the run), payload and answer of each query.

        It runs on a thread of its own. The answer is called once, on any thread.
        """
        queryable = self.session.declare_queryable(
            f"{self.prefix}/{pattern}", zenoh.handlers.FifoChannel(RECEIVED)
        )

        def take(query: zenoh.Query) -> None:
            key = str(query.key_expr)
            payload = b"" if query.payload is None else query.payload.to_bytes()

            def answer(data: bytes) -> None:
                with query:
                    query.reply(key, data)

            asked(key[len(self.prefix) + 1 :], payload, answer)

        self._receive(pattern, queryable, take)

    def _watch(self, pattern: str, changed: Callable[[str, bool], None]) -> None:
        """Call ``changed`` with the key of a liveliness token, and whether it is there."""

        def notice(sample: zenoh.Sample) -> None:
            key = str(sample.key_expr)[len(self.prefix) + 1 :]
            changed(key, sample.kind == zenoh.SampleKind.PUT)

        subscriber = self.session.liveliness().declare_subscriber(
            f"{self.prefix}/{pattern}", zenoh.handlers.FifoChannel(RECEIVED), history=True
        )
        self._receive(pattern, subscriber, notice)

    def close(self) -> None:
        """Close the session; the liveliness token of the run goes with it, so workers notice.

        What was declared goes first, and the session itself last: Zenoh 1.10 keeps the shared
        memory and a file descriptor of a session whose publishers still exist when it is closed
        as long as the process lives, and those of any other as long as the object does.

        A program that does not read does not hold up the end of the run.
        """
        for publisher in self._publishers.values():
            publisher.undeclare()  # type: ignore[no-untyped-call]
        for subscriber, thread in self._hearing:
            subscriber.undeclare()
            thread.join()
        self._hearing.clear()
        super().close()
        self._publishers.clear()
        self._kept.clear()
        session = self.session
        del self.session
        close_session(session)


def close_session(session: zenoh.Session) -> None:
    """Close a session; if the other end does not read, it goes on closing by itself."""

    def close() -> None:
        with suppress(zenoh.ZError):  # Of a connected program that never reads.
            session.close()  # type: ignore[no-untyped-call]

    closing = threading.Thread(target=close, daemon=True)
    closing.start()
    closing.join(CLOSING_S)


def _source(sample: zenoh.Sample) -> Source | None:
    info = sample.source_info
    if info is None:
        return None
    return Source(f"{info.source_id.zid}/{info.source_id.eid}", info.source_sn)


def _require_shared_memory(error: zenoh.ZError) -> None:
    """Complain if a session cannot be opened for want of shared memory, whatever the endpoint."""
    if SHARED_MEMORY in str(error):
        raise BusError(
            f"Zenoh cannot make its shared memory in {SHARED_MEMORY_FOLDER}: {_reason(error)}; "
            f"{SHARED_MEMORY_FOLDER} must be writable and have room (in a container: --shm-size)"
        ) from None


def _reason(error: zenoh.ZError) -> str:
    """Return the text of a ZError without its source positions."""
    return SOURCE_POSITION.sub("", str(error)).strip() or "refused"
