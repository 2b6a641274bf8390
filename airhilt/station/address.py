"""The address of a station, and what it must have before other machines may reach it."""

from __future__ import annotations

import ipaddress
import socket
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from airhilt.errors import StationError

DEFAULT_HOST = "127.0.0.1"
DEFAULT_PORT = 8420
LOOPBACK_NAMES = ("127.0.0.1", "::1", "localhost")
"""Names of this machine that a browser on it may use."""
ANY_HOST = ("0.0.0.0", "::")  # noqa: S104 - compared with, not bound
"""Addresses that stand for all interfaces."""
LEAST_TOKEN = 16
"""Least length of a token, in characters."""


@dataclass(frozen=True)
class Address:
    """Where a station listens, and who may come in.

    Attributes
    ----------
    host
        Name or IP address to listen at.
    port
        TCP port.
    certificate, key
        PEM files for TLS, both or none.
    token
        Secret that a browser must have; empty: none is needed.

    Raises
    ------
    StationError
        Other machines can reach it without TLS and a token, only one of the two files is given, or
        the token is short.
    """

    host: str = DEFAULT_HOST
    port: int = DEFAULT_PORT
    certificate: Path | None = None
    key: Path | None = None
    token: str = ""

    def __post_init__(self) -> None:
        if (self.certificate is None) != (self.key is None):
            raise StationError(
                "--certificate, --key: only one is given; expected both files, or none"
            )
        if self.token and len(self.token) < LEAST_TOKEN:
            raise StationError(
                f"--token-file: the token has {len(self.token)} characters; expected at least "
                f"{LEAST_TOKEN}"
            )
        if not self.is_loopback and not (self.certificate and self.token):
            raise StationError(
                f"--host {self.host}: other machines can reach it; expected 127.0.0.1, or TLS and "
                "a token as well: --certificate FILE --key FILE --token-file FILE"
            )

    @property
    def is_loopback(self) -> bool:
        """True if no other machine can reach it."""
        if self.host == "localhost":
            return True
        try:
            return ipaddress.ip_address(self.host).is_loopback
        except ValueError:
            return False

    @property
    def scheme(self) -> str:
        """Scheme of its URL."""
        return "https" if self.certificate else "http"

    def url(self, port: int) -> str:
        """Return the URL to open in a browser on this machine, with the token if there is one.

        Parameters
        ----------
        port
            Port that is really listened at: the system chooses one for port 0.
        """
        host = self.host
        if host in ANY_HOST:
            host = socket.gethostname()
        place = f"[{host}]" if ":" in host else host
        token = f"?token={quote(self.token)}" if self.token else ""
        return f"{self.scheme}://{place}:{port}/{token}"

    def knows(self, host: str) -> bool:
        """Return true if a browser may call the station by this name.

        A name that is not its own comes from a page that has let its name lead here (DNS
        rebinding). With all interfaces any name is good: the token is asked for.
        """
        if self.host in ANY_HOST:
            return bool(host)
        return host == self.host.lower() or (self.is_loopback and host in LOOPBACK_NAMES)

    def bound(self) -> socket.socket:
        """Return a socket that listens at the address.

        Raises
        ------
        StationError
            The port is taken, or the address is not of this machine.
        """
        try:
            found = socket.getaddrinfo(self.host, self.port, type=socket.SOCK_STREAM)
            family, kind, protocol, _, place = found[0]
            listening = socket.socket(family, kind, protocol)
            try:
                listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                listening.bind(place)
                listening.listen(128)
            except BaseException:
                listening.close()
                raise
        except OSError as error:
            raise StationError(
                f"{self.host}:{self.port}: cannot be listened at: {error.strerror}; choose another "
                "port with --port"
            ) from None
        return listening
