"""Protocols of bodies that move, and the state of those on or near the ground."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, Protocol, TypeVar, runtime_checkable

from airhilt.geodesy.relative_motion import Kinematics
from airhilt.geodesy.wgs84 import Place, displaced
from airhilt.shapes.sizes import Size

NOT_BEGUN = "not_begun"
"""`Mover.ended` of a body before its recorded track begins: it is not in the world yet."""
TRACK_ENDED = "track_ended"
"""`Mover.ended` of a body after its recorded track: it is not in the world any more."""
ABSENT = frozenset({NOT_BEGUN, TRACK_ENDED})


class SurfaceState(NamedTuple):
    """True state of a body on or near the ground at one instant.

    The place is that of the body's middle. The altitude is that of its lowest point: wheels, feet,
    or the lowest bird of a flock.
    """

    latitude_rad: float
    """Geodetic latitude, WGS84."""
    longitude_rad: float
    altitude_m: float
    """Geodetic height above WGS84."""
    height_agl_m: float
    """Height above the ground; 0 on it."""
    velocity_north_m_s: float
    """Velocity over the ground, like the next two."""
    velocity_east_m_s: float
    velocity_down_m_s: float
    heading_rad: float
    """True heading, in [0, 2 pi)."""

    @property
    def place(self) -> Place:
        """Latitude and longitude."""
        return self.latitude_rad, self.longitude_rad

    @property
    def ground_speed_m_s(self) -> float:
        """Horizontal speed over the ground."""
        return math.hypot(self.velocity_north_m_s, self.velocity_east_m_s)

    @property
    def track_rad(self) -> float:
        """True track over the ground, in (-pi, pi]."""
        return math.atan2(self.velocity_east_m_s, self.velocity_north_m_s)

    @property
    def vertical_rate_m_s(self) -> float:
        """Rate of climb, negative in a descent."""
        return -self.velocity_down_m_s


class Motion(Kinematics, Protocol):
    """Place and movement, which `SurfaceState` and the state of an aircraft both have."""

    @property
    def place(self) -> Place: ...  # noqa: D102
    @property
    def height_agl_m(self) -> float: ...  # noqa: D102
    @property
    def velocity_down_m_s(self) -> float: ...  # noqa: D102
    @property
    def heading_rad(self) -> float: ...  # noqa: D102
    @property
    def ground_speed_m_s(self) -> float: ...  # noqa: D102
    @property
    def track_rad(self) -> float: ...  # noqa: D102
    @property
    def vertical_rate_m_s(self) -> float: ...  # noqa: D102


M = TypeVar("M", bound=Motion)


def carried_on(state: M, elapsed_s: float) -> M:
    """Return the state a fraction of a tick later, after straight movement."""
    if elapsed_s == 0.0:
        return state
    latitude, longitude = displaced(
        (state.latitude_rad, state.longitude_rad),
        state.velocity_north_m_s * elapsed_s,
        state.velocity_east_m_s * elapsed_s,
        state.altitude_m,
    )
    moved: M = state._replace(  # type: ignore[attr-defined]
        latitude_rad=latitude,
        longitude_rad=longitude,
        altitude_m=state.altitude_m - state.velocity_down_m_s * elapsed_s,
    )
    return moved


class Mover(Protocol):
    """A body that moves: an aircraft, a vehicle, an animal."""

    ended: str | None
    """Why it does not move any more, or not yet (`NOT_BEGUN`); None while it moves. Set by whoever
    finds the reason."""

    @property
    def state(self) -> Motion:
        """Place and movement now."""

    @property
    def dimensions(self) -> Size:
        """Size now."""

    @property
    def phase(self) -> str:
        """Activity now, in one word."""

    @property
    def on_ground(self) -> bool:
        """True if the ground carries it."""

    def advance(self) -> None:
        """Move on by one tick; do nothing once it has ended."""


def goes_on(body: Mover) -> bool:
    """Return whether a body moves now, or will."""
    return body.ended is None or body.ended == NOT_BEGUN


@runtime_checkable
class Driven(Mover, Protocol):
    """A mover that is steered along a path; its phase is ``driving`` while it follows one."""

    def drive(self, path: Sequence[Place], speed_m_s: float | None = None) -> None:
        """Follow a path, at most at a speed, and stop at its end."""

    def stop(self) -> None:
        """Stop on the path."""

    def resume(self) -> None:
        """Go on along the path."""


@runtime_checkable
class Creature(Mover, Protocol):
    """A mover that walks, runs, flies and flees."""

    @property
    def startled(self) -> bool:
        """True from a fright until it rests again."""

    def stand(self) -> None:
        """Come to a stand; out of the air, land first."""

    def walk_to(self, place: Place) -> None:
        """Walk to a place."""

    def run_to(self, place: Place) -> None:
        """Run to a place."""

    def fly_to(self, place: Place, height_m: float) -> None:
        """Fly to a place at a height above the ground."""

    def startle(self, away_from: Place) -> None:
        """Flee from a place."""
