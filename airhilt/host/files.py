"""Files: written all or nothing, read where they have an end, and their SHA-256.

A folder that somebody else has filled may hold links and pipes. What is written replaces a link
and never follows one; what is read is a regular file of that folder.
"""

from __future__ import annotations

import errno
import hashlib
import os
import re
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from io import BufferedReader, BufferedWriter
from pathlib import Path
from types import ModuleType

PARTIAL = ".partial"
"""End of the name of a file that is being written."""
BLOCK_BYTES = 1 << 20
"""Number of bytes that are read at a time."""
NOT_INSIDE = (errno.ELOOP, errno.ENOTDIR, errno.EMLINK, errno.ENXIO, errno.EINVAL)
"""Errors of the system for a link that is not followed and for a socket, and of `_regular`."""

URL = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*://")


def is_url(given: object) -> bool:
    """Return whether what is given as a path is a URL, such as ``s3://bucket/run``."""
    return URL.match(str(given)) is not None


def replace_file(path: Path, data: bytes) -> None:
    """Write a file, in the place of an earlier one only when all of it is there.

    A link of that name is replaced, and what it leads to stays as it is.

    Raises
    ------
    OSError
        It cannot be written; nothing has changed.
    """
    with _partial(path) as partial:
        write_new(partial, data, 0o666)


@contextmanager
def replacing(path: Path) -> Iterator[BufferedWriter]:
    """Open a file to be written by pieces, else as `replace_file`; an error leaves no part of it.

    Raises
    ------
    OSError
        It cannot be written; nothing has changed.
    """
    with _partial(path) as partial, _new(partial, 0o666) as stream:
        yield stream


@contextmanager
def _partial(path: Path) -> Iterator[Path]:
    """Give the path of a file that takes the place of another once it is written."""
    # The name is unique: several threads and processes may write the same file.
    partial = path.with_name(f"{path.name}.{secrets.token_hex(4)}{PARTIAL}")
    try:
        yield partial
        partial.replace(path)
    except BaseException:
        with suppress(OSError):
            partial.unlink()
        raise


def write_new(path: Path, data: bytes, mode: int) -> None:
    """Write a file that is not there yet, with the given permissions from its beginning.

    Raises
    ------
    OSError
        It is there already, or cannot be written.
    """
    with _new(path, mode) as stream:
        stream.write(data)


def _new(path: Path, mode: int) -> BufferedWriter:
    return os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "wb")


def is_of_owner_alone(path: Path) -> bool:
    """Return whether no other user may read or write a file.

    Raises
    ------
    OSError
        It is not there.
    """
    return not stat.S_IMODE(path.stat().st_mode) & (stat.S_IRWXG | stat.S_IRWXO)


def make_folder(path: Path) -> None:
    """Make a folder, unless it is there already.

    Raises
    ------
    OSError
        It cannot be made, or is a link: what is written into it would be elsewhere.
    """
    if path.is_symlink():
        raise OSError(errno.ELOOP, "a link, which may lead elsewhere", str(path))
    path.mkdir(parents=True, exist_ok=True)


def open_inside(folder: Path, path: Path) -> BufferedReader:
    """Open a file of a folder for reading.

    Raises
    ------
    OSError
        It is not there, or is not a regular file of that folder: a link, a pipe, a device, or
        behind a link to another folder.
    """
    refused = OSError(errno.EINVAL, "no regular file of its folder", str(path))
    parts = path.relative_to(folder).parts
    if not parts or ".." in parts:
        raise refused
    *between, name = parts
    reached = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:  # Each step is opened in the one before: nobody can put a link there in the meantime.
        for part in between:
            inner = os.open(part, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW, dir_fd=reached)
            os.close(reached)
            reached = inner
        return _regular(name, os.O_NOFOLLOW, reached)
    except OSError as error:
        raise (refused if error.errno in NOT_INSIDE else error) from None
    except ValueError:  # No file can have such a name.
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(path)) from None
    finally:
        os.close(reached)


def _regular(path: Path | str, flags: int = 0, folder: int | None = None) -> BufferedReader:
    """Open a regular file for reading; OSError for anything else, such as a pipe or a device."""
    # Nonblocking: the other end of a pipe may never be opened.
    opened = os.open(path, os.O_RDONLY | os.O_NONBLOCK | flags, dir_fd=folder)
    if not stat.S_ISREG(os.fstat(opened).st_mode):
        os.close(opened)
        raise OSError(errno.EINVAL, "no regular file", str(path))
    return os.fdopen(opened, "rb")


def read_inside(folder: Path, path: Path, most_bytes: int) -> bytes:
    """Return the content of a file of a folder.

    Raises
    ------
    OSError
        As `open_inside`, or it cannot be read, or is larger than that.
    """
    with open_inside(folder, path) as stream:
        return _content(stream, path, most_bytes)


def read_file(path: Path, most_bytes: int) -> bytes:
    """Return the content of a file that the user names.

    Raises
    ------
    OSError
        It cannot be read, is no regular file, or is larger than that.
    """
    with _regular(path) as stream:
        return _content(stream, path, most_bytes)


def _content(stream: BufferedReader, path: Path, most_bytes: int) -> bytes:
    blocks, size_bytes = [], 0
    while block := stream.read(BLOCK_BYTES):  # Room for most_bytes would be taken at once.
        blocks.append(block)
        size_bytes += len(block)
        if size_bytes > most_bytes:
            raise OSError(errno.EFBIG, f"has over {most_bytes:,} bytes", str(path))
    return b"".join(blocks)


def sha256(path: Path) -> str:
    """Return the SHA-256 of a file in hexadecimal."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


@cache
def source_sha256(*paths: Path) -> str:
    """Return the SHA-256 of Python files, and of those below folders: it changes with the code.

    A process reads them once: what is edited while it lives is not what it runs.
    """
    digest = hashlib.sha256()
    for path in paths:
        for file in sorted(path.rglob("*.py")) if path.is_dir() else [path]:
            digest.update(f"{file.name}\0{sha256(file)}\n".encode())
    return digest.hexdigest()


def packages_sha256(*packages: ModuleType) -> str:
    """Return the SHA-256 of the code of some packages."""
    return source_sha256(*(Path(place) for package in packages for place in package.__path__))


def content_sha256(path: Path) -> str:
    """Return the SHA-256 of a file, or that of the names and contents of all files in a folder."""
    if not path.is_dir():
        return sha256(path)
    digest = hashlib.sha256()
    for file in sorted(each for each in path.rglob("*") if each.is_file()):
        digest.update(f"{file.relative_to(path).as_posix()}\0{sha256(file)}\n".encode())
    return digest.hexdigest()
