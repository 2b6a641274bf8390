"""Cameras of a scenario."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from airhilt.geodesy.positions import Bearing, Position
from airhilt.imaging.lenses import FieldOfView, SidePx
from airhilt.quantities import HeightFt, Number
from airhilt.scenario.models.base import Callsign, Model

CameraName = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,39}$")]
"""Name of a camera. Its files are named after it, so it begins with a letter or digit."""


class FixedMount(Model):
    """A camera that stands on the ground."""

    type: Literal["fixed"]
    position: Position
    height_ft: HeightFt
    azimuth_deg: Bearing
    elevation_deg: Number = Field(default=0.0, ge=-90.0, le=90.0)


class ActorMount(Model):
    """A camera on the nose of an aircraft that looks ahead, or on its tail that looks back."""

    type: Literal["actor"]
    actor: Callsign
    station: Literal["nose", "tail"] = "nose"


class Camera(Model):
    """A camera: its mount, its optics and its exposure times."""

    name: CameraName
    mount: Annotated[FixedMount | ActorMount, Field(discriminator="type")]
    horizontal_fov_deg: FieldOfView = 60.0
    width_px: SidePx = 640
    height_px: SidePx = 360
    rate_hz: Number = Field(default=16.0, ge=1.0, le=30.0)
    phase_s: Number = Field(
        default=0.0, ge=0.0, lt=1.0, description="end of its first exposure after the start"
    )

    @property
    def carrier(self) -> str | None:
        """Callsign of the actor that carries the camera; None if it stands on the ground."""
        return self.mount.actor if isinstance(self.mount, ActorMount) else None
