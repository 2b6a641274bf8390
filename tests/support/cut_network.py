"""A network that can be cut: nothing passes any more, and no connection ends because of it."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from urllib.parse import urlsplit

from devtools import Page


class Network:
    """Passes on connections to a port of this machine while it is not cut."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._passes = threading.Event()
        self._passes.set()
        self._is_over = False
        self._sockets: list[socket.socket] = []
        self._forgotten: list[socket.socket] = []
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.port = self._listening.getsockname()[1]
        self._accepting = threading.Thread(target=self._accept, daemon=True)
        self._accepting.start()

    def cut(self) -> None:
        """Let nothing pass; who sends something gets no error."""
        self._passes.clear()

    def mend(self) -> None:
        """Let everything pass again, also what was sent meanwhile."""
        self._passes.set()

    def forget(self) -> None:
        """Let nothing pass any more over the connections that there are; they do not end either."""
        self._forgotten = list(self._sockets)

    def close(self) -> None:
        """End all connections."""
        self._is_over = True
        self._passes.set()
        _end(self._listening)
        self._accepting.join()  # Before the connections end: it may be about to open another one.
        for one in self._sockets:
            _end(one)

    def _accept(self) -> None:
        with suppress(OSError):
            while not self._is_over:
                near, _ = self._listening.accept()
                self._sockets.append(near)
                self._passes.wait()
                far = socket.create_connection(("127.0.0.1", self._port))
                self._sockets.append(far)
                for from_, to in ((near, far), (far, near)):
                    threading.Thread(target=self._pass, args=(from_, to), daemon=True).start()

    def _pass(self, from_: socket.socket, to: socket.socket) -> None:
        with suppress(OSError):
            while data := from_.recv(1 << 16):
                self._passes.wait()
                if from_ not in self._forgotten:
                    to.sendall(data)
        self._passes.wait()
        with suppress(OSError):
            if from_ not in self._forgotten:
                to.shutdown(socket.SHUT_WR)


def _end(one: socket.socket) -> None:
    with suppress(OSError):
        one.shutdown(socket.SHUT_RDWR)
    one.close()


def forgive(page: Page) -> None:
    """Take away the complaints of the browser about connections that cannot be opened."""
    known = ("before the connection", "CONNECTION_REFUSED")
    page.complaints[:] = [one for one in page.complaints if not any(text in one for text in known)]


@contextmanager
def through_network(url: str) -> Iterator[tuple[Network, str]]:
    """Yield a network to a server, and the URL of the server through it."""
    place = urlsplit(url)
    assert place.port is not None
    network = Network(place.port)
    try:
        yield network, url.replace(f":{place.port}", f":{network.port}")
    finally:
        network.close()
