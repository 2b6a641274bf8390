"""Pictures that come from a run, as browsers take them."""

from __future__ import annotations

from typing import NamedTuple

from PIL import Image

from airhilt.record.kept_pictures import encoded
from airhilt.station.audiences import EVERYBODY, Audience


class Picture(NamedTuple):
    """One picture of a camera, 8-bit RGB, row by row, and who may see it."""

    width_px: int
    height_px: int
    pixels: bytes
    audience: Audience = EVERYBODY


def jpeg(picture: Picture) -> bytes:
    """Return a picture as JPEG."""
    size = picture.width_px, picture.height_px
    return encoded(Image.frombytes("RGB", size, picture.pixels))
