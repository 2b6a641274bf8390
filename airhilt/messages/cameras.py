"""Messages of cameras, and of what a detector sees in their pictures."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, field_validator

from airhilt.messages.base import (
    Confidence,
    Header,
    Limit,
    Message,
    Nanoseconds,
    Part,
    VisibleClass,
)

Box = tuple[float, float, float, float]
"""Left, top, right, bottom in pixels; (0, 0) is the outer corner of the first pixel."""


class CameraView(Part):
    """Pose and projection of a camera.

    The camera is a pinhole without distortion, with square pixels; its axis goes through the middle
    of the picture, (width_px / 2, height_px / 2). It is turned first to the heading, from true
    north, then up by the pitch, then clockwise about its axis by the roll. The values are exact:
    errors of navigation are not simulated.

    The ground of a run is level: `height_m` is the altitude above mean sea level less that of the
    ground, which is the airport's elevation, or the `terrain_elevation_ft` of a scene en route. It
    is neither an ellipsoidal height nor one above the charted end of a runway.
    """

    latitude_deg: float = Field(ge=-90.0, le=90.0)
    longitude_deg: float = Field(ge=-180.0, le=180.0)
    height_m: float = Field(description="above the level ground of the run")
    heading_deg: float = Field(ge=0.0, lt=360.0)
    pitch_deg: float = Field(ge=-90.0, le=90.0)
    roll_deg: float = Field(ge=-180.0, le=180.0)
    horizontal_fov_deg: float = Field(gt=0.0, lt=180.0)
    width_px: int = Field(ge=1)
    height_px: int = Field(ge=1)
    carrier: str | None = Field(
        default=None, description="callsign of the aircraft that it is on; null on the ground"
    )


class CameraInfo(Message):
    """``camera/<camera>/info``: constant properties of a camera, published before its pictures."""

    camera: str
    rate_hz: float = Field(gt=0.0)
    width_px: int = Field(ge=1)
    height_px: int = Field(ge=1)
    horizontal_fov_deg: float = Field(gt=0.0, lt=180.0)
    carrier: str | None = None
    own_aircraft: tuple[int, ...] = Field(
        default=(),
        description="pixels that its own aircraft may cover, as lengths of runs, row by row: "
        "free, covered, free and so on; empty if none",
    )


class CameraFrame(Header):
    """``camera/<camera>/frame``: attachment to one picture, 8-bit sRGB, row by row."""

    camera: str
    seq: int = Field(ge=0)
    t_frame_ns: Nanoseconds = Field(description="end of the exposure")
    view: CameraView
    encoding: Literal["rgb8", "none"] = Field(
        default="rgb8", description="none: the exposure was left out, and there are no pixels"
    )
    sha256: str = Field(description="of the pixels")


CONFIRMED_HITS = 3
"""Number of pictures in which an object must be found to be confirmed."""


class Detection(Part):
    """Object that was detected in a picture."""

    label: VisibleClass
    confidence: Confidence
    box: Box
    track_id: int | None = Field(
        default=None, ge=0, description="the same for one object in all pictures"
    )
    hits: int = Field(
        default=1, ge=1, description="number of pictures in which it was found so far"
    )

    @property
    def is_confirmed(self) -> bool:
        """True if the object was found in `CONFIRMED_HITS` pictures or more."""
        return self.hits >= CONFIRMED_HITS

    @field_validator("box")
    @classmethod
    def _has_room(cls, box: Box) -> Box:
        left, top, right, bottom = box
        if not (left < right and top < bottom):
            raise ValueError(
                f"box {box} has no room; expected left, top, right, bottom, no width and height"
            )
        return box


EXPOSURE_LEFT_OUT = "exposure left out"
"""Value of `Detections.missed` for an exposure that the camera left out."""


class Detections(Message):
    """``vision/<camera>``: objects found in one picture; ``t_ns`` is the paper's t_vision."""

    limit = Limit(size_bytes=128_000, rate_hz=200)
    camera: str
    seq: int = Field(ge=0, description="of the picture")
    t_frame_ns: Nanoseconds
    view: CameraView
    detections: tuple[Detection, ...] = ()
    engine: str
    missed: str = Field(
        "",
        description="why the detector did not look at the picture; empty if it did",
    )
