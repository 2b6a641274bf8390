"""Messages of cameras, as short as a test wants them."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np

from airhilt.errors import RendererError
from airhilt.messages import (
    Advisory,
    Box,
    CameraFrame,
    CameraInfo,
    CameraTruth,
    CameraView,
    Detection,
    Detections,
    Evidence,
    Severity,
    SightingTruth,
    Status,
)
from airhilt.sim.payload import DeferredBytes
from airhilt.units import SECOND_NS

RATE_HZ = 16.0
WIDTH, HEIGHT = 160, 90


def time_ns(seq: int) -> int:
    """When picture number ``seq`` is taken."""
    return round(seq * SECOND_NS / RATE_HZ)


def view(carrier: str | None = None, size: tuple[int, int] = (WIDTH, HEIGHT)) -> CameraView:
    return CameraView(
        latitude_deg=38.85, longitude_deg=-77.04, height_m=50.0, heading_deg=90.0, pitch_deg=0.0,
        roll_deg=0.0, horizontal_fov_deg=60.0, width_px=size[0], height_px=size[1],
        carrier=carrier,
    )  # fmt: skip


def info(camera: str = "tower", size: tuple[int, int] = (WIDTH, HEIGHT)) -> CameraInfo:
    return CameraInfo(
        camera=camera, rate_hz=RATE_HZ, width_px=size[0], height_px=size[1],
        horizontal_fov_deg=60.0,
    )  # fmt: skip


def sighting(box: Box, actor: str = "DAL456", **changed: Any) -> SightingTruth:
    known = {
        "label": "airplane", "pixels": 20.0, "visible_fraction": 1.0, "truncation": 0.0,
        "range_m": 2_000.0, "transmission": 0.8,
    }  # fmt: skip
    return SightingTruth.model_validate({"actor": actor, "box": box, **known, **changed})


def truth(seq: int, *sightings: SightingTruth, camera: str = "tower") -> CameraTruth:
    t_ns = time_ns(seq)
    return CameraTruth(t_ns=t_ns, camera=camera, seq=seq, t_frame_ns=t_ns, sightings=sightings)


def pixels(level: int = 128, size: tuple[int, int] = (WIDTH, HEIGHT)) -> bytes:
    return np.full((size[1], size[0], 3), level, np.uint8).tobytes()


def undrawn(size: tuple[int, int]) -> DeferredBytes:
    """Pixels that the renderer was to draw later, and that has died."""

    def fail() -> bytes:
        raise RendererError("it has ended")

    return DeferredBytes(3 * size[0] * size[1], fail)


def frame(
    seq: int,
    camera: str = "tower",
    carrier: str | None = None,
    size: tuple[int, int] = (WIDTH, HEIGHT),
) -> CameraFrame:
    t_ns = time_ns(seq)
    return CameraFrame(
        t_ns=t_ns, camera=camera, seq=seq, t_frame_ns=t_ns, view=view(carrier, size),
        sha256=hashlib.sha256(b"").hexdigest(),
    )  # fmt: skip


def found(box: Box, **changed: Any) -> Detection:
    known = {"label": "airplane", "confidence": 0.9, "track_id": 1, "hits": 3}
    return Detection.model_validate({"box": box, **known, **changed})


def seen(
    seq: int, *detections: Detection, late_s: float = 0.1, camera: str = "tower"
) -> Detections:
    return Detections(
        t_ns=time_ns(seq) + round(late_s * SECOND_NS), camera=camera, seq=seq,
        t_frame_ns=time_ns(seq), view=view(), detections=detections, engine="test",
    )  # fmt: skip


def vision(state: str, cause: str = "", t_ns: int = 0) -> Status:
    return Status.model_validate(
        {"t_ns": t_ns, "modality": "vision", "state": state, "cause": cause}
    )


def advisory(seq: int, severity: str = "CAUTION", **changed: Any) -> Advisory:
    known = Advisory(
        t_ns=time_ns(seq), id="decision-1", revision=0, recipient="ATC", recipients=("ATC",),
        kind="runway_conflict", severity=Severity(severity), traffic=("AAL123", "DAL456"),
        message="Traffic", evidence=Evidence(sources=("vision",)), t_ready_ns=0,
    )  # fmt: skip
    return known.model_copy(update=changed)
