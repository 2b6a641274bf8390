"""What an actor can be told to do, in scenarios and on ``command/<actor>``."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field


class _Command(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class AltitudeCommand(_Command):
    """Climb or descend to an altitude."""

    action: Literal["altitude"]
    altitude_ft: float
    vertical_rate_fpm: float | None = Field(
        default=None, gt=0.0, description="null: what the aircraft type climbs or descends at"
    )


class TrackCommand(_Command):
    """Turn the shorter way to a true track."""

    action: Literal["track"]
    track_deg: float = Field(ge=0.0, le=360.0)


class TurnCommand(_Command):
    """Turn by an angle from the present track."""

    action: Literal["turn"]
    degrees: float = Field(ge=-180.0, le=180.0, description="positive to the right")


class SpeedCommand(_Command):
    """Fly a calibrated airspeed."""

    action: Literal["speed"]
    cas_kt: float = Field(gt=0.0)


class ResumeRouteCommand(_Command):
    """Go back to the route that a turn left."""

    action: Literal["resume_route"]


Command = Annotated[
    AltitudeCommand | TrackCommand | TurnCommand | SpeedCommand | ResumeRouteCommand,
    Field(discriminator="action"),
]
