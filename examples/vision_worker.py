"""A detector of one's own, with AIRHILT's SDK: put your model where `look` is.

    airhilt cosim --scenario s01b_nominal --endpoint tcp/127.0.0.1:7447 --attach mine
    python examples/vision_worker.py tcp/127.0.0.1:7447

This one takes the brightest spots of a picture for aircraft. It takes the place of the embedded
detector, and the report compares what it gives with what was there.
"""

import sys
from collections.abc import Sequence

import numpy as np
from scipy import ndimage

from airhilt.messages import CameraFrame, Detection, Detections, InputSpec, WorkerDescription
from airhilt.sim import Input, Output
from airhilt.workers import Step, serve


def look(picture: np.ndarray) -> list[Detection]:
    """Return what is in a picture (rows, columns, RGB; 8 bits)."""
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
        shape = (header.view.height_px, header.view.width_px, 3)
        found = look(np.frombuffer(item.payload, np.uint8).reshape(shape))
        told = Detections(
            camera=header.camera, seq=header.seq, t_frame_ns=header.t_frame_ns, view=header.view,
            detections=tuple(found), engine="mine",
        )  # fmt: skip
        return Output(f"vision/{header.camera}", told.model_dump_json().encode())


if __name__ == "__main__":
    serve(MyDetector(), connect=sys.argv[1])
