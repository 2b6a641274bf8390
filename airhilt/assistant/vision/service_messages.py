"""Request and answer of a detector at an address."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field

from airhilt.messages import Box, Confidence, VisibleClass

MOST_FOUND = 1_000
"""Largest number of detections in one picture."""


class PictureRequest(BaseModel):
    """A picture to look at, as the AIRHILT paper has it."""

    image: str = Field(description="PNG in base64, 8-bit sRGB")
    ts_ms: int = Field(ge=0, description="end of the exposure, in ms since the start of the run")
    camera_id: str
    offset_px: tuple[int, int] = Field(
        default=(0, 0), description="left and top of the picture in that of the camera"
    )
    ego_mask: str | None = Field(
        default=None,
        description="PNG in base64, white where the camera's own aircraft may be; null: nowhere",
    )
    window_px: tuple[int, int, int, int] | None = Field(
        default=None,
        description="left, top, right and bottom of the only part to look at, in this picture; "
        "null: all of it; only for a service whose answers say `looks_at_windows`",
    )


class FoundObject(BaseModel):
    """One object in the picture."""

    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)
    label: VisibleClass
    confidence: Confidence
    box: Box


class DetectionAnswer(BaseModel):
    """Answer to a picture."""

    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)
    detections: tuple[FoundObject, ...] = Field(max_length=MOST_FOUND)
    threshold: Confidence = Field(
        default=0.0,
        description="confidence from which a detection counts by itself; others only continue "
        "tracks",
    )
    looks_at_windows: bool = Field(
        default=False,
        description="true if the service takes `window_px`, and finds there what it finds in the "
        "whole picture: a run then asks about what has changed",
    )
