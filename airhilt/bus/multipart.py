"""Several payloads in one: bytes back to back, their sizes in the JSON attachment."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def pack(payloads: Iterable[bytes]) -> bytes:
    """Return the payloads one after the other."""
    return b"".join(payloads)


def unpack(payload: bytes, sizes: Sequence[int]) -> list[bytes]:
    """Return the payloads of the given sizes.

    Raises
    ------
    ValueError
        The sizes do not add up to the payload's.
    """
    if sum(sizes) != len(payload):
        raise ValueError(f"{len(payload)} bytes of payload, but sizes {list(sizes)}")
    parts, start = [], 0
    for size in sizes:
        parts.append(payload[start : start + size])
        start += size
    return parts
