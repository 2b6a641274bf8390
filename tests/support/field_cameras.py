"""Cameras on the airfield, and movers that only cameras show."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from airfield import FIELD, NORTH, Mover
from projected import Body, Camera, standing


def at(along_m: float, across_m: float, height_m: float = 0.0) -> tuple[float, float, float]:
    return (*NORTH.local(along_m, across_m), height_m)


def camera(
    name: str,
    place: tuple[float, float, float],
    right_deg: float,
    bodies: Sequence[Body],
    pitch_deg: float = -2.0,
    **how: Any,
) -> Camera:
    """Return a camera that stands, and looks so far to the right of the runway's direction."""
    look = standing(at(*place), NORTH.course_deg + right_deg, pitch_deg)
    return Camera(name, FIELD, look, list(bodies), **({"rate_hz": 4.0, "smallest_px": 5.0} | how))


def beside_threshold(*bodies: Body, **how: Any) -> Camera:
    """Return a camera beside the threshold that looks along the runway."""
    return camera("threshold", (0.0, 95.0, 8.0), -8.0, bodies, width_px=1280, height_px=720, **how)


def on_tower(*bodies: Body, **how: Any) -> Camera:
    """Return a camera that looks across the runway from far away."""
    sharp = {"width_px": 1920, "height_px": 1080, "fov_deg": 70.0} | how
    return camera("tower", (900.0, -500.0, 57.0), 90.0, bodies, -6.0, **sharp)


def silent(spot: Callable[..., Any], callsign: str = "OPS1", category: str = "C2") -> Mover:
    """Return somebody without a transponder."""
    return Mover(callsign, NORTH, spot, 90.0, category, equipped=False)
