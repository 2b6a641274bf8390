"""Where a station may be opened."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from airhilt.errors import StationError
from airhilt.station.address import Address

FILES: dict[str, Any] = {"certificate": Path("cert.pem"), "key": Path("key.pem")}
TOKEN = "correct horse battery"


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "localhost", "127.9.9.9"])
def test_loopback_needs_neither_tls_nor_a_token(host: str) -> None:
    assert Address(host).is_loopback


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.7", "sim.example.org"])
@pytest.mark.parametrize("given", [{}, FILES, {"token": TOKEN}], ids=["nothing", "TLS", "token"])
def test_another_address_is_refused_without_tls_and_a_token(
    host: str, given: dict[str, Any]
) -> None:
    with pytest.raises(StationError, match=r"other machines can reach it; .*--token-file"):
        Address(host, **given)


def test_another_address_is_taken_with_tls_and_a_token() -> None:
    address = Address("192.168.1.7", **FILES, token=TOKEN)
    assert address.url(8420) == "https://192.168.1.7:8420/?token=correct%20horse%20battery"


def test_a_short_token_is_refused() -> None:
    with pytest.raises(StationError, match="5 characters; expected at least 16"):
        Address("192.168.1.7", **FILES, token="hello")


def test_a_certificate_without_its_key_is_refused() -> None:
    with pytest.raises(StationError, match="only one is given"):
        Address(certificate=Path("cert.pem"))


def test_a_port_that_is_taken_is_named() -> None:
    with Address(port=0).bound() as listening:
        port = listening.getsockname()[1]
        with pytest.raises(StationError, match=rf"127.0.0.1:{port}: .* another port with --port"):
            Address(port=port).bound()
