"""Draws boxes, the clock and the active advisory on the pictures of a video."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

from airhilt.messages import Detection, Detections, Severity, VisibleClass
from airhilt.record.pictures import Picture
from airhilt.units import SECOND_NS

if TYPE_CHECKING:
    from PIL import Image, ImageDraw

Colour = tuple[int, int, int]

COLOURS: dict[VisibleClass, Colour] = {
    "airplane": (255, 221, 51),
    "truck": (92, 225, 255),
    "bird": (255, 140, 230),
    "deer": (140, 255, 120),
    "coyote": (190, 255, 90),
}
OTHER_COLOUR: Colour = (255, 255, 255)
"""Colour of the boxes of classes that are not in `COLOURS`."""
SEVERITY_COLOURS: dict[Severity, Colour] = {
    Severity.INFO: (235, 235, 235),
    Severity.ADVISORY: (120, 200, 255),
    Severity.CAUTION: (255, 190, 60),
    Severity.WARNING: (255, 95, 85),
}
WHITE: Colour = (255, 255, 255)
BLACK: Colour = (0, 0, 0)
PALE = 0.65
"""Strength of the colour of a box of an earlier picture."""
ROWS_OF_TEXT = 24
"""Rows of text that would fill the height of a picture."""
LEAST_TEXT_PX = 12
AROUND_PX = 3
"""Distance of a box from its object, in px, so that it does not hide small objects."""
MOST_LINES = 2
"""Largest number of lines of an advisory."""


def clock(t_ns: int) -> str:
    """Return a time as ``mm:ss.d``."""
    tenths = t_ns * 10 // SECOND_NS
    return f"{tenths // 600:02d}:{tenths // 10 % 60:02d}.{tenths % 10}"


class Overlay:
    """Draws on pictures of one size, with a bar above for the clock and one below for advisories.

    Boxes are two pixels wide once confirmed, one before. A picture that no detector looked at has
    the boxes of the last one before it, paler, with their time.
    """

    def __init__(self, width_px: int, height_px: int) -> None:
        from PIL import ImageFont

        self._picture_size = width_px, height_px
        self._text_px = max(height_px // ROWS_OF_TEXT, LEAST_TEXT_PX)
        self._row_px = round(self._text_px * 1.35)
        self._font = ImageFont.load_default(size=self._text_px)
        of_one = self._font.getlength("abcdefghijklmnopqrstuvwxyz") / 26
        self._columns = max(int((width_px - 12) / of_one * 0.95), 8)
        height = height_px + (1 + MOST_LINES) * self._row_px
        self.size = width_px + width_px % 2, height + height % 2
        """Width and height of the images returned, in px, both even."""

    def image(self, picture: Picture, seen: Detections | None) -> Image.Image:
        """Return a picture with its boxes, clock and advisory.

        `seen` are the detections in it, or in the last picture before it that a detector looked at.
        """
        from PIL import Image, ImageDraw

        header = picture.header
        inner = Image.frombytes("RGB", self._picture_size, bytes(picture.pixels))
        title = f"{header.camera}   t = {clock(header.t_frame_ns)}"
        if seen is not None:
            is_own = seen.seq == header.seq
            pen = ImageDraw.Draw(inner)
            for detection in reversed(seen.detections):
                self._draw_box(pen, detection, 1.0 if is_own else PALE)
            if seen.detections and not is_own:
                title += f"   boxes of {clock(seen.t_frame_ns)}"
        image = Image.new("RGB", self.size)
        image.paste(inner, (0, self._row_px))
        pen = ImageDraw.Draw(image)
        self._write(pen, 0, [title], WHITE)
        if (advisory := picture.advisory) is not None:
            text = f"{advisory.severity} to {advisory.recipient}: {advisory.message}"
            lines = textwrap.wrap(text, self._columns, max_lines=MOST_LINES, placeholder="…")
            below = self._row_px + self._picture_size[1]
            self._write(pen, below, lines, SEVERITY_COLOURS[advisory.severity])
        return image

    def picture_in(self, image: Image.Image) -> Image.Image:
        """Return the picture within an image that was returned, without the bars."""
        width, height = self._picture_size
        return image.crop((0, self._row_px, width, self._row_px + height))

    def _draw_box(self, pen: ImageDraw.ImageDraw, detection: Detection, strength: float) -> None:
        red, green, blue = COLOURS.get(detection.label, OTHER_COLOUR)
        colour = round(red * strength), round(green * strength), round(blue * strength)
        left, top, right, bottom = detection.box
        outer = (left - AROUND_PX, top - AROUND_PX, right + AROUND_PX - 1, bottom + AROUND_PX - 1)
        pen.rectangle(outer, outline=colour, width=2 if detection.is_confirmed else 1)
        track = "" if detection.track_id is None else f" #{detection.track_id}"
        text = f"{detection.label} {detection.confidence:.2f}{track}"
        width, height = self._picture_size
        most = max(width - self._font.getlength(text) - 2.0, 2.0)
        above = outer[1] - self._row_px
        row = above if above >= 0.0 else min(outer[3] + 1.0, height - self._row_px)
        place = min(max(outer[0], 2.0), most), row
        pen.text(place, text, fill=colour, font=self._font, stroke_width=1, stroke_fill=BLACK)

    def _write(self, pen: ImageDraw.ImageDraw, top: int, lines: list[str], colour: Colour) -> None:
        for number, line in enumerate(lines):
            row = top + number * self._row_px + (self._row_px - self._text_px) // 2
            pen.text((6, row), line, fill=colour, font=self._font)
