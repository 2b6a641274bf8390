"""Certificates of the programs that meet at a run: one a role, of a small authority of their own.

A folder of keys has a file for each role, and one for the run. Each is a whole configuration of
Zenoh: endpoint, certificates and private key. The key of the authority is thrown away, so nobody
can make more certificates that the run would accept.
"""

from __future__ import annotations

import base64
import ipaddress
import json
import stat
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, Literal

from cryptography import x509
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.hashes import SHA256
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from airhilt.bus.access import CERTIFICATE_NAME, ROLES, Role
from airhilt.bus.endpoints import AUTHENTICATED, host_of, protocol_of
from airhilt.errors import BusError
from airhilt.host import bounded_json
from airhilt.host.files import is_of_owner_alone, read_file, write_new

Holder = Role | Literal["router"]
"""Whose a file is: a program of a role, or the run, whose session is a router of Zenoh."""
HOLDERS: tuple[Holder, ...] = ("router", *ROLES)
VALID_FOR = timedelta(days=730)
SKEW = timedelta(hours=1)
"""Time before now from which a certificate is valid, for machines whose clocks differ."""
SETTING = "transport/link/tls"
"""Place of the certificates in the configuration of Zenoh."""


@dataclass(frozen=True)
class Keys:
    """Content of the file of a role, or of the run: its endpoint, and settings of Zenoh by key."""

    endpoint: str
    settings: dict[str, Any]


def key_file(folder: Path, holder: Holder) -> Path:
    """Return the path of the file of a role, or of the run."""
    return folder / f"{holder}.json"


def make_keys(folder: Path, endpoint: str) -> None:
    """Write a file for the run and one for each role; only the user can read them.

    Parameters
    ----------
    endpoint
        Where the programs connect; the certificate of the run is for its host.

    Raises
    ------
    BusError
        The endpoint has no certificates, other users may write into the folder, or the files are
        there or cannot be written.
    """
    host = host_of(endpoint)
    if host is None or protocol_of(endpoint) not in AUTHENTICATED:
        raise BusError(f"endpoint {endpoint!r}: expected the form tls/127.0.0.1:7447")
    authority = _Authority()
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if folder.stat().st_mode & (stat.S_IWGRP | stat.S_IWOTH):
            raise BusError(
                f"{folder}: other users may write into this folder, and replace the keys; "
                f"expected a folder of your own, such as {folder / 'keys'}"
            )
        for holder in HOLDERS:
            path = key_file(folder, holder)
            if path.exists() or path.is_symlink():
                raise BusError(f"{path}: is there already; choose another folder for the keys")
        for holder in HOLDERS:
            settings = authority.settings(holder, host, endpoint)
            data = json.dumps(settings, indent=2) + "\n"
            write_new(key_file(folder, holder), data.encode(), 0o600)
    except OSError as error:
        raise BusError(f"{error.filename}: cannot be written: {error.strerror}") from None


def read_keys(folder: Path, holder: Holder) -> Keys:
    """Return what the file of a role says, or that of the run.

    Raises
    ------
    BusError
        There is no such file, it is none of `make_keys`, other users may read it, or its
        certificate has expired or is of another role.
    """
    path = key_file(folder, holder)
    try:
        document = bounded_json.parse(read_file(path, bounded_json.MOST_BYTES))
        side = "listen" if "listen" in document else "connect"
        settings = document["transport"]["link"]["tls"]
        pem = base64.b64decode(settings[f"{side}_certificate_base64"])
        certificate = x509.load_pem_x509_certificate(pem)
        endpoint = str(document[side]["endpoints"][0])
    except OSError as error:
        raise BusError(
            f"{path}: cannot be read: {error.strerror}; expected a folder that "
            "`airhilt keys init` has made, or one with this file of it"
        ) from None
    except (ValueError, LookupError, TypeError):
        raise BusError(f"{path}: no keys; expected a file of `airhilt keys init`") from None
    found = " ".join(str(each.value) for each in certificate.subject)
    if found != CERTIFICATE_NAME.format(holder):  # A run would let nothing of it through.
        raise BusError(
            f"{path}: its certificate is of {found.removeprefix(CERTIFICATE_NAME.format(''))!r}; "
            f"expected that of {holder!r}, as `airhilt keys init` has made it"
        )
    if not is_of_owner_alone(path):
        raise BusError(
            f"{path}: other users may read or change this file, which has a private key; expected "
            f"a file of its owner alone: chmod 600 {path}"
        )
    if certificate.not_valid_after_utc < datetime.now(UTC):
        raise BusError(
            f"{path}: its certificate has expired on {certificate.not_valid_after_utc:%Y-%m-%d}; "
            "make new keys with `airhilt keys init`"
        )
    return Keys(endpoint, {f"{SETTING}/{name}": value for name, value in settings.items()})


class _Authority:
    """Signs the certificates of one folder of keys."""

    def __init__(self) -> None:
        self._key = ec.generate_private_key(ec.SECP256R1())
        self._name = _name("airhilt")
        extension = x509.BasicConstraints(ca=True, path_length=0)
        builder = self._builder(self._name, self._key).add_extension(extension, critical=True)
        self._certificate = builder.sign(self._key, SHA256())

    def _builder(self, name: x509.Name, key: ec.EllipticCurvePrivateKey) -> x509.CertificateBuilder:
        now = datetime.now(UTC)
        return (
            x509.CertificateBuilder()
            .subject_name(name)
            .issuer_name(self._name)
            .public_key(key.public_key())
            .serial_number(x509.random_serial_number())
            .not_valid_before(now - SKEW)
            .not_valid_after(now + VALID_FOR)
        )

    def settings(self, holder: Holder, host: str, endpoint: str) -> dict[str, Any]:
        """Return a configuration of Zenoh with a new certificate.

        A run proves its host with it, a program its role.
        """
        key = ec.generate_private_key(ec.SECP256R1())
        is_router = holder == "router"
        use = ExtendedKeyUsageOID.SERVER_AUTH if is_router else ExtendedKeyUsageOID.CLIENT_AUTH
        builder = (
            self._builder(_name(CERTIFICATE_NAME.format(holder)), key)
            .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
            .add_extension(x509.ExtendedKeyUsage([use]), critical=False)
        )
        if is_router:
            names = x509.SubjectAlternativeName([_alternative(host)])
            builder = builder.add_extension(names, critical=False)
        pem = key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
        side = "listen" if is_router else "connect"
        tls = {
            "enable_mtls": True,
            "root_ca_certificate_base64": _base64(self._certificate.public_bytes(Encoding.PEM)),
            f"{side}_certificate_base64": _base64(
                builder.sign(self._key, SHA256()).public_bytes(Encoding.PEM)
            ),
            f"{side}_private_key_base64": _base64(pem),
        }
        return {
            "mode": "router" if is_router else "client",
            side: {"endpoints": [endpoint]} | ({} if is_router else {"timeout_ms": 60_000}),
            "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
            "transport": {"link": {"tls": tls}},
        }


def _base64(pem: bytes) -> str:
    return base64.b64encode(pem).decode()


def _name(text: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, text)])


def _alternative(host: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(host))
    except ValueError:
        return x509.DNSName(host)
