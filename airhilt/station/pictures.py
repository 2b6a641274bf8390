"""Pictures as browsers take them."""

from __future__ import annotations

import io
from typing import NamedTuple

from PIL import Image

from airhilt.station.audiences import EVERYBODY, Audience

QUALITY = 85
"""Quality of the JPEG pictures, of at most 95 (Pillow)."""


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


def encoded(image: Image.Image) -> bytes:
    """Return an image as JPEG."""
    stream = io.BytesIO()
    image.save(stream, "JPEG", quality=QUALITY)
    return stream.getvalue()
