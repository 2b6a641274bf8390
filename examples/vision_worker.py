"""A detector, with AIRHILT's SDK. Replace the function `detect` by your model.

    airhilt cosim --scenario s01b_nominal --endpoint tcp/127.0.0.1:7447 --attach mine
    python examples/vision_worker.py tcp/127.0.0.1:7447

This one reports the brightest spots of a picture as aircraft. It replaces the embedded detector.
The report compares its detections with the true boxes.
"""

import sys
from collections.abc import Sequence

import numpy as np
from scipy import ndimage

from airhilt.messages import (
    EXPOSURE_LEFT_OUT,
    CameraFrame,
    Detection,
    Detections,
    InputSpec,
    WorkerDescription,
)
from airhilt.sim import Input, Output
from airhilt.workers import Step, serve


def detect(picture: np.ndarray) -> list[Detection]:
    """Return the detections in a picture (rows, columns, RGB; 8 bits)."""
    spots, _ = ndimage.label(picture.min(axis=2) > 240)
    boxes = [(x.start, y.start, x.stop, y.stop) for y, x in ndimage.find_objects(spots)]
    return [Detection(label="airplane", confidence=0.5, box=box) for box in boxes[:20]]


class MyDetector:
    description = WorkerDescription(
        name="mine",
        modality="vision",
        inputs=(InputSpec(key="camera/*/frame", policy="latest"),),
    )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        return Step(tuple(self.detections(item) for item in inputs))

    def detections(self, item: Input) -> Output:
        header = CameraFrame.model_validate(item.attachment)
        found: list[Detection] = []
        if header.encoding == "rgb8":
            shape = (header.view.height_px, header.view.width_px, 3)
            found = detect(np.frombuffer(item.payload, np.uint8).reshape(shape))
        message = Detections(
            camera=header.camera, seq=header.seq, t_frame_ns=header.t_frame_ns, view=header.view,
            detections=tuple(found), engine="mine",
            missed="" if header.encoding == "rgb8" else EXPOSURE_LEFT_OUT,
        )  # fmt: skip
        return Output(f"vision/{header.camera}", message.model_dump_json().encode())


if __name__ == "__main__":
    serve(MyDetector(), connect=sys.argv[1])
