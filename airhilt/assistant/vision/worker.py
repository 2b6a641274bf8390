"""The vision worker: pictures in, detections out."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from airhilt.assistant.vision.class_names import HasClassMap
from airhilt.assistant.vision.detector import Detector, Found, Shot
from airhilt.assistant.vision.gating import Gate, SeenPicture
from airhilt.assistant.vision.shared_looks import SharedLooks
from airhilt.assistant.vision.tracker import Tracker
from airhilt.errors import VisionError
from airhilt.imaging.masks import Mask, mask_of
from airhilt.messages import (
    EXPOSURE_LEFT_OUT,
    Box,
    CameraFrame,
    CameraInfo,
    DeclaredLatency,
    Detections,
    InputSpec,
    WorkerDescription,
)
from airhilt.sim.worker import DeferredInput, Input, Output
from airhilt.workers.protocol import Step

MOST_OF_OWN_AIRCRAFT = 0.6
"""Share of a box that the camera's own aircraft may cover; a box that it covers more is dropped."""


class VisionWorker:
    """Gives each picture to a detector, follows what it finds, and publishes it.

    A finding below the detector's threshold is published only if it continues a track that was
    found in three pictures or more.
    """

    def __init__(
        self, detector: Detector, name: str = "vision", looks: SharedLooks | None = None
    ) -> None:
        self._engine = detector.name
        self._gate = Gate(detector, looks)
        self._threshold = detector.threshold
        self._masks: dict[str, Mask | None] = {}
        self._trackers: dict[str, Tracker] = {}
        self.description = WorkerDescription(
            name=name,
            modality="vision",
            inputs=(
                InputSpec(key="camera/*/info"),
                InputSpec(key="camera/*/frame", policy="latest"),
            ),
            latency=DeclaredLatency(median_s=0.02),
            configuration=(
                detector.classes.configuration if isinstance(detector, HasClassMap) else {}
            ),
        )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:  # noqa: ARG002
        """Look at the pictures that have arrived.

        The detections of a picture that the detector has missed say why, and those of an exposure
        that the camera left out say that.
        """
        outputs, missed = [], ""
        for item in inputs:
            if item.key.endswith("/info"):
                self._meet(item)
                continue
            seen = self._look(item)
            outputs.append(Output(f"vision/{seen.camera}", seen.model_dump_json().encode()))
            if seen.missed != EXPOSURE_LEFT_OUT:
                missed = missed or seen.missed
        return Step(tuple(outputs), missed=missed)

    def _meet(self, item: Input) -> None:
        info = CameraInfo.model_validate_json(item.payload)
        mask = mask_of(info.own_aircraft, info.height_px, info.width_px)
        self._masks[info.camera] = mask if mask.any() else None

    def _look(self, item: Input) -> Detections:
        header = CameraFrame.model_validate(item.attachment)
        seen = Detections(
            camera=header.camera,
            seq=header.seq,
            t_frame_ns=header.t_frame_ns,
            view=header.view,
            engine=self._engine,
        )
        if header.encoding == "none":
            return seen.model_copy(update={"missed": EXPOSURE_LEFT_OUT})
        mask = self._masks.get(header.camera)
        tracker = self._trackers.setdefault(header.camera, Tracker(self._threshold))
        try:
            found = self._found(
                header, item, mask, tracker.expected(header.t_frame_ns, header.view)
            )
        except VisionError as missed:
            if not missed.is_passing:
                raise
            return seen.model_copy(update={"missed": str(missed)})
        if mask is not None:
            found = beside(mask, found)
        detections = tracker.follow(header.t_frame_ns, header.view, found)
        return seen.model_copy(update={"detections": tuple(detections)})

    def _found(
        self, header: CameraFrame, item: Input, mask: Mask | None, expected: Sequence[Box]
    ) -> Sequence[Found]:
        shape = header.view.height_px, header.view.width_px, 3
        picture = SeenPicture(
            shape,
            header.sha256,
            lambda: np.frombuffer(item.payload, np.uint8).reshape(shape),
            is_made=not isinstance(item, DeferredInput),
        )
        shot = Shot(header.camera, header.t_frame_ns, own_aircraft=mask, view=header.view)
        return self._gate.look_at(shot, picture, expected)


def beside(own_aircraft: Mask, found: Iterable[Found]) -> list[Found]:
    """Return what is found that is no part of the aircraft which carries the camera."""
    return [one for one in found if covered_share(one.box, own_aircraft) <= MOST_OF_OWN_AIRCRAFT]


def covered_share(box: Box, mask: Mask) -> float:
    """Return the share of a box that lies in a mask, from 0 to 1; at least one pixel counts."""
    rows, columns = mask.shape
    spans = []
    for begin, end, size in ((box[1], box[3], rows), (box[0], box[2], columns)):
        first = min(max(round(begin), 0), size - 1)
        spans.append(slice(first, min(max(round(end), first + 1), size)))
    return float(mask[spans[0], spans[1]].mean())
