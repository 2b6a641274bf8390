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
    """What the file of a role, or of the run, says.

    Attributes
    ----------
    endpoint
        Where the run accepts connections.
    settings
        Settings of Zenoh, by their keys.
    """

    endpoint: str
    settings: dict[str, Any]


@dataclass(frozen=True)
class _Signed:
    """A private key and its certificate."""

    key: ec.EllipticCurvePrivateKey
    certificate: x509.Certificate

    def key_base64(self) -> str:
        """Return the private key as Zenoh's configuration has it."""
        pem = self.key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
        return base64.b64encode(pem).decode()

    def certificate_base64(self) -> str:
        """Return the certificate as Zenoh's configuration has it."""
        return base64.b64encode(self.certificate.public_bytes(Encoding.PEM)).decode()


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
    authority = _authority()
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
            settings = _settings(authority, holder, host, endpoint)
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
    _require_holder(certificate, holder, path)
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


def _require_holder(certificate: x509.Certificate, holder: Holder, path: Path) -> None:
    """Complain about the certificate of another role, with which a run lets nothing through."""
    names = certificate.subject.get_attributes_for_oid(NameOID.COMMON_NAME)
    found = [str(name.value) for name in names]
    if found == [CERTIFICATE_NAME.format(holder)]:
        return
    others = [other for other in HOLDERS if found == [CERTIFICATE_NAME.format(other)]]
    whose = f"of {others[0]!r}" if others else "of no role"
    raise BusError(
        f"{path}: its certificate is {whose}; expected that of {holder!r}, as `airhilt keys init` "
        "has made it"
    )


def _side(holder: Holder) -> Literal["listen", "connect"]:
    return "listen" if holder == "router" else "connect"


def _settings(authority: _Signed, holder: Holder, host: str, endpoint: str) -> dict[str, Any]:
    side = _side(holder)
    signed = _signed(authority, holder, host)
    return {
        "mode": "router" if side == "listen" else "client",
        side: {"endpoints": [endpoint]} | ({"timeout_ms": 60_000} if side == "connect" else {}),
        "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
        "transport": {
            "link": {
                "tls": {
                    "enable_mtls": True,
                    "root_ca_certificate_base64": authority.certificate_base64(),
                    f"{side}_certificate_base64": signed.certificate_base64(),
                    f"{side}_private_key_base64": signed.key_base64(),
                }
            }
        },
    }


def _authority() -> _Signed:
    key = ec.generate_private_key(ec.SECP256R1())
    name = _name("airhilt")
    builder = _builder(name, name, key).add_extension(
        x509.BasicConstraints(ca=True, path_length=0), critical=True
    )
    return _Signed(key, builder.sign(key, SHA256()))


def _signed(authority: _Signed, holder: Holder, host: str) -> _Signed:
    """Return a new certificate: the run proves its host with it, a program its role."""
    key = ec.generate_private_key(ec.SECP256R1())
    is_router = holder == "router"
    use = ExtendedKeyUsageOID.SERVER_AUTH if is_router else ExtendedKeyUsageOID.CLIENT_AUTH
    name = _name(CERTIFICATE_NAME.format(holder))
    builder = (
        _builder(name, authority.certificate.subject, key)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.ExtendedKeyUsage([use]), critical=False)
    )
    if is_router:
        builder = builder.add_extension(
            x509.SubjectAlternativeName([_alternative(host)]), critical=False
        )
    return _Signed(key, builder.sign(authority.key, SHA256()))


def _builder(
    name: x509.Name, issuer: x509.Name, key: ec.EllipticCurvePrivateKey
) -> x509.CertificateBuilder:
    now = datetime.now(UTC)
    return (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(issuer)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - SKEW)
        .not_valid_after(now + VALID_FOR)
    )


def _name(text: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, text)])


def _alternative(host: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(host))
    except ValueError:
        return x509.DNSName(host)
