"""Sensors of a scenario: ADS-B reception, cameras, radars, and surveillance of the surface."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from airhilt.geodesy.positions import Bearing, Position
from airhilt.imaging.lenses import FieldOfView, SidePx
from airhilt.messages import RadarKind
from airhilt.quantities import HeightFt, Number, PeriodS, Share
from airhilt.scenario.models.base import Callsign, Identifier, Model

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


class Imaging(Model):
    """Effects of a camera's lens, sensor and coder; by default those of a good camera."""

    exposure_ev: Number = Field(
        default=0.0, ge=-4.0, le=4.0, description="light against that of a good exposure, log 2"
    )
    vignetting: Share = Field(
        default=0.5,
        description="how much light falls off towards the corners: 0 not at all, 1 by the fourth "
        "power of the cosine",
    )
    blur_px: Number = Field(
        default=0.5, ge=0.0, le=4.0, description="deviation of what a point becomes"
    )
    fixed_pattern: Number = Field(
        default=0.005,
        ge=0.0,
        le=0.1,
        description="deviation of pixels' sensitivities (EMVA 1288: photo response non-uniformity)",
    )
    noise_levels: Number = Field(
        default=0.0, ge=0.0, le=50.0, description="deviation of the noise, of 255 levels"
    )
    jpeg_quality: Annotated[int, Field(ge=1, le=100)] | None = Field(
        default=None, description="quality of JPEG, by which pictures are coded and decoded"
    )


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
    imaging: Imaging = Imaging()

    @property
    def carrier(self) -> str | None:
        """Callsign of the actor that carries the camera; None if it stands on the ground."""
        return self.mount.actor if isinstance(self.mount, ActorMount) else None


class AdsbReceiver(Model):
    """A receiver. It receives what is above its radio horizon and within its range."""

    name: Identifier
    position: Position
    antenna_height_ft: Number = Field(default=50.0, ge=-1500.0, le=60_000.0)
    range_nm: Number = Field(default=200.0, gt=0.0, le=500.0)


class Adsb(Model):
    """ADS-B reception. If no receiver is listed, one stands at the scene's centre."""

    receivers: tuple[AdsbReceiver, ...] = Field(default=(), max_length=100)
    loss_probability: Share = Field(default=0.05, description="probability that a squitter is lost")
    outages_s: tuple[PeriodS, ...] = Field(
        default=(), max_length=100, description="[from, to] intervals in which nothing is received"
    )


class Radar(Model):
    """A surveillance radar, primary and secondary on one antenna.

    A terminal radar turns once in 4.8 s and reaches 60 NM (replies 120 NM), an en-route radar turns
    once in 12 s and reaches 250 NM.
    """

    name: Identifier
    kind: RadarKind = "terminal"
    position: Position
    antenna_height_ft: Number = Field(
        default=75.0, ge=0.0, le=10_000.0, description="above the ground"
    )


class SurfaceSurveillance(Model):
    """Surface movement radar and multilateration of the airport, fused."""

    loss_probability: Share = Field(
        default=0.0,
        description="probability that a target has no track in one second, besides the "
        "probabilities of detection",
    )
    outages_s: tuple[PeriodS, ...] = Field(
        default=(), max_length=100, description="[from, to] intervals in which there are no tracks"
    )
