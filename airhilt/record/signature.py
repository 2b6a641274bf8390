"""Signatures of runs and sweeps: Ed25519 (RFC 8032) over the bytes of the file with the manifest.

The signature of ``run.json`` is ``run.json.sig``: 64 bytes, as ``openssl pkeyutl -rawin`` reads and
writes them. Keys are PEM files (PKCS #8, and SubjectPublicKeyInfo).
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from cryptography.exceptions import InvalidSignature, UnsupportedAlgorithm
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    PublicFormat,
    load_pem_private_key,
    load_pem_public_key,
)

from airhilt.errors import SignatureError
from airhilt.host.files import is_of_owner_alone, read_file, replace_file, write_new

if TYPE_CHECKING:
    from airhilt.record.folder import RunFolder
    from airhilt.record.sweep_folder import SweepFolder

LARGEST_KEY_BYTES = 1_000_000
"""Size of the largest file that is read as a key."""


def public_file(private: Path) -> Path:
    """Return the path of the public key that belongs to a private one."""
    return private.with_name(f"{private.name}.pub")


def make_keys(private: Path) -> str:
    """Write a new private key and its public key beside it, and return their fingerprint.

    It raises `SignatureError` if there is such a file already, or it cannot be written.
    """
    public = public_file(private)
    for path in (private, public):
        if path.exists() or path.is_symlink():
            raise SignatureError(f"{path}: is there already; choose another name for the key")
    key = Ed25519PrivateKey.generate()
    pem = key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
    public_pem = key.public_key().public_bytes(Encoding.PEM, PublicFormat.SubjectPublicKeyInfo)
    for path, data, mode in ((private, pem, 0o600), (public, public_pem, 0o644)):
        with _named(path, "written"):
            write_new(path, data, mode)
    return fingerprint(key.public_key())


@contextmanager
def _named(path: Path, done: Literal["read", "written"]) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise SignatureError(f"{path}: cannot be {done}: {error.strerror}") from None


def fingerprint(key: Ed25519PublicKey) -> str:
    """Return the SHA-256 of a public key (its 32 bytes), by which people compare keys."""
    return hashlib.sha256(key.public_bytes(Encoding.Raw, PublicFormat.Raw)).hexdigest()


def private_key(path: Path) -> Ed25519PrivateKey:
    """Return the private key in a file.

    It raises `SignatureError` if it cannot be read, is no private Ed25519 key without a password,
    or other users may read it.
    """
    key = _key(path, partial(load_pem_private_key, password=None))
    if not isinstance(key, Ed25519PrivateKey):
        raise SignatureError(
            f"{path}: no private key; expected one that `airhilt keys sign` has made (Ed25519, "
            "PEM, without a password)"
        )
    if not is_of_owner_alone(path):
        raise SignatureError(
            f"{path}: other users may read or change this private key; expected a file of its "
            f"owner alone: chmod 600 {path}"
        )
    return key


def public_key(path: Path) -> Ed25519PublicKey:
    """Return the public key in a file; `SignatureError` if it is no public Ed25519 key."""
    key = _key(path, load_pem_public_key)
    if not isinstance(key, Ed25519PublicKey):
        raise SignatureError(
            f"{path}: no public key; expected the file with .pub that `airhilt keys sign` has made"
        )
    return key


def _key(path: Path, load: Callable[[bytes], object]) -> object:
    with _named(path, "read"):
        data = read_file(path, LARGEST_KEY_BYTES)
    try:
        return load(data)
    except (ValueError, TypeError, UnsupportedAlgorithm):  # TypeError: it needs a password.
        return None


def sign(folder: RunFolder | SweepFolder, key: Ed25519PrivateKey) -> None:
    """Write the signature of a run or a sweep beside its manifest.

    It raises `SignatureError` if it is signed already, or the signature cannot be written.
    """
    path = folder.signature_path
    if path.exists():
        raise SignatureError(f"{path}: signed already; delete this file to sign anew")
    signed = _read(folder, folder.info_path)
    with _named(path, "written"):
        replace_file(path, key.sign(signed))


def is_signed_by(folder: RunFolder | SweepFolder, key: Ed25519PublicKey) -> bool:
    """Return whether a signature is of this key, and of the signed file as it is now."""
    try:
        key.verify(_read(folder, folder.signature_path), _read(folder, folder.info_path))
    except InvalidSignature:
        return False
    return True


def _read(folder: RunFolder | SweepFolder, path: Path) -> bytes:
    with _named(path, "read"):
        return folder.read(path)
