"""Endpoints of Zenoh, such as ``tcp/127.0.0.1:7447``: which of them other machines can reach."""

from __future__ import annotations

import ipaddress
import re
import socket

from airhilt.bus.access import PUBLISHED
from airhilt.errors import BusError, shown

ENDPOINT = re.compile(r"(?P<protocol>[a-z-]+)/(?P<host>\[[^\]]*\]|[^:/?#]*):(?P<port>\d+)([?#].*)?")
"""Protocol, host and port; Zenoh reads metadata and settings after ``?`` and ``#``."""
AUTHENTICATED = ("tls", "quic")
"""Protocols that ask a program for its certificate."""
CONNECTED = ("tcp", "tls", "ws")
"""Protocols in which a connection is made before anything else."""
LOCAL = ("unixsock-stream", "unixpipe")
"""Protocols that reach no other machine."""


def host_of(endpoint: str) -> str | None:
    """Return the host of an endpoint, None if it has none."""
    found = ENDPOINT.fullmatch(endpoint)
    return found["host"].strip("[]") if found and found["host"] else None


def is_taken(endpoint: str, patience_s: float = 1.0) -> bool:
    """Return true if something accepts connections there; false also for a protocol without any."""
    found = ENDPOINT.fullmatch(endpoint)
    if found is None or found["protocol"] not in CONNECTED:
        return False
    try:
        address = found["host"].strip("[]"), int(found["port"])
        socket.create_connection(address, patience_s).close()
    except (OSError, ValueError, OverflowError):
        return False
    return True


def is_loopback(endpoint: str) -> bool:
    """Return true if no other machine can reach an endpoint; false where that is not certain."""
    if protocol_of(endpoint) in LOCAL:
        return True
    host = host_of(endpoint)
    if host is None or host == "localhost":
        return host is not None
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def protocol_of(endpoint: str) -> str:
    """Return the protocol of an endpoint."""
    return endpoint.partition("/")[0]


def require_authenticated(endpoint: str, has_keys: bool, insecure: bool) -> None:
    """Refuse an endpoint at which programs of other machines need not say who they are.

    Raises
    ------
    BusError
        It is one, and `insecure` is false; the keys and the protocol do not go together; or it is
        no endpoint.
    """
    if ENDPOINT.fullmatch(endpoint) is None and protocol_of(endpoint) not in LOCAL:
        raise BusError(f"endpoint {shown(endpoint)}: expected the form tcp/127.0.0.1:7447")
    if has_keys and protocol_of(endpoint) not in AUTHENTICATED:
        raise BusError(
            f"endpoint {shown(endpoint)}: --tls needs a protocol with certificates; expected the "
            "form tls/127.0.0.1:7447"
        )
    if has_keys and insecure:
        raise BusError("--insecure would do nothing with --tls; expected only one of the two")
    if not has_keys and protocol_of(endpoint) in AUTHENTICATED:
        raise BusError(
            f"endpoint {shown(endpoint)}: its protocol needs certificates; make them with "
            "`airhilt keys init DIR`, and give --tls DIR"
        )
    if not has_keys and not insecure and not is_loopback(endpoint):
        raise BusError(
            f"endpoint {shown(endpoint)}: other machines can reach it, and no program would have "
            "to say who it is; make keys with `airhilt keys init DIR` and give --tls DIR, or let "
            "everybody do everything with --insecure"
        )


def what_is_open(endpoint: str, shares_truth: bool) -> str:
    """Return in a sentence what every program can do that reaches an endpoint without keys."""
    truth = " and the truth" if shares_truth else ""
    keys = ", ".join(
        key for keys in PUBLISHED.values() for key in keys if not key.startswith("tts")
    )
    return (
        f"--insecure: whoever reaches {endpoint} can read all sensors and advisories{truth}, "
        f"attach workers, and publish on {keys}: commands move aircraft. Nothing is encrypted"
    )
