"""The vision worker: pictures in, detections out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from pydantic import ValidationError

from airhilt.assistant.vision.detector import Detector, Found, PictureMissed, Shot
from airhilt.assistant.vision.gating import Gate, Looks
from airhilt.assistant.vision.kept_pixels import SeenPicture
from airhilt.assistant.vision.tracker import Tracker
from airhilt.errors import VisionError, first_problem
from airhilt.imaging.masks import Mask, mask_of
from airhilt.messages import (
    EXPOSURE_LEFT_OUT,
    Box,
    CameraFrame,
    CameraInfo,
    DeclaredLatency,
    Detection,
    Detections,
    InputSpec,
    WorkerDescription,
)
from airhilt.sim.worker import DeferredInput, Input, Output
from airhilt.workers.protocol import Step

MOST_OF_OWN_AIRCRAFT = 0.6
"""Share of a box that the camera's own aircraft may cover; a box that it covers more is dropped."""


class _LastLook(NamedTuple):
    """The last picture of a camera that was looked at, by its SHA-256, and what is in it."""

    sha256: str
    found: Sequence[Found]


class VisionWorker:
    """Gives each picture to a detector, follows what it finds, and publishes it.

    A finding below the detector's threshold is published only if it continues a track that was
    found in three pictures or more.

    Parameters
    ----------
    looks
        Looks that runs share; None if each is taken anew.
    """

    def __init__(
        self, detector: Detector, name: str = "vision", looks: Looks | None = None
    ) -> None:
        self._engine = detector.name
        self._gate = Gate(detector, looks)
        self._threshold = detector.threshold
        self._infos: dict[str, CameraInfo] = {}
        self._masks: dict[str, Mask] = {}
        self._trackers: dict[str, Tracker] = {}
        self._last: dict[str, _LastLook] = {}
        self.description = WorkerDescription(
            name=name,
            modality="vision",
            inputs=(
                InputSpec(key="camera/*/info"),
                InputSpec(key="camera/*/frame", policy="latest"),
            ),
            latency=DeclaredLatency(median_s=0.02),
        )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:  # noqa: ARG002
        """Look at the pictures that have arrived.

        The detections of a picture that the detector has missed say why, and those of an exposure
        that the camera left out say that.

        Raises
        ------
        VisionError
            The detector has failed for good, or a picture is not what its header says.
        """
        outputs = []
        for item in inputs:
            if item.key.endswith("/info"):
                self._meet(item)
                continue
            seen = self._look(item)
            outputs.append(Output(f"vision/{seen.camera}", seen.model_dump_json().encode()))
        return Step(tuple(outputs))

    def _meet(self, item: Input) -> None:
        """Keep what never changes about a camera."""
        try:
            info = CameraInfo.model_validate_json(item.payload)
            mask = mask_of(info.own_aircraft, info.height_px, info.width_px)
        except ValidationError as error:
            raise VisionError(
                f"{item.key}: not about a camera: {first_problem(error)}; see `airhilt schema`"
            ) from None
        except ValueError as error:
            raise VisionError(f"{item.key}: own_aircraft has {error}") from None
        self._infos[info.camera] = info
        if mask.any():
            self._masks[info.camera] = mask
        else:
            self._masks.pop(info.camera, None)

    def _look(self, item: Input) -> Detections:
        header = header_of(item)
        seen = Detections(
            camera=header.camera,
            seq=header.seq,
            t_frame_ns=header.t_frame_ns,
            view=header.view,
            engine=self._engine,
        )
        if header.encoding == "none":
            return seen.model_copy(update={"missed": EXPOSURE_LEFT_OUT})
        picture = picture_of(header, item, self._infos.get(header.camera))
        mask = self._masks.get(header.camera)
        try:
            found = self._found(header, picture, mask)
        except PictureMissed as missed:
            return seen.model_copy(update={"missed": str(missed)})
        if mask is not None:
            found = [one for one in found if covered_share(one.box, mask) <= MOST_OF_OWN_AIRCRAFT]
        tracker = self._trackers.setdefault(header.camera, Tracker(self._threshold))
        detections = tuple(
            Detection(
                label=one.found.label,
                confidence=one.found.confidence,
                box=one.found.box,
                track_id=one.track_id,
                hits=one.hits,
            )
            for one in tracker.follow(header.t_frame_ns, header.view, found)
        )
        return seen.model_copy(update={"detections": detections})

    def _found(
        self, header: CameraFrame, picture: SeenPicture, mask: Mask | None
    ) -> Sequence[Found]:
        """Return what is in a picture; the same pixels again have the same in them."""
        last = self._last.get(header.camera)
        if last is None or last.sha256 != header.sha256:
            shot = Shot(header.camera, header.t_frame_ns, own_aircraft=mask)
            last = _LastLook(header.sha256, self._gate.look_at(shot, picture))
            self._last[header.camera] = last
        return last.found


def header_of(item: Input) -> CameraFrame:
    """Return the header of a picture.

    Raises
    ------
    VisionError
        There is none, or it is that of another camera.
    """
    if item.attachment is None:
        raise VisionError(f"{item.key}: no header; expected a CameraFrame as attachment")
    try:
        header = CameraFrame.model_validate(item.attachment)
    except ValidationError as error:
        raise VisionError(
            f"{item.key}: not the header of a picture: {first_problem(error)}; expected a "
            "CameraFrame, see `airhilt schema`"
        ) from None
    if item.key != f"camera/{header.camera}/frame":
        raise VisionError(
            f"{item.key}: a picture of camera {header.camera!r}; expected that of the key"
        )
    return header


def picture_of(header: CameraFrame, item: Input, info: CameraInfo | None) -> SeenPicture:
    """Return the picture in an input, whose pixels are read-only.

    Raises
    ------
    VisionError
        Its size is not what its header or the camera's description says.
    """
    columns, rows = header.view.width_px, header.view.height_px
    if info is not None and (columns, rows) != (info.width_px, info.height_px):
        raise VisionError(
            f"camera {header.camera}, picture {header.seq}: {columns} by {rows} pixels; expected "
            f"{info.width_px} by {info.height_px}, as its description says"
        )
    if item.size != 3 * columns * rows:
        raise VisionError(
            f"camera {header.camera}, picture {header.seq}: {item.size} bytes; expected "
            f"{3 * columns * rows}, {columns} by {rows} pixels of rgb8"
        )
    return SeenPicture(
        (rows, columns, 3),
        header.sha256,
        lambda: np.frombuffer(item.payload, np.uint8).reshape(rows, columns, 3),
        is_made=not isinstance(item, DeferredInput),
    )


def covered_share(box: Box, mask: Mask) -> float:
    """Return the share of a box that lies in a mask, from 0 to 1; at least one pixel counts."""
    rows, columns = mask.shape
    spans = []
    for begin, end, size in ((box[1], box[3], rows), (box[0], box[2], columns)):
        first = min(max(round(begin), 0), size - 1)
        spans.append(slice(first, min(max(round(end), first + 1), size)))
    return float(mask[spans[0], spans[1]].mean())
